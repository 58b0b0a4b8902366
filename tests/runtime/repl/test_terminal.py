"""The REPL as a person has it: typed at through a pseudo-terminal."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import pexpect
import pyte
import pytest
from recorded_runs import record

from runtime.repl import COMMANDS

GEARBOX = Path(__file__).parents[3] / "domains" / "gearbox.icr"
_DEADLINE_S = 30
_LINES, _COLUMNS = 50, 120
_PROMPT = re.compile(r"[\w.]+( \d+\*?)?>|\.+")


class Terminal:
    """A REPL in a terminal, and what stands on its screen."""

    def __init__(self, home: Path, *arguments: str) -> None:
        self._screen = pyte.Screen(_COLUMNS, _LINES)
        self._stream = pyte.Stream(self._screen)
        self._child = pexpect.spawn(
            sys.executable,
            ["-m", "runtime.cli", "repl", *arguments],
            env={
                **os.environ,
                "TERM": "xterm",
                "HOME": str(home),
                "XDG_STATE_HOME": str(home / "state"),
                "PROMPT_TOOLKIT_NO_CPR": "1",
            },
            dimensions=(_LINES, _COLUMNS),
            timeout=_DEADLINE_S,
            encoding="utf-8",
        )

    def sees(self, text: str) -> None:
        """Wait until a text stands on the screen."""
        while not self.shows(text):
            self._feed()

    def asks(self) -> None:
        """Wait until the cursor stands behind a prompt, with nothing typed yet."""
        while not _PROMPT.fullmatch(self._screen.display[self._screen.cursor.y].rstrip()):
            self._feed()

    def _feed(self) -> None:
        """Take in what comes next, or fail with what stands on the screen."""
        try:
            self._stream.feed(self._child.read_nonblocking(4096, timeout=_DEADLINE_S))
        except pexpect.TIMEOUT:
            shown = "\n".join(line.rstrip() for line in self._screen.display if line.strip())
            pytest.fail(f"nothing more came; on the screen stands\n{shown}")

    def shows(self, text: str) -> bool:
        """Tell whether a text stands on the screen, be it broken at the edge."""
        shown, wanted = (re.sub(" +", " ", each) for each in ("".join(self._screen.display), text))
        return wanted in shown

    def types(self, text: str) -> None:
        """Type keys as they are."""
        self._child.send(text)

    def enters(self, text: str) -> None:
        """Type a line, once it is asked for."""
        self.asks()
        self._child.send(f"{text}\r")

    def ends(self) -> int:
        """Wait for the end, and give the exit status."""
        self._child.expect(pexpect.EOF)
        self._child.close()
        return int(self._child.exitstatus or 0)

    def close(self) -> None:
        """Let go of it, whatever state it is in."""
        self._child.close(force=True)


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Terminal]:
    run = record(tmp_path / "run.jsonl", seed=4, cycles=30)
    opened = Terminal(tmp_path, str(run.path))
    yield opened
    opened.close()


def test_a_question_is_answered_and_the_session_ends(terminal: Terminal) -> None:
    terminal.sees("`help` lists the commands")
    terminal.sees("run.jsonl 29>")
    terminal.enters("when (stored old)")
    terminal.sees("(stored old)  from cycle 0 on")
    terminal.enters("goto 3")
    terminal.sees("cycle 3")
    terminal.sees("run.jsonl 3>")
    terminal.enters("quit")
    assert terminal.ends() == 0


def test_enter_goes_on_until_the_parentheses_are_closed(terminal: Terminal) -> None:
    terminal.sees("run.jsonl 29>")
    terminal.enters("when (stored")
    terminal.sees("....")
    terminal.enters("old)")
    terminal.sees("(stored old)  from cycle 0 on")


def test_tab_completes(terminal: Terminal) -> None:
    terminal.sees("run.jsonl 29>")
    terminal.types("when (stor\t")
    terminal.sees("when (store")
    terminal.types("\x15hierar\t")
    terminal.sees("hierarchy")
    terminal.types("\r")
    terminal.sees(" in cycle ")


def test_a_wrong_line_is_told_and_the_session_goes_on(terminal: Terminal) -> None:
    terminal.sees("run.jsonl 29>")
    terminal.enters("goto 1000")
    terminal.sees("has no cycle 1000: its cycles are 0 to 29")
    terminal.enters("whyy (stored old)")
    terminal.sees("did you mean `why`?")
    terminal.asks()
    terminal.types("half a line")
    terminal.sees("run.jsonl 29> half a line")
    terminal.types("\x03")  # Ctrl-C drops the line
    terminal.enters("where")
    terminal.sees("looking at cycle 29")
    terminal.asks()
    terminal.types("\x04")  # Ctrl-D
    assert terminal.ends() == 2  # something that was asked could not be answered


def test_what_was_typed_comes_back_in_the_next_session(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=4, cycles=5)
    for keys in ("where\r", "\x1b[A\x1b[A\r"):  # arrows up: past `quit`, to `where`
        terminal = Terminal(tmp_path, str(run.path))
        try:
            terminal.sees("run.jsonl 4>")
            terminal.types(keys)
            terminal.sees("looking at cycle 4")
            terminal.enters("quit")
            assert terminal.ends() == 0
        finally:
            terminal.close()


def test_a_domain_runs_live(tmp_path: Path) -> None:
    terminal = Terminal(tmp_path, str(GEARBOX), "--task", "1.1")
    try:
        terminal.sees("gearbox>")
        terminal.enters("percept (hand hand1 ^reach 0.85)")
        terminal.sees("perceived from the next cycle on")
        terminal.enters("step")
        terminal.sees("+ (free hand1)")
        terminal.sees("gearbox 0>")
        terminal.enters("why (free hand1)")
        terminal.sees("by its definition")
        terminal.asks()
        terminal.types("\x04")
        assert terminal.ends() == 0
    finally:
        terminal.close()


def test_every_command_as_its_help_gives_it(tmp_path: Path) -> None:
    terminal = Terminal(tmp_path, str(GEARBOX), "--task", "1.1")
    try:
        terminal.sees("gearbox>")
        scene = (
            "(hand hand1 ^reach 0.85)",
            "(object hubcover ^type hubcover ^x 0.4 ^y 0.1 ^z 0.01 ^seen yes)",
            "(object case ^type case ^x 0.4 ^y -0.1 ^z 0.03 ^seen yes)",
        )
        for percept in scene:
            terminal.enters(f"percept {percept}")
        terminal.enters("step 3")
        terminal.sees("gearbox 2>")
        typed = [command.example for command in COMMANDS if command.name != "quit"]
        for number, line in enumerate(typed):
            terminal.enters(line)
            terminal.enters(f"(asked-{number} ?x)")
            terminal.sees(f"nothing matches (asked-{number} ?x)")  # so the line was answered
            assert not terminal.shows("Traceback")
        terminal.enters("quit")
        terminal.ends()
    finally:
        terminal.close()
