# Two commands matter: `make demo` and `make test`. Both set themselves up in .venv and touch
# nothing else on the machine.

PYTHON ?= $(firstword $(foreach p,python3.11 python3.12 python3,$(if $(shell $(p) -c \
  'import sys; print((3, 11) <= sys.version_info < (3, 13) or "")' 2>/dev/null),$(p))))
VENV := .venv
BIN := $(VENV)/bin
PACKAGES := icarus_lite aapa runtime
INSTALL := $(BIN)/python -m pip install --quiet --disable-pip-version-check -c constraints.txt

.PHONY: demo demo-without test check lint types imports format picture bench-task bench-language fuzz mistakes reference vscode fuzz-engine bench-engine clean help

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

picture: $(VENV)/.installed ## draw the picture of the README (needs EGL or OSMesa)
	$(BIN)/python examples/02_picture_of_the_cell.py docs/images/cell.png

bench-task: $(VENV)/.installed ## task 1.1 on twenty seeds, with and without attachments
	$(BIN)/python benchmarks/attach_hub_cover.py --seeds 20 --out docs/results/task-1.1.md

bench-language: $(VENV)/.installed ## how long reading and checking a domain takes
	$(BIN)/python benchmarks/language_speed.py --out docs/results/language.md

fuzz: $(VENV)/.installed ## read 100,000 wrong domain files (five minutes)
	$(BIN)/python benchmarks/fuzz_language.py --inputs 100000 --seed 1 --out docs/results/fuzz.md

mistakes: $(VENV)/.installed ## typical mistakes, and word for word what is said of them
	$(BIN)/python benchmarks/mistakes.py --out docs/results/mistakes.md

reference: $(VENV)/.installed ## put the code's tables into the language reference
	$(BIN)/python -m icarus_lite.language.reference docs/reference/language.md

fuzz-engine: $(VENV)/.installed-dev ## beliefs against clingo's on 10,000 random programs (a minute)
	ICARUS_FUZZ_PROGRAMS=10000 $(BIN)/python -m pytest -q -n 2 tests/differential

bench-engine: $(VENV)/.installed ## how inference from scratch grows with the scene
	$(BIN)/python benchmarks/engine_scaling.py

clean: ## remove the virtual environment and what tools left behind
	rm -rf $(VENV) .mypy_cache .ruff_cache .pytest_cache .hypothesis build dist
