"""Waiting for the world: robot time must not run away from whoever simulates what the arm touches.

A simulated cell moves its parts after the arm and tells the controller what the tool is near. On a
busy machine it comes late, while the arm of a fast clock goes on, at last through what it was never
told of. A cell that says each time that it has looked is waited for: an arm that moves, or presses,
has little time once it is some way ahead.
"""

from __future__ import annotations

from typing import Final

from runtime.controller.control_box import ControlBox

LEAD_S: Final = 0.25
"""So much robot time may pass between two looks without any waiting, s."""

_WAITING: Final = 0.25  # robot time for wall time, from then on: slow, but its clients hear from it
_GONE_S: Final = 2.0  # who has not looked for so long, in wall time, does so no more
_MOVES_RAD_S: Final = 0.001


class Following:
    """Knows when the world was last moved after the arm, if anybody does that.

    Args:
        box: The control box whose arm is followed.
    """

    def __init__(self, box: ControlBox) -> None:
        self._box = box
        self._seen_s = 0.0
        self._gone_at_s: float | None = None

    def looked(self, now_s: float) -> None:
        """Note that the arm's state was taken account of.

        Args:
            now_s: Wall time, monotonic, s.
        """
        self._seen_s, self._gone_at_s = self._box.time_s, now_s + _GONE_S

    def ended(self) -> None:
        """Note that nobody follows the arm any more."""
        self._gone_at_s = None

    def pace(self, clock: float, now_s: float) -> float:
        """Give how much robot time is to pass for the wall time that has passed.

        Args:
            clock: What it would be if nobody had to be waited for.
            now_s: Wall time, monotonic, s.
        """
        if self._gone_at_s is None:
            return clock
        if now_s > self._gone_at_s:
            self._gone_at_s = None
            return clock
        behind = self._box.time_s - self._seen_s > LEAD_S
        return min(clock, _WAITING) if behind and self._is_busy() else clock

    def _is_busy(self) -> bool:
        """Tell whether the arm moves, or presses on something."""
        arm = self._box.arm
        return arm.force_mode is not None or float(abs(arm.state.qd).max()) > _MOVES_RAD_S
