"""The loop of the REPL: a line in, an answer out, until the end."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator

from rich.console import Console

from aapa import AnchoringError
from icarus_lite import IcarusError
from runtime.errors import RuntimeFault
from runtime.repl.book import answer
from runtime.repl.session import Session

WELCOME = "`help` lists the commands, `help why` explains one; Tab completes; Ctrl-D ends"


def converse(session: Session, console: Console | None = None) -> bool:
    """Read and answer until the person leaves, or the input ends.

    On a terminal with history, completion and colours; from a pipe or a file each line is shown
    before its answer, so that what comes out reads like a session.

    Returns:
        Whether all that was asked could be answered.
    """
    console = console or Console(highlight=False, soft_wrap=True)
    well = True
    for line in _lines(session, console):
        well &= _answered(session, line, console)
        if session.done:
            break
    return well


def _answered(session: Session, line: str, console: Console) -> bool:
    try:
        for each in answer(session, line):
            console.print(each, highlight=False)
    except (IcarusError, RuntimeFault, AnchoringError) as error:
        console.print(str(error), style="red", highlight=False, markup=False)
        return False
    except KeyboardInterrupt:
        console.print("interrupted; what was reached stays", style="yellow")
    return True


def _lines(session: Session, console: Console) -> Iterator[str]:
    if sys.stdin.isatty() and console.is_terminal:
        yield from _typed(session, console)
        return
    for line in sys.stdin:
        if line.strip():
            console.print(f"{_prompt(session)}{line.rstrip()}", markup=False, highlight=False)
        yield line


def _typed(session: Session, console: Console) -> Iterator[str]:
    from runtime.repl.prompt import prompt_session  # noqa: PLC0415 - only where there is a terminal

    console.print(WELCOME, style="dim", highlight=False)
    ask: Callable[[str], str] = prompt_session(session).prompt
    while True:
        try:
            line = ask(_prompt(session))
        except KeyboardInterrupt:
            continue  # the line is dropped, as in a shell
        except EOFError:
            return
        yield line


def _prompt(session: Session) -> str:
    at = f" {session.cycle}" if session.has_cycle else ""
    supposed = "*" if session.supposed else ""
    return f"{session.name}{at}{supposed}> "
