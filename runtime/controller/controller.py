"""The loop: one thread that serves the ports and advances the control box in time."""

from __future__ import annotations

import logging
import os
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from types import FrameType
from typing import Final, Self

from runtime.controller.bench import BenchServer
from runtime.controller.connections import Connection, Network
from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard import DashboardServer
from runtime.controller.fault_actions import FaultActions, FaultSchedule
from runtime.controller.faults import Fault
from runtime.controller.following import Following
from runtime.controller.ports import BENCH_PORT, DASHBOARD_PORT, RTDE_PORT, SCRIPT_PORTS
from runtime.controller.rtde_server import RtdeServer
from runtime.controller.script_server import ScriptServer
from runtime.controller.versions import Version
from runtime.kinematics import ArmModel, Joints

_LOG: Final = logging.getLogger("runtime.controller")
_HOPELESS_S: Final = 0.1  # further behind than this, lost periods are skipped, not made up for
_LOOK_FOR_PARENT_S: Final = 0.5
_NAP_S: Final = 0.02


@dataclass(frozen=True, slots=True)
class Settings:
    """How a controller is to run.

    Args:
        model: The arm.
        address: Where to listen.
        clock: Control cycles of robot time per control period of wall time, > 0; fewer while a
            simulated cell has to be waited for, see `runtime.controller.following`.
        joints: Where the arm stands at first, rad.
        parent: The process whose end is this one's too; None to live alone.
        version: The PolyScope version to play; None takes the usual one for the arm.
        faults: What is to go wrong.
    """

    model: ArmModel
    address: str
    clock: float
    joints: Joints
    parent: int | None
    version: Version | None = None
    faults: tuple[Fault, ...] = ()


class Controller:
    """A stand-in controller with all its ports open.

    Args:
        settings: How to run.
        write: Takes the journal, line by line; None keeps it in memory only.

    Raises:
        ControllerError: A port is busy or the address is not this machine's.
    """

    def __init__(self, settings: Settings, write: Callable[[str], None] | None = None) -> None:
        self._settings = settings
        box = self._box = ControlBox(
            settings.model, time.monotonic, settings.joints, settings.version
        )
        box.journal.write = write
        self._network = Network()
        self._rtde = RtdeServer(box)
        dashboard = DashboardServer(box)
        self._actions = FaultActions(box, self._rtde, dashboard)
        self._following = Following(box)
        self._bench = BenchServer(box, self._actions, self._following)
        self._bench.schedule = FaultSchedule(settings.faults, box, self._actions.act)
        self._stopping = False
        self._parent_is_there = _parent_watch(settings.parent)
        self._owed_cycles = 0.0
        scripts = ScriptServer(box)
        # What is wrong from the beginning is so before anybody can connect.
        self._bench.schedule.step()
        try:
            listen = self._network.listen
            listen(settings.address, BENCH_PORT, self._bench.accept)
            listen(settings.address, DASHBOARD_PORT, dashboard.accept)
            for port in SCRIPT_PORTS:
                listen(settings.address, port, scripts.accept)
            listen(settings.address, RTDE_PORT, self._rtde.accept)
        except BaseException:
            self._network.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self._network.close()
        self._box.journal.close()

    def stop_on_signals(self) -> None:
        """Let SIGTERM and SIGINT end the loop in good order."""
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, self._on_signal)

    def run(self) -> int:
        """Run until told to stop, or until the parent is gone; the exit status."""
        period = self._box.cycle_s
        due = time.monotonic() + period
        while not self._stopping and self._parent_is_there():
            self._network.poll(max(0.0, due - time.monotonic()), self._violated)
            if self._actions.silence_s > 0:
                self._be_silent()
            now = time.monotonic()
            if now >= due:
                self._advance()
                wait = period * self._actions.pace()
                due = due + wait if now - due < _HOPELESS_S else now + wait
            if self._actions.dying:
                return 1
        return 0

    def _advance(self) -> None:
        self._owed_cycles += self._following.pace(self._settings.clock, time.monotonic())
        while self._owed_cycles >= 1.0:
            self._owed_cycles -= 1.0
            self._box.cycle()
            self._bench.schedule.step()
            self._actions.pass_by()
        self._rtde.publish()

    def _be_silent(self) -> None:
        """Do nothing at all for the time asked, sockets open, but hear signals."""
        until = time.monotonic() + self._actions.silence_s
        self._actions.silence_s = 0.0
        while not self._stopping and self._parent_is_there() and time.monotonic() < until:
            time.sleep(_NAP_S)

    def _violated(self, connection: Connection, reason: str) -> None:
        _LOG.warning("%s was cut off: %s", connection.peer, reason)

    def _on_signal(self, _number: int, _frame: FrameType | None) -> None:
        self._stopping = True


def _parent_watch(parent: int | None) -> Callable[[], bool]:
    """Give a cheap question: is the parent still there?"""
    if parent is None:
        return lambda: True
    own = os.getppid() == parent
    next_look = 0.0
    there = True

    def is_there() -> bool:
        nonlocal next_look, there
        now = time.monotonic()
        if now >= next_look:
            next_look = now + _LOOK_FOR_PARENT_S
            # A child whose parent dies is given another; a stranger has to be looked for.
            there = os.getppid() == parent if own else _exists(parent)
        return there

    return is_there


def _exists(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
