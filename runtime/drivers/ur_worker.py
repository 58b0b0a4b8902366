"""The process that holds the connection to a UR arm: it moves, watches, and stops.

A process of its own because the client blocks for minutes when a controller dies, cannot be
interrupted, must be used from one thread, writes its messages to the standard streams, and after
a lost link goes on connecting for ever: all that is cured by ending the process. If this process
dies, the controller's watchdog stops the arm.
"""

from __future__ import annotations

import math
import os
import signal
import time
from collections.abc import Callable
from multiprocessing.connection import Connection

from runtime.config import RobotConfig
from runtime.drivers.force import ForceMotion
from runtime.drivers.limits import joint_distance
from runtime.drivers.pressing import Pressing
from runtime.drivers.steps import (
    ArmStep,
    Felt,
    Grip,
    MoveJoints,
    MoveLinear,
    Press,
    Tare,
    Turn,
    duration_s,
    grip_failure,
)
from runtime.drivers.turning import Turning
from runtime.drivers.ur_connection import UrConnection, pose_error
from runtime.drivers.ur_dashboard import end_program, release
from runtime.drivers.ur_force import ForceSensor, Guard, carry_out
from runtime.drivers.ur_link import Begin, Close, Ended, Lost, Order, Ready, StateBoard, Stop
from runtime.errors import ControllerError, DriverError

_PERIOD_S = 0.004
_OUTPUT_WITHIN_S = 1.0
_STANDSTILL_WITHIN_S = 1.5
_ANGLE_TOLERANCE_RAD = 0.01
_BEGIN_WITHIN_S = 1.0  # of this machine's time, in which an order passes through the client
_NEWS_WITHIN_S = 0.5  # likewise, in which the end of a move does: clock and end come separately


class _CalledOffError(Exception):
    """Another order has come in while a step was being carried out."""


def work(
    orders: Connection,
    said: Connection,
    board: StateBoard,
    address: str,
    config: RobotConfig,
    recover: bool,  # noqa: FBT001 - goes through the start of a process
) -> None:
    """Connect, then carry orders out until told to close, or until the arm is lost.

    Args:
        orders: Orders come in here, reports go out.
        said: Whatever the client writes to the standard streams goes here.
        board: States are published here.
        address: The controller.
        config: The robot.
        recover: The operator has given the word: release a protective stop first.
    """
    # The driver decides what Ctrl-C means; this process must live to stop the arm.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for stream in (1, 2):
        os.dup2(said.fileno(), stream)
    # Better to lose a message than to wait for its reader while the arm moves.
    os.set_blocking(said.fileno(), False)
    status = 0
    try:
        done = release(address) if recover else ""
        worker = _Worker(UrConnection(address, config), orders, board, config)
        try:
            worker.run(done)
        except DriverError as error:
            orders.send(Lost(str(error)))
            status = 1
            end_program(address)
    except ControllerError as error:
        orders.send(Lost(str(error)))
        status = 1
    except OSError:
        status = 1  # the driver is gone, nobody is left to report to
    # Not the ordinary way out: the client's destructors may wait for ever.
    os._exit(status)


class _Worker:
    """Carries out one order at a time, watching the arm all the while."""

    def __init__(
        self, connection: UrConnection, orders: Connection, board: StateBoard, config: RobotConfig
    ) -> None:
        self._arm = connection
        self._orders = orders
        self._board = board
        self._config = config
        self._sensor = ForceSensor(connection)

    def run(self, done: str = "") -> None:
        self._watch()
        self._orders.send(Ready(self._arm.version, done))
        while True:
            match self._next_order():
                case Begin() as order:
                    try:
                        reason, felt = self._carry_out(order.step)
                    except _CalledOffError:
                        continue
                    # The state must be out before the report that relies on it.
                    self._watch()
                    self._orders.send(Ended(order.number, reason, felt))
                case Stop():
                    self._stop()
                case Close():
                    self._stop()
                    self._arm.end_program()
                    return

    def _next_order(self) -> Order:
        while not self._orders.poll(_PERIOD_S):
            self._watch()
        try:
            order: Order = self._orders.recv()
        except (EOFError, ConnectionError):
            return Close()  # the driver's process has ended
        return order

    def _watch(self, *, moving: bool = False) -> None:
        """Publish the state, keep the watchdog quiet, and give up if the arm is lost."""
        self._board.write(self._arm.state(), moving=moving or not self._arm.stands_still())
        trouble = self._arm.trouble()
        if trouble:
            raise DriverError(trouble)
        self._arm.kick()

    def _wait(self) -> None:
        """Let one period pass within a step; calls the step off when an order has come in."""
        if self._orders.poll(_PERIOD_S):
            raise _CalledOffError
        self._watch(moving=True)

    def _stop(self) -> None:
        if not self._arm.stands_still():
            self._halt()

    def _halt(self) -> None:
        self._arm.stop()
        self._settle()

    def _settle(self) -> None:
        """Wait for the standstill."""
        deadline = time.monotonic() + _STANDSTILL_WITHIN_S
        while not self._arm.stands_still():
            self._watch(moving=True)
            if time.monotonic() > deadline:
                raise DriverError("the arm does not come to a standstill; use the emergency stop")
            time.sleep(_PERIOD_S)

    def _carry_out(self, step: ArmStep) -> tuple[str, Felt | None]:
        """Carry a step out; give the reason if it failed, and what a step by force has felt."""
        if self._orders.poll(0):
            raise _CalledOffError
        match step:
            case Grip():
                return self._grip(step), None
            case Tare():
                return self._sensor.zero(self._wait), None
            case Press():
                reason = self._off_start(step)
                return (reason, None) if reason else self._by_force(Pressing, step)
            case Turn():
                return self._by_force(Turning, step)
            case _:
                return self._off_start(step) or self._go(step), None

    def _off_start(self, step: MoveJoints | MoveLinear | Press) -> str:
        off = joint_distance(step.start, self._arm.joints())
        if off <= self._config.watch.start_tolerance_rad:
            return ""
        return (
            f"the arm stands {off:.3f} rad from where the motion was planned to start "
            f"(at most {self._config.watch.start_tolerance_rad:g})"
        )

    def _by_force(
        self, controller: Callable[..., ForceMotion], step: Press | Turn
    ) -> tuple[str, Felt | None]:
        """Carry a step by force out, and let the arm come to rest."""
        motion = controller(step, self._config, 1 / self._arm.speed_fraction())
        finish = carry_out(motion, self._arm, self._sensor, self._wait)
        self._settle()
        return finish.reason, finish.felt

    def _go(self, step: MoveJoints | MoveLinear) -> str:
        """Move, unless the arm is there already; judge the end by what is measured."""
        if self._miss(step):
            try:
                reason = self._move(step)
            except _CalledOffError:
                self._halt()
                raise
            if reason:
                self._halt()
                return reason
        return self._miss(step)

    def _move(self, step: MoveJoints | MoveLinear) -> str:
        watch = self._config.watch
        # Whoever runs an arm for the first time turns the slider down.
        planned = duration_s(step, self._config) / self._arm.speed_fraction()
        # Counted on the controller's clock: it says how long the arm has moved.
        allowed = watch.deadline_factor * planned + watch.deadline_margin_s
        deadline = self._arm.timestamp_s() + allowed
        replaced = self._arm.move(step)
        begin_by = time.monotonic() + _BEGIN_WITHIN_S
        guard = Guard(self._sensor, self._config.force.most_n)
        guarded = isinstance(step, MoveLinear) and step.guarded
        begun, end_by = False, math.inf
        while True:
            self._wait()
            if guarded and (reason := guard.trips()):
                return reason
            number, running = self._arm.operation()
            # Right after the order the old operation's end still stands in the stream.
            if not begun and number != replaced:
                begun, deadline = True, self._arm.timestamp_s() + allowed
            if begun and not running and self._arm.stands_still():
                return ""
            if self._arm.timestamp_s() <= deadline:
                continue
            if begun:
                end_by = min(end_by, time.monotonic() + _NEWS_WITHIN_S)
                if time.monotonic() >= end_by:
                    return f"a move planned to take {planned:.2f} s was not finished in time"
            elif time.monotonic() > begin_by:
                return (
                    f"a move planned to take {planned:.2f} s was not begun by the controller in "
                    "time"
                )

    def _miss(self, step: MoveJoints | MoveLinear) -> str:
        """Say by how much the arm misses a step's target; empty if it is there."""
        watch = self._config.watch
        if isinstance(step, MoveJoints):
            off = joint_distance(step.joints, self._arm.joints())
            if off <= watch.joint_tolerance_rad:
                return ""
            return f"the arm ended {off:.3f} rad from its target"
        distance, angle = pose_error(self._arm.tcp_pose(), step.pose)
        if distance <= watch.position_tolerance_m and angle <= _ANGLE_TOLERANCE_RAD:
            return ""
        return (
            f"the tool ended {distance:.4f} m and {math.degrees(angle):.1f} degrees off its target"
        )

    def _grip(self, step: Grip) -> str:
        gripper = self._config.gripper
        self._arm.set_gripper(close=step.close)
        give_up = time.monotonic() + _OUTPUT_WITHIN_S
        while self._arm.state().gripper_closed != step.close:
            if time.monotonic() > give_up:
                return "the gripper's output does not switch; is the tool connector free for it?"
            self._wait()
        closed_at = self._arm.timestamp_s() + gripper.close_time_s
        while self._arm.timestamp_s() < closed_at:
            self._wait()
        give_up = time.monotonic() + gripper.sense_time_s
        while self._arm.state().gripped != step.expect_gripped:
            if time.monotonic() > give_up:
                return grip_failure(step)
            self._wait()
        self._arm.set_payload(step.payload_kg, step.centre_of_gravity_m)
        return ""
