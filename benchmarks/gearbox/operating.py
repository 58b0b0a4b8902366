"""Who minds the arm in a run: sees to the cause of a stop, and gives the word to go on, or not.

Does what a person does at a robot, through what a person has there: eyes, the emergency stop's
button, and the pendant, whose commands the dashboard takes.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Mapping
from typing import Any, Final

from gearbox.safety import Notice
from runtime.controller.ports import DASHBOARD_PORT
from runtime.controller.process import ControllerProcess
from runtime.errors import ControllerError

_OFTEN: Final = 3
_ANSWER_WITHIN_S: Final = 5.0
_STANDSTILL_WITHIN_S: Final = 12.0
_LOOK_EVERY_S: Final = 0.02
_PROGRAM_ENDS_WITHIN_S: Final = 4.0
"""The driver sets the controller's watchdog to 1 s of wall time for a stand-in."""


def last_words(
    controller: ControllerProcess, *, ended: bool = False
) -> tuple[Mapping[str, Any], Mapping[str, Any]]:
    """Wait until the arm stands still; give the controller's journal and its state.

    Both are empty where there is no controller any more. Where the arm does not come to rest, the
    state says so.

    Args:
        controller: The controller.
        ended: Whether to wait for its program to end too: the watchdog may have to see to that.
    """
    give_up = time.monotonic() + _STANDSTILL_WITHIN_S
    end_up = time.monotonic() + _PROGRAM_ENDS_WITHIN_S
    while controller.alive:
        state, now = _asked(controller, "state"), time.monotonic()
        stands = bool(state) and state["steady"]
        over = not ended or now > end_up or (bool(state) and state["program"] is None)
        if now > give_up or (stands and over):
            return _asked(controller, "journal"), state
        time.sleep(_LOOK_EVERY_S)
    return {}, {}


def _asked(controller: ControllerProcess, what: str) -> Mapping[str, Any]:
    """Ask a controller's bench; empty if it does not answer."""
    try:
        answer = controller.bench({"query": what})
    except ControllerError:
        return {}
    found: Mapping[str, Any] = answer.get(what, answer)
    return found


class Operator:
    """A person beside the arm; give it to a run as its operator.

    Args:
        controller: The arm's.
        willing: Whether the word is given at all.
    """

    def __init__(self, controller: ControllerProcess, *, willing: bool) -> None:
        self._controller = controller
        self._willing = willing
        self.notices: list[Notice] = []

    def __call__(self, reason: str) -> bool:
        """Watch the arm come to rest, see to the cause; say whether it may be set going again."""
        notice = self._watch(reason)
        if notice is None:
            return False
        self.notices.append(notice)
        # Nobody stands there and says yes for ever.
        if not self._willing or not notice.stood or len(self.notices) > _OFTEN:
            return False
        if "emergency stop" in reason:
            try:
                self._controller.bench({"fault": {"emergency_stop": False}})
                self._press("power on", "brake release")
            except (ControllerError, OSError):
                return False
        return True

    def _watch(self, reason: str) -> Notice | None:
        """Watch until the arm stands still; None where there is no controller any more."""
        first = _asked(self._controller, "journal")
        give_up = time.monotonic() + _STANDSTILL_WITHIN_S
        while self._controller.alive and not first and time.monotonic() < give_up:
            first = _asked(self._controller, "journal")  # a controller that hangs answers later
        last, state = last_words(self._controller)
        if not (first and last and state):
            return None
        went = float(last["travel_rad"]) - float(first["travel_rad"])
        return Notice(reason, float(first["time_s"]), round(went, 6), bool(state["steady"]))

    def _press(self, *commands: str) -> None:
        """Give commands on the pendant, one after the other."""
        where = (self._controller.address, DASHBOARD_PORT)
        with (
            socket.create_connection(where, _ANSWER_WITHIN_S) as link,
            link.makefile("rw") as lines,
        ):
            lines.readline()
            for command in commands:
                lines.write(f"{command}\n")
                lines.flush()
                lines.readline()
