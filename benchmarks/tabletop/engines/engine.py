"""What an engine must do to be measured."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from tabletop.oracle import Facts
from tabletop.scene import Frame, State


class Engine(Protocol):
    """An engine with the rules loaded and nothing given yet.

    `begin` and the function that `prepare` gives are timed, everything else is not.
    """

    def begin(self, state: State) -> None:
        """Derive everything from what is given in frame 0."""

    def prepare(self, frame: Frame, state: State) -> Callable[[], None]:
        """Give what brings the derived facts up to date.

        Args:
            frame: What is different; for engines that keep what they have derived.
            state: All that is given; for engines that begin anew, in whatever form they like.
        """

    def facts(self) -> Facts:
        """Give all derived facts."""
