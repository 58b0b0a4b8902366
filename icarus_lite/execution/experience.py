"""What has been tried on the way to an aim, so that the same is not tried for ever."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable

from icarus_lite.execution.path import Bound, Level
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action

MAX_ATTEMPTS = 3
"""How often one action may fail before execution and planning do without it."""

MAX_BEGUN_ALIKE = 3
"""How often a skill instance may be begun in the very same state."""

MAX_BEGUN = 1_000
"""How often it may be begun at all on the way to one aim: percepts with noise never repeat."""

PAUSE_S = 60.0
"""How long another agent is not asked again for what it has not done, in s."""

PAUSE_CYCLES = 100
"""The same in cycles, where nobody tells the time."""

MAX_PLANS_ALIKE = 10
"""How often plans made in the very same state may be carried through without reaching the goal."""


@dataclass(frozen=True, slots=True)
class _Pause:
    """For how long another agent is not asked again for something, and why."""

    why: str
    until_cycle: int
    until_s: float | None

    def is_over(self, cycle: int, time_s: float | None) -> bool:
        if self.until_s is None or time_s is None:
            return cycle >= self.until_cycle
        return time_s >= self.until_s


class Experience:
    """Remembers which actions have failed, and in which states what was begun."""

    __slots__ = ("_begun", "_disappointments", "_failures", "_pauses", "_plans", "_times")

    def __init__(self) -> None:
        self._failures: dict[Action, list[str]] = {}
        self._disappointments: dict[tuple[Action, Hashable], list[str]] = {}
        self._begun: dict[tuple[int, Bound, Hashable], list[int]] = {}
        self._times: Counter[tuple[int, Bound]] = Counter()
        self._plans: Counter[Hashable] = Counter()
        self._pauses: dict[Action, _Pause] = {}

    @property
    def given_up(self) -> dict[Action, str]:
        """What is not to be used now, with the reason of its last failure.

        These are actions that have failed too often, and what other agents do not do for a while.
        """
        return {**self._failed_too_often(), **{a: each.why for a, each in self._pauses.items()}}

    @property
    def complaints(self) -> list[str]:
        """What is not to be used now, as sentences."""
        failed = self._failed_too_often().items()
        complaints = [f"{action} failed {MAX_ATTEMPTS} times: {why}" for action, why in failed]
        return complaints + [pause.why for pause in self._pauses.values()]

    def _failed_too_often(self) -> dict[Action, str]:
        failures = self._failures.items()
        given_up = {action: why[-1] for action, why in failures if len(why) >= MAX_ATTEMPTS}
        for (action, _), why in self._disappointments.items():
            if len(why) >= MAX_ATTEMPTS:
                given_up.setdefault(action, why[-1])
        return given_up

    def note_failure(self, action: Action, why: str) -> None:
        """Remember that an action has failed."""
        self._failures.setdefault(action, []).append(why)

    def note_disappointment(self, action: Action, scene: Hashable, why: str) -> None:
        """Remember that an action was carried out, and its effects were not believed.

        Only what happens from the very same state counts together: a hand that is lowered step
        by step, or in whose way somebody has come, need not be given up.
        """
        self._disappointments.setdefault((action, scene), []).append(why)

    def note_declined(self, action: Action, why: str, cycle: int, time_s: float | None) -> None:
        """Remember that another agent does not do what it was asked for, for a while."""
        until_s = None if time_s is None else time_s + PAUSE_S
        self._pauses[action] = _Pause(why, cycle + PAUSE_CYCLES, until_s)

    def end_pauses(self, cycle: int, time_s: float | None) -> None:
        """Let other agents be asked again for what has waited long enough.

        Args:
            cycle: The present cycle.
            time_s: The time in s; None where nobody tells it.
        """
        for action, pause in list(self._pauses.items()):
            if pause.is_over(cycle, time_s):
                del self._pauses[action]

    def note_success(self, action: Action) -> None:
        """Remember that an action works after all."""
        self._failures.pop(action, None)
        self._pauses.pop(action, None)
        for key in [key for key in self._disappointments if key[0] == action]:
            del self._disappointments[key]

    def note_begun(self, levels: Iterable[Level], scene: Hashable, cycle: int) -> None:
        """Remember the skills that are begun in a cycle."""
        for level in levels:
            instance = (id(level.clause), level.bindings)
            self._begun.setdefault((*instance, scene), []).append(cycle)
            self._times[instance] += 1

    def circle(self, level: Level, scene: Hashable) -> str:
        """Say why beginning a skill now would be going in a circle; empty if it would not."""
        instance = (id(level.clause), level.bindings)
        cycles = self._begun.get((*instance, scene), [])
        if len(cycles) >= MAX_BEGUN_ALIKE:
            shown = ", ".join(map(str, cycles))
            return f"it was begun in this same state in cycles {shown}"
        if self._times[instance] >= MAX_BEGUN:
            return f"it was begun {MAX_BEGUN} times already"
        return ""

    def note_plan_carried_through(self, scene: Hashable) -> None:
        """Remember that all steps of a plan made in a state have been done, each to its effect."""
        self._plans[scene] += 1

    def planning_in_vain(self, scene: Hashable) -> str:
        """Say why another plan from a state would not help; empty if it may."""
        if self._plans[scene] < MAX_PLANS_ALIKE:
            return ""
        return (
            f"plans from this same state were carried through {MAX_PLANS_ALIKE} times, "
            "and what they were for is not believed"
        )

    def forget_beginnings(self) -> None:
        """Begin afresh: what was aimed at is reached. Failures are remembered."""
        self._begun.clear()
        self._times.clear()
        self._plans.clear()
