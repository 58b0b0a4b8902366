"""The how-to on testing a domain: its files and its commands, executed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = (Path(__file__).parent.parent / "docs" / "how-to" / "test-a-domain.md").read_text()
WHOLE, CHANGED = re.findall(r"```lisp\n(.*?)```", PAGE, re.DOTALL)
PASSES, FAILS, PYTEST = re.findall(r"```console\n(.*?)```", PAGE, re.DOTALL)


def run(folder: Path, session: str) -> tuple[int, str, str]:
    """Run the command of a console block; give its status, its output and what was promised."""
    prompt, _, promised = session.partition("\n")
    program, *arguments = prompt.removeprefix("$ ").split()
    module = {"icarus": "runtime.cli", "pytest": "pytest"}[program]
    done = subprocess.run(
        [sys.executable, "-m", module, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.stderr == ""
    return done.returncode, done.stdout, promised


@pytest.fixture
def lamps(tmp_path: Path) -> Path:
    (tmp_path / "lamps.icr").write_text(WHOLE)
    return tmp_path / "lamps.icr"


def test_the_domain_has_no_problems(lamps: Path) -> None:
    status, out, _ = run(lamps.parent, "$ icarus check lamps.icr\n")
    assert (status, out) == (0, "1 file: no problems\n")


def test_its_tests_hold_as_shown(lamps: Path) -> None:
    status, out, promised = run(lamps.parent, PASSES)
    assert (status, out) == (0, promised)


def test_the_failure_reads_as_shown(lamps: Path) -> None:
    start = WHOLE.index('(test "one lamp')
    end = WHOLE.index("(test", start + 1)
    lamps.write_text(f"{WHOLE[:start]}{CHANGED}\n{WHOLE[end:]}")
    status, out, promised = run(lamps.parent, FAILS)
    assert (status, out) == (1, promised)


def test_pytest_collects_them_as_shown(lamps: Path) -> None:
    (lamps.parent / "pytest.ini").write_text("[pytest]\n")
    status, out, promised = run(lamps.parent, PYTEST)
    assert status == 0
    without_time = re.compile(r" in [\d.]+s")
    assert without_time.sub("", out) == without_time.sub("", promised)


def test_every_field_of_a_test_is_told() -> None:
    grammar = Path(__file__).parent.parent / "icarus_lite" / "language" / "reading" / "grammar.lark"
    rules = re.findall(r"\?(?:test|cycle)_field:.*?\n\n", grammar.read_text(), re.DOTALL)
    terminals = set(re.findall(r"\b([A-Z_]{4,})\b", "".join(rules))) - {"LPAR", "RPAR"}
    told = set(re.findall(r"^\| `(:[a-z-]+)", PAGE, re.MULTILINE))
    fields = {":" + name.removesuffix("_FIELD").lower().replace("_", "-") for name in terminals}
    assert told == fields
