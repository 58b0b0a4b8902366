"""What a run has done so far, and which objects it has lost sight of for good."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

from aapa import Anchor
from icarus_lite import Outcome, Status


@dataclass(frozen=True, slots=True)
class ActionRecord:
    """An action that was started, and how it ended."""

    cycle: int
    action: str
    status: str


@dataclass(frozen=True, slots=True)
class LoopResult:
    """How a run ended: achieved or not, why, after how many cycles, by which actions.

    `recoveries` are the reasons for which the arm had stopped and was set going again.
    """

    achieved: bool
    reason: str
    cycles: int
    actions: tuple[ActionRecord, ...]
    recoveries: tuple[str, ...] = ()


class RunRecord:
    """Keeps the actions of a run, its recoveries, and what became of the anchors that are gone."""

    __slots__ = ("_actions", "_gone", "_recoveries")

    def __init__(self) -> None:
        self._actions: list[ActionRecord] = []
        self._recoveries: list[str] = []
        self._gone: dict[str, str] = {}

    def started(self, cycle: int, action: object, status: str = Status.RUNNING) -> None:
        """An action was started, or somebody was asked for it."""
        self._actions.append(ActionRecord(cycle, str(action), str(status)))

    def recovered(self, reason: str) -> None:
        """The arm, which had stopped for this reason, was set going again."""
        self._recoveries.append(reason)

    def cycle(
        self,
        number: int,
        outcomes: Sequence[Outcome],
        before: Sequence[Anchor],
        now: Sequence[Anchor],
        frame: int,
    ) -> None:
        """A cycle is over.

        Args:
            number: The cycle.
            outcomes: What was reported in it.
            before: The anchors there were before it.
            now: The anchors there are now.
            frame: The last frame that the anchors are of.
        """
        for outcome in outcomes:
            if self._actions and self._actions[-1].action == str(outcome.action):
                self._actions[-1] = replace(self._actions[-1], status=str(outcome.status))
        names = {anchor.name for anchor in now}
        for anchor in before:
            if anchor.name not in names:
                self._gone[anchor.name] = (
                    f"{anchor.name} is no longer anchored since cycle {number}, after "
                    f"{frame - anchor.last_seen} cycles in which it was not seen and nothing said "
                    "where it went"
                )
        for name in names:
            self._gone.pop(name, None)

    def gone(self, names: Collection[str]) -> list[str]:
        """Say what became of those of these objects that are no longer anchored."""
        return [sentence for name, sentence in self._gone.items() if name in names]

    def result(self, reason: str, cycles: int, *, achieved: bool) -> LoopResult:
        """Give what the run came to."""
        return LoopResult(achieved, reason, cycles, tuple(self._actions), tuple(self._recoveries))
