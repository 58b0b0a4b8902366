"""The how-to for planning: what it shows is what the commands print."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from runtime.cli import app

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "docs" / "how-to" / "plan.md").read_text()


@pytest.fixture(autouse=True)
def at_home(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)


def printed(*options: str) -> str:
    command = ["plan", "domains/blocks.icr", "--task", "sussman", *options]
    assert f"icarus {' '.join(command)}\n" in TEXT
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0
    return done.stdout


def test_what_is_shown_of_the_explanation_is_printed() -> None:
    shown = re.findall(r"```text\n(.*?)```", TEXT, re.DOTALL)
    assert len(shown) == 2
    explained = printed("--explain")
    assert explained.startswith(shown[0])
    assert shown[1] in explained


def test_the_macro_is_printed_as_shown() -> None:
    (shown,) = re.findall(r"```lisp\n(.*?)```", TEXT, re.DOTALL)
    assert printed("--macro") == shown


def test_the_steps_alone_are_printed_without_options() -> None:
    assert printed().splitlines()[0] == "  1  (unstack hand1 c a)"
