"""What a command of the REPL is, and the book of all of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum, auto
from typing import TYPE_CHECKING

from icarus_lite.language.wording import closest
from runtime.errors import UsageError

if TYPE_CHECKING:
    from rich.console import RenderableType

    from runtime.repl.session import Session


class Takes(Enum):
    """What the words after a command are, for completion."""

    NOTHING = auto()
    PATTERN = auto()  # a literal over beliefs, percepts or skills
    OBJECT = auto()
    CYCLE = auto()
    COMMAND = auto()
    FILE = auto()
    TEXT = auto()


class CommandError(UsageError):
    """A command cannot be carried out as it was typed; the REPL goes on."""


@dataclass(frozen=True, slots=True)
class Command:
    """A command of the REPL.

    Args:
        name: Its name.
        usage: What follows the name, such as `[PATTERN]`.
        help: What it does, in one sentence.
        example: A line that could be typed.
        answer: Carries it out; gives what is to be shown.
        takes: What follows it.
        aliases: Shorter names.
        live: Whether it needs a run that can go on.
    """

    name: str
    usage: str
    help: str
    example: str
    answer: Callable[[Session, str], Iterator[RenderableType]]
    takes: Takes = Takes.NOTHING
    aliases: tuple[str, ...] = ()
    live: bool = False


class Commands:
    """The commands by their names.

    Args:
        groups: A heading and its commands, in the order of the help.
    """

    def __init__(self, groups: Sequence[tuple[str, Sequence[Command]]]) -> None:
        self.groups = tuple((heading, tuple(commands)) for heading, commands in groups)
        self._by_name = {
            name: command
            for _, commands in self.groups
            for command in commands
            for name in (command.name, *command.aliases)
        }

    def __iter__(self) -> Iterator[Command]:
        for _, commands in self.groups:
            yield from commands

    def get(self, name: str) -> Command | None:
        """Give a command by its name or an alias; None if there is none."""
        return self._by_name.get(name)

    def find(self, name: str) -> Command:
        """Give a command by its name or an alias.

        Raises:
            CommandError: there is none; the message says what may have been meant.
        """
        found = self._by_name.get(name)
        if found is not None:
            return found
        meant = closest(name, [command.name for command in self])
        hint = f"did you mean `{meant}`?" if meant else "`help` lists them all"
        raise CommandError(f"there is no command `{name}`; {hint}")


def number(text: str, what: str) -> int:
    """Read a whole number. Raises CommandError."""
    try:
        return int(text)
    except ValueError:
        raise CommandError(f"expected {what}, a whole number; got `{text}`") from None


def no_words(text: str, command: str) -> None:
    """See that nothing follows a command. Raises CommandError."""
    if text:
        raise CommandError(f"nothing follows `{command}`; got `{text}`")
