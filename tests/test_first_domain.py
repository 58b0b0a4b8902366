"""The tutorial: its files are written and its commands run, in the order of the page."""

from __future__ import annotations

import io
import re
import shlex
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from runtime.cli import main

PAGE = Path(__file__).parents[1] / "docs" / "tutorials" / "first-domain.md"
BLOCKS = re.compile(
    r"^```(?:(?:lisp|json) file=(?P<file>\S+)|console)\n(?P<text>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
COMMANDS = re.compile(r"^\$ icarus ([^\n]*)\n((?:(?!\$ ).*\n)*)", re.MULTILINE)


def terminal(command, monkeypatch):
    """Give what a terminal would show of a command: both streams, as they come."""
    shown = io.StringIO()
    monkeypatch.setattr(sys, "argv", ["icarus", *shlex.split(command)])
    with redirect_stdout(shown), redirect_stderr(shown), pytest.raises(SystemExit):
        main()
    return shown.getvalue()


def test_every_command_says_what_the_page_shows(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ran = []
    for block in BLOCKS.finditer(PAGE.read_text(encoding="utf-8")):
        if block["file"]:
            (tmp_path / block["file"]).write_text(block["text"], encoding="utf-8")
            continue
        for command, promised in COMMANDS.findall(block["text"]):
            assert terminal(command, monkeypatch) == promised, command
            ran.append(command.split()[0])
    assert " ".join(ran) == "check check check check infer check infer check test plan plan"


def test_every_block_of_the_page_is_used():
    text = PAGE.read_text(encoding="utf-8")
    assert text.count("```") == 2 * len(BLOCKS.findall(text))
