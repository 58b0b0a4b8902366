"""Letting things go wrong: what each kind of fault does to a controller."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Mapping
from typing import Final

from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard import DashboardServer
from runtime.controller.faults import Fault
from runtime.controller.rtde_server import RtdeServer


class FaultActions:
    """Carries faults out, and undoes those that pass.

    Args:
        box: The control box.
        rtde: Its RTDE port.
        dashboard: Its dashboard port.
    """

    def __init__(self, box: ControlBox, rtde: RtdeServer, dashboard: DashboardServer) -> None:
        self.silence_s = 0.0
        """For how long the loop shall do nothing at all from now on, wall time."""
        self.dying = False
        """Whether the process shall end now."""
        self._slowness = 1.0
        self._slow_until = 0.0
        self._box = box
        self._rtde = rtde
        self._dashboard = dashboard
        self._undoing: list[tuple[float, Callable[[], None]]] = []
        self._acts: Final[Mapping[str, Callable[[Fault], None]]] = {
            "protective_stop": self._protective_stop,
            "emergency_stop": self._emergency_stop,
            "kill_script": lambda _: self._box.stop_program("killed by a fault"),
            "drop_rtde": lambda _: self._rtde.drop_all(),
            "drop_dashboard": lambda _: self._dashboard.drop_all(),
            "stall": self._stall,
            "slow": self._slow,
            "refuse_remote": self._refuse_remote,
            "occupy_registers": self._occupy,
            "garbage": self._garbage,
            "die": self._die,
        }

    def act(self, fault: Fault) -> None:
        """Let a fault happen, and write it in the journal."""
        self._box.warn(f"fault: {fault}")
        self._box.journal.note("fault", str(fault))
        self._acts[fault.kind](fault)

    def pass_by(self) -> None:
        """Undo what is to pass by now, robot time."""
        for entry in tuple(self._undoing):
            due_s, undo = entry
            if self._box.time_s >= due_s:
                self._undoing.remove(entry)
                undo()

    def pace(self) -> float:
        """Give how many times slower than it should the loop is to run now."""
        if self._slowness != 1.0 and time.monotonic() >= self._slow_until:
            self._slowness = 1.0
        return self._slowness

    def _protective_stop(self, _fault: Fault) -> None:
        self._box.protective_stop("a fault of the schedule")

    def _emergency_stop(self, fault: Fault) -> None:
        self._box.emergency_stop()
        self._undo_after(fault, self._box.release_emergency_stop)

    def _stall(self, fault: Fault) -> None:
        self.silence_s = fault.number("wall_s")

    def _slow(self, fault: Fault) -> None:
        self._slowness = fault.number("factor")
        self._slow_until = time.monotonic() + (fault.number("wall_s") or float("inf"))

    def _refuse_remote(self, fault: Fault) -> None:
        self._box.in_remote_control = False
        self._undo_after(fault, self._give_remote)

    def _give_remote(self) -> None:
        self._box.in_remote_control = True

    def _occupy(self, fault: Fault) -> None:
        self._rtde.occupy(fault.word("range"))
        self._undo_after(fault, self._rtde.vacate)

    def _garbage(self, fault: Fault) -> None:
        # Noise for a test, not a secret.
        noise = random.Random(fault.seed).randbytes(int(fault.number("bytes")))  # noqa: S311
        port = self._rtde if fault.word("port") == "rtde" else self._dashboard
        port.send_to_all(noise)

    def _die(self, _fault: Fault) -> None:
        self.dying = True

    def _undo_after(self, fault: Fault, undo: Callable[[], None]) -> None:
        after_s = fault.number("release_after_s")
        if after_s > 0:
            self._undoing.append((self._box.time_s + after_s, undo))


class FaultSchedule:
    """Waits for the moment of each fault.

    Args:
        faults: What is to happen, each once; counted from now.
        box: The control box whose time, travel and moves count.
        act: Lets a fault happen.
    """

    def __init__(
        self, faults: tuple[Fault, ...], box: ControlBox, act: Callable[[Fault], None]
    ) -> None:
        self._box = box
        self._act = act
        self._pending = list(faults)
        self._from_s = box.time_s
        self._from_rad = box.journal.travel_rad
        self._from_move = box.arm.moves
        self._move_began_rad: dict[int, float] = {}

    @property
    def pending(self) -> int:
        """How many faults are still to come."""
        return len(self._pending)

    def step(self) -> None:
        """Let happen what is due, once a cycle."""
        if not self._pending:
            return
        moves = self._box.arm.moves - self._from_move
        if moves not in self._move_began_rad:
            self._move_began_rad[moves] = self._box.journal.travel_rad
        for fault in tuple(self._pending):
            if self._is_due(fault, moves):
                self._pending.remove(fault)
                self._act(fault)

    def _is_due(self, fault: Fault, moves: int) -> bool:
        if fault.time_s is not None:
            return self._box.time_s - self._from_s >= fault.time_s
        travelled = self._box.journal.travel_rad
        if fault.move is None:
            assert fault.travel_rad is not None
            return travelled - self._from_rad >= fault.travel_rad
        if moves < fault.move:
            return False
        began = self._move_began_rad.get(fault.move, self._from_rad)
        return travelled - began >= (fault.travel_rad or 0.0)
