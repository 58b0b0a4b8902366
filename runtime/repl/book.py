"""All commands of the REPL, in the order of its help; and the help itself."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import RenderableType
from rich.table import Table

from runtime.repl.command import Command, Commands, Takes, no_words
from runtime.repl.living import LIVING
from runtime.repl.looking import LOOKING
from runtime.repl.moving import MOVING
from runtime.repl.questions import QUESTIONS
from runtime.repl.session import Session
from runtime.repl.showing import heading, line, lines
from runtime.repl.what_if import WHAT_IF


def show_help(session: Session, text: str) -> Iterator[RenderableType]:
    """Explain a command, or list them all."""
    if text:
        command = COMMANDS.find(text)
        yield heading(f"{command.name} {command.usage}".rstrip())
        told = [f"  {command.help}", f"  for example: {command.example}"]
        if command.aliases:
            told.append(f"  in short: {', '.join(command.aliases)}")
        if command.live and session.live is None:
            told.append("  (this run is over, so that it has no effect here)")
        yield lines(told)
        return
    for name, commands in COMMANDS.groups:
        table = Table(box=None, pad_edge=False, show_header=False, title=name)
        table.title_justify, table.title_style = "left", "bold"
        table.add_column(style="cyan", no_wrap=True)
        table.add_column()
        for command in commands:
            table.add_row(f"{command.name} {command.usage}".rstrip(), command.help)
        yield table
    yield line("a pattern alone, such as (attached ?part case), asks `beliefs` for it")


def leave(session: Session, text: str) -> Iterator[RenderableType]:
    """End the session."""
    no_words(text, "quit")
    session.done = True
    yield from ()


_REST = (
    Command(
        "help",
        "[COMMAND]",
        "List the commands, or explain one with an example.",
        "help why-not",
        show_help,
        Takes.COMMAND,
        ("?",),
    ),
    Command("quit", "", "End the session.", "quit", leave, aliases=("exit", "q")),
)

COMMANDS = Commands(
    (
        ("Look", LOOKING),
        ("Ask", QUESTIONS),
        ("Move in time", MOVING),
        ("Suppose", WHAT_IF),
        ("Run", LIVING),
        ("Else", _REST),
    )
)
"""All commands."""


def answer(session: Session, text: str) -> Iterator[RenderableType]:
    """Carry out a line that was typed.

    Raises:
        CommandError: it cannot be carried out as it stands.
        IcarusError: what it asks for cannot be answered.
    """
    words = text.strip()
    if not words or words.startswith(";"):
        return
    if words.startswith("("):
        yield from COMMANDS.find("beliefs").answer(session, words)
        return
    name, _, rest = words.partition(" ")
    rest = " ".join(rest.split("\n")).strip()
    yield from COMMANDS.find(name).answer(session, rest)
