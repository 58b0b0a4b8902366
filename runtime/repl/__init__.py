"""The REPL: a run asked about and gone through, live or recorded, with the same commands."""

from runtime.repl.book import COMMANDS, answer
from runtime.repl.command import Command, CommandError
from runtime.repl.runs import CellRun, LiveRun, TypedRun
from runtime.repl.session import Session

__all__ = [
    "COMMANDS",
    "CellRun",
    "Command",
    "CommandError",
    "LiveRun",
    "Session",
    "TypedRun",
    "answer",
]
