"""The people of a cell, as the loop knows them: who works at the table, and who minds the arm.

A person in a real cell would be asked by voice or on a screen, and tell by a button. What nobody
tells has to be seen.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias

from aapa import Anchor
from icarus_lite import Action, Outcome

Operator: TypeAlias = Callable[[str], bool]
"""Is told why the arm stopped, and says whether it may be set going again."""


class Colleague(Protocol):
    """Another agent at the table."""

    def ask(self, action: Action, sentence: str, anchors: Mapping[str, Anchor]) -> None:
        """Ask for an action, with the objects where they are anchored now. Does not wait."""

    def reports(self, anchors: Mapping[str, Anchor]) -> tuple[Outcome, ...]:
        """Give what has been reported since the last call: actions done, asked for or not.

        Args:
            anchors: The objects where they are anchored now. What is reported speaks of them by
                their names, whatever names the other agent has for them.
        """


class Nobody:
    """Works alone: a colleague who neither does nor says anything."""

    def ask(self, action: Action, sentence: str, anchors: Mapping[str, Anchor]) -> None:
        """Say it to an empty room."""

    def reports(self, _anchors: Mapping[str, Anchor]) -> tuple[Outcome, ...]:
        """Report nothing."""
        return ()


@dataclass(frozen=True, slots=True)
class People:
    """Who there is besides the robot.

    Args:
        colleague: Who else works at the table.
        operator: Whose word it takes to set the arm going again after it was stopped or lost.
            Without one, a run ends there.
    """

    colleague: Colleague = field(default_factory=Nobody)
    operator: Operator | None = None
