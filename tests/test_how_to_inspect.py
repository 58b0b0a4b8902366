"""The session in the how-to, typed again: what it shows is what comes out."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from runtime.cli import app

ROOT = Path(__file__).parents[1]
_PROMPT = re.compile(r"^gearbox(?: \d+\*?)?> (.*)$", re.MULTILINE)


def test_the_session_goes_as_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    monkeypatch.chdir(ROOT)
    text = (ROOT / "docs" / "how-to" / "inspect.md").read_text()
    (told,) = re.findall(r"```text\n(.*?)\n```", text, re.DOTALL)
    typed = "".join(f"{line}\n" for line in _PROMPT.findall(told))
    assert typed.count("\n") > 20
    done = CliRunner().invoke(app, ["repl", "domains/gearbox.icr", "--task", "1.1"], input=typed)
    assert done.exit_code == 0
    assert [line.rstrip() for line in done.stdout.splitlines()] == told.splitlines()
