"""The second look: with nothing to do, the arm goes back to where everything can be seen.

Neither a goal that is believed nor an impasse ends a run by itself. Both may come of what the held
part hid, or of a person who has not finished: so the arm goes to its look pose, and the run ends
only if nothing else is believed after a while there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum, auto

from aapa import Anchor
from icarus_lite import Action, Outcome, Status
from runtime.drivers import PARK, Driver
from runtime.percepts import HAND


@dataclass(frozen=True, slots=True)
class LoopLimits:
    """When the loop gives up.

    Args:
        patience: Cycles in a row without a plan, arm at rest, before the task has failed.
        patience_s: The least time of that, on the arm's clock, s: whoever carries a part off to
            the other side of the table may bring it back.
        confirm: Cycles in a row, arm back at the look pose, in which the goals must be believed:
            enough for what is seen to speak against it.
        confirm_s: The least time of that, on the arm's clock, s.
        company_s: How long a look may begin anew again and again because the hand of a person is
            in sight, who knows what it is about to do, or because something speaks against the
            goals. On the arm's clock, s.
        run_s: The longest a run may take, on the arm's clock, s.
        cycles: The most cycles of one run, whatever that clock says.
    """

    patience: int = 15
    patience_s: float = 15.0
    confirm: int = 16
    confirm_s: float = 1.0
    company_s: float = 30.0
    run_s: float = 900.0
    cycles: int = 100_000


class _Arm(Enum):
    """Where the arm is with regard to its look pose."""

    ELSEWHERE = auto()
    ON_THE_WAY = auto()
    AT_LOOK_POSE = auto()


class SecondLook:
    """Takes the arm to its look pose, and counts how long it has looked from there.

    Args:
        driver: The body.
        limits: How long is long enough.
        begun: Whether the arm stands at its look pose already.
    """

    __slots__ = (
        "_achieved",
        "_arm",
        "_began_s",
        "_cycles",
        "_driver",
        "_limits",
        "_since_s",
        "_visited",
    )

    def __init__(self, driver: Driver, limits: LoopLimits, *, begun: bool) -> None:
        self._driver = driver
        self._limits = limits
        self._arm = _Arm.AT_LOOK_POSE if begun else _Arm.ELSEWHERE
        self._achieved: bool | None = None
        self._cycles = 0
        self._began_s = 0.0
        self._since_s = 0.0
        self._visited = False

    @property
    def there(self) -> bool:
        """Whether the arm is at its look pose."""
        return self._arm is _Arm.AT_LOOK_POSE

    @property
    def visited(self) -> bool:
        """Whether a person's hand has been in sight since the arm last did something."""
        return self._visited

    def notice(self, *, company: bool) -> None:
        """Take note in each cycle of whether a person's hand is in sight."""
        self._visited = self._visited or company

    def retreat(self, outcomes: Sequence[Outcome], anchors: Mapping[str, Anchor]) -> str | None:
        """Go back to the look pose, or go on going there; say so if that cannot be.

        Raises:
            DriverError: the way back failed because the arm is lost.
        """
        for outcome in outcomes:
            if outcome.action == PARK and outcome.status is Status.FAILED:
                self._driver.state()  # an arm that is lost says so by itself
                return f"the arm cannot go back to its look pose: {outcome.reason}"
            if outcome.action == PARK and outcome.status is Status.SUCCEEDED:
                self._arm = _Arm.AT_LOOK_POSE
        if self._arm is _Arm.ELSEWHERE:
            self._driver.start(PARK, (Action("rest", (HAND,)),), anchors)
            self._arm, self._achieved = _Arm.ON_THE_WAY, None
        return None

    def break_off(self) -> None:
        """Stop on the way back, if the arm is on it: there is something to do."""
        if self._arm is _Arm.ON_THE_WAY:
            self._driver.stop()
        self._arm, self._visited = _Arm.ELSEWHERE, False

    def lost(self) -> None:
        """Take note that the arm was stopped from outside, wherever it is."""
        self._arm, self._achieved = _Arm.ELSEWHERE, None

    def interrupt(self) -> None:
        """Begin to count anew: something else is believed."""
        self._achieved = None

    def count(self, now_s: float, *, achieved: bool, unsettled: bool) -> None:
        """Count a cycle of looking.

        What was believed while a person's hand was in sight does not count: it may be about to
        make it untrue, or have hidden that it is. Nor does what is in doubt already.

        Args:
            now_s: The time, on the arm's clock.
            achieved: Whether the goals are believed; if not, there is no way to them.
            unsettled: Whether the look is to begin anew, unless it has done so for too long.
        """
        if achieved is not self._achieved:
            self._achieved, self._cycles = achieved, 0
            self._began_s = self._since_s = now_s
        elif unsettled and now_s - self._began_s < self._limits.company_s:
            self._cycles, self._since_s = 0, now_s
        self._cycles += 1

    def confirmed(self, now_s: float, *, doubtful: bool) -> bool:
        """Whether a goal that was believed all the time counts as achieved.

        Args:
            now_s: The time, on the arm's clock.
            doubtful: Whether it is believed of something that could have been seen to be so, and
                was not. Then it takes as long as an impasse: whoever took it may bring it back.
        """
        limits, seconds = self._limits, now_s - self._since_s
        if self._cycles < limits.confirm or seconds < limits.confirm_s:
            return False
        return not doubtful or seconds >= limits.patience_s

    def in_vain(self, now_s: float) -> bool:
        """Whether there was nothing that could be done for so long that the task has failed."""
        limits = self._limits
        return self._cycles >= limits.patience and now_s - self._since_s >= limits.patience_s
