# Two commands matter: `make demo` and `make test`. Both set themselves up in .venv and touch
# nothing else on the machine.

PYTHON ?= $(firstword $(foreach p,python3.11 python3.12 python3,$(if $(shell $(p) -c \
  'import sys; print((3, 11) <= sys.version_info < (3, 13) or "")' 2>/dev/null),$(p))))
VENV := .venv
BIN := $(VENV)/bin
PACKAGES := icarus_lite aapa runtime
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt

.PHONY: demo demo-without test check lint types imports format picture bench-language fuzz mistakes parentheses reference vscode colours fuzz-engine bench-engine bench-engine-rules bench-surprises experiment-gearbox bench-generator bench-tracking bench-aapa bench-lacater train-refined bench-planning clean help

help: ## list the targets
	@grep -E '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed 's/:.*## /\t/'

$(BIN)/python:
	@test -n "$(PYTHON)" || { echo "icarus-lite needs Python 3.11 or 3.12 (ur-rtde has no newer builds)." >&2; exit 2; }
	@$(PYTHON) -m venv $(VENV) || { rm -rf $(VENV); echo "No virtual environment could be made: on Debian, apt install python3-venv." >&2; exit 2; }

$(VENV)/.installed: pyproject.toml constraints.txt | $(BIN)/python
	$(INSTALL) -e '.[cell]'
	@touch $@

$(VENV)/.installed-dev: pyproject.toml constraints.txt | $(BIN)/python
	$(INSTALL) -e '.[cell,dev]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-neural: pyproject.toml constraints.txt | $(BIN)/python
	$(INSTALL) -e '.[cell,neural]'
	@touch $@ $(VENV)/.installed

demo: $(VENV)/.installed ## run task 1.1, "Attach hub cover to case", in the simulated cell
	$(BIN)/icarus run domains/gearbox.icr --task 1.1

demo-without: $(VENV)/.installed ## the same without attachments: it fails, as in the paper
	! $(BIN)/icarus run domains/gearbox.icr --task 1.1 --no-attachments

test: $(VENV)/.installed-dev ## run the tests
	$(BIN)/python -m pytest -q -n 2 --dist loadgroup

check: lint types imports ## everything that reads the code without running it

lint: $(VENV)/.installed-dev ## rules and layout, of Python and of the domains
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/icarus fmt --check domains/*.icr
	$(BIN)/icarus check domains/*.icr

types: $(VENV)/.installed-dev ## mypy, strict
	$(BIN)/mypy

imports: $(VENV)/.installed-dev ## who may import whom
	$(BIN)/lint-imports

format: $(VENV)/.installed-dev ## lay the code out
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

vscode: $(VENV)/.installed ## package the extension for VS Code (needs npm)
	$(BIN)/python -m icarus_lite.language.textmate editors/vscode/syntaxes/icarus.tmLanguage.json
	cd editors/vscode && npm install --no-fund --no-audit && npm test && npm run package
	$(BIN)/python editors/engines.py domains/*.icr
	$(BIN)/python editors/check_package.py editors/vscode/icarus-lite.vsix

colours: $(VENV)/.installed ## compare the colours of VS Code's engine with the lexer's (after `make vscode`)
	$(BIN)/python editors/engines.py domains/*.icr

parentheses: $(VENV)/.installed ## forget and double each parenthesis of the domains (three minutes)
	$(BIN)/python benchmarks/parentheses.py --out docs/results/parentheses.md

picture: $(VENV)/.installed ## draw the picture of the README (needs EGL or OSMesa)
	$(BIN)/python examples/02_picture_of_the_cell.py docs/images/cell.png

experiment-gearbox: $(VENV)/.installed ## the paper's six tasks through every fault (hours; goes on where it was interrupted)
	$(BIN)/python benchmarks/experiment_gearbox.py --whole --out docs/results/gearbox.md --images docs/images

bench-language: $(VENV)/.installed ## how long reading and checking a domain takes
	$(BIN)/python benchmarks/language_speed.py --out docs/results/language.md

fuzz: $(VENV)/.installed ## read 100,000 wrong domain files (about twenty minutes)
	$(BIN)/python benchmarks/fuzz_language.py --inputs 100000 --seed 1 --out docs/results/fuzz.md

mistakes: $(VENV)/.installed ## typical mistakes, and word for word what is said of them
	$(BIN)/python benchmarks/mistakes.py --out docs/results/mistakes.md

reference: $(VENV)/.installed ## put the code's tables into the language reference
	$(BIN)/python -m icarus_lite.language.reference docs/reference/language.md

fuzz-engine: $(VENV)/.installed-dev ## beliefs against clingo's on 10,000 random domains, 20 cycles each
	ICARUS_ALL_CASES=1 $(BIN)/python -m pytest -q tests/datalog -k large
	$(BIN)/python tests/differential/fuzz.py --programs 10000 --cycles 20 --out docs/results/fuzz-engine.md

bench-engine: $(VENV)/.installed-dev ## inference beside CLIPS and clingo, in one run (a quarter of an hour)
	$(BIN)/python benchmarks/engine_peers.py --out docs/results/engine.md

bench-engine-rules: $(VENV)/.installed-dev ## how inference grows with the number of rules
	$(BIN)/python benchmarks/engine_rules.py --out docs/results/engine-rules.md

bench-surprises: $(VENV)/.installed ## how many plans survive how many surprises (three minutes)
	$(BIN)/python benchmarks/surprises.py --runs 200 --out docs/results/surprises.md

bench-generator: $(VENV)/.installed ## the generated data beside what is published of LA-CATER (five minutes)
	$(BIN)/python benchmarks/generator_calibration.py --out docs/results/generator.md

# norfair asks for older versions of numpy and rich than it runs with: an environment of its own.
.venv-peers/.installed: pyproject.toml | $(BIN)/python
	$(BIN)/python -m venv .venv-peers
	.venv-peers/bin/python -m pip install --quiet --disable-pip-version-check -c constraints.txt -e . trackers==2.6.1 filterpy==1.4.5
	.venv-peers/bin/python -m pip install --quiet --disable-pip-version-check --no-deps norfair==2.3.0
	@touch $@

bench-tracking: $(VENV)/.installed .venv-peers/.installed ## AAPA beside norfair, SORT and ByteTrack in one run, and alignment at scale
	$(BIN)/icarus cater generate --videos 40 --seed 100 --out build/tracking
	.venv-peers/bin/python -W ignore benchmarks/tracking.py build/tracking --out docs/results/tracking.md

bench-aapa: $(VENV)/.installed ## AAPA and aapa-plus beside the paper's table, and each idea left out (half an hour)
	$(BIN)/python benchmarks/aapa_table.py --out docs/results/aapa.md

bench-lacater: $(VENV)/.installed-neural ## every row of the paper's table and ours beside, on 1,371 videos (a quarter of an hour; rows that are there are kept)
	$(BIN)/python benchmarks/lacater_table.py --out docs/results/lacater.md

train-refined: $(VENV)/.installed-neural ## train the correction of aapa-refined (half an hour)
	$(BIN)/python benchmarks/train_refined.py

bench-planning: $(VENV)/.installed ## sixty planning problems beside pyperplan (a quarter of an hour; fetches them, or INSTANCES=checkout)
	$(BIN)/python benchmarks/planning.py $(if $(INSTANCES),--instances $(INSTANCES)) --improve 8 --rows build/planning.jsonl --out docs/results/planning.md

clean: ## remove the virtual environment and what tools left behind
	rm -rf $(VENV) .venv-peers .mypy_cache .ruff_cache .pytest_cache .hypothesis build dist
