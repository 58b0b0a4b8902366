"""The connection to a UR controller through the ur-rtde client, and what must be true of it.

Lives in the worker process only. The client's return values are not believed: after faults it has
been seen to report moves as done that were never made. What the controller's own state stream
says counts.
"""

from __future__ import annotations

import math
import time
from typing import Any, Final

import numpy as np
from rtde_control import RTDEControlInterface
from rtde_io import RTDEIOInterface
from rtde_receive import RTDEReceiveInterface

from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.force import Push
from runtime.drivers.limits import tcp_matrix
from runtime.drivers.steps import MoveJoints, MoveLinear, line_speed
from runtime.drivers.ur_dashboard import check_controller
from runtime.drivers.ur_link import Lull, Silence
from runtime.drivers.ur_safety import ONLY_ON_YOUR_WORD, stop_in_words
from runtime.errors import ControllerError
from runtime.kinematics import Joints, Pose, pose_to_matrix

_TOOL_BIT: Final = 16  # of the digital inputs and outputs, the first on the tool connector
_PLAYING: Final = 2  # runtime_state
_STILL_RAD_S: Final = 0.005
_KICK_EVERY_S: Final = 0.02
_LONGEST_BLINK_S: Final = 0.02  # looks are 4 ms apart, unless this process was kept waiting
_WATCHDOG_SHARE: Final = 0.8  # the last sign may have been under way when the lull began
_MODEL_WITHIN_M: Final = 0.02  # factory calibration moves a real arm by a few millimetres
_TCP_WITHIN_S: Final = 2.0
_PROGRAM_WITHIN_S: Final = 2.0
_FORCE_FRAME_AS_GIVEN: Final = 2  # of force mode's types, the one that does not turn the frame

_LET_GO_WITHIN_S: Final = 3.0
_ASK_AGAIN_S: Final = 0.2

_OCCUPIED: Final = "already in use"
_REFUSALS: Final = {
    _OCCUPIED: (
        "another program or a fieldbus (EtherNet/IP, PROFINET, MODBUS) holds the controller's RTDE "
        "registers; end that program, or disable the fieldbus on the teach pendant"
    ),
    "remote control": (
        "switch the controller to remote control on the teach pendant (the icon at the upper right)"
    ),
    "control script": (
        "the controller did not start the control program; see its log on the teach pendant"
    ),
}
"""What the client says when it is refused, and what is to be done."""


class UrConnection:
    """An open connection to one controller, ready to move its arm.

    Raises:
        ControllerError: It cannot be had; the text says what to do.
    """

    def __init__(self, address: str, config: RobotConfig) -> None:
        self._address: Final = address
        self._config: Final = config
        self.version: Final = check_controller(address, config)
        self._receive: Any = _construct(RTDEReceiveInterface, address, "state stream")
        if not self._receive.isConnected():
            raise ControllerError(f"{address}: the controller sends no state stream (RTDE)")
        if unsafe := self._safety():
            raise ControllerError(f"{address}: {unsafe}")
        self._pushing = False
        self._io: Any = _construct(RTDEIOInterface, address, "digital outputs")
        self._control: Any = _construct(RTDEControlInterface, address, "control program")
        self._await_program()
        self._control.setTcp(list(config.tcp))
        self.set_payload(config.payload.gripper_kg)
        self._control.setWatchdog(config.watch.watchdog_hz)
        self._kicked_at = time.monotonic()
        self._silence = Silence(_LONGEST_BLINK_S)
        self._lull = Lull(_WATCHDOG_SHARE / config.watch.watchdog_hz)
        self._await_tool()

    def state(self) -> ArmState:
        """Give the measured state."""
        bits, gripper = 1 << _TOOL_BIT, self._config.gripper
        return ArmState(
            self.joints(),
            self.tcp_pose(),
            bool(self._receive.getActualDigitalOutputBits() & bits << gripper.output),
            bool(self._receive.getActualDigitalInputBits() & bits << gripper.input),
            self.timestamp_s(),
            self.wrench()[2],
        )

    def joints(self) -> Joints:
        """Give the measured joint angles, rad."""
        a, b, c, d, e, f = self._receive.getActualQ()
        return a, b, c, d, e, f

    def tcp_pose(self) -> Pose:
        """Give the measured tool centre point, m and rad."""
        x, y, z, rx, ry, rz = self._receive.getActualTCPPose()
        return x, y, z, rx, ry, rz

    def timestamp_s(self) -> float:
        """Give the controller's clock, s."""
        return float(self._receive.getTimestamp())

    def stands_still(self) -> bool:
        """Tell whether no joint turns."""
        return bool(max(map(abs, self._receive.getActualQd())) < _STILL_RAD_S)

    def trouble(self) -> str:
        """Say why the arm cannot be driven (any more); empty while it can."""
        news, now = self.timestamp_s(), time.monotonic()
        silent_s = self._silence.since(news, now)
        self._lull.note(news, now)
        where = f"the controller at {self._address}"
        if not (self._receive.isConnected() and self._control.isConnected()):
            return (
                f"the connection to {where} was lost; see that it is on and reachable"
                f"{ONLY_ON_YOUR_WORD}"
            )
        if unsafe := self._safety():
            return unsafe
        if silent_s > self._config.watch.silence_s:
            return (
                f"{where} has sent no new state for {silent_s:.2f} s; "
                f"see that it is on and reachable{ONLY_ON_YOUR_WORD}"
            )
        if self._receive.getRuntimeState() != _PLAYING:
            if lull_s := self._lull.lately(now):
                return (
                    f"nothing passed between this program and {where} for {lull_s:.2f} s, and the "
                    "controller's watchdog ended the control program; see that the controller is "
                    f"on and reachable, and that this machine is not overloaded{ONLY_ON_YOUR_WORD}"
                )
            return (
                f"the control program on {where} was stopped; see that nobody else uses the arm"
                f"{ONLY_ON_YOUR_WORD}"
            )
        return ""

    def speed_fraction(self) -> float:
        """Give the place of the speed slider on the teach pendant, 0.01 to 1."""
        return min(1.0, max(0.01, float(self._receive.getTargetSpeedFraction())))

    def kick(self) -> None:
        """Tell the controller's watchdog that this process is alive, when it is due."""
        now = time.monotonic()
        if now - self._kicked_at >= _KICK_EVERY_S:
            self._kicked_at = now
            self._control.kickWatchdog()

    def move(self, step: MoveJoints | MoveLinear) -> int:
        """Begin a move; give the operation number that it replaces."""
        before = self.operation()[0]
        speeds = self._config.speeds
        if isinstance(step, MoveJoints):
            joints = [float(q) for q in step.joints]
            self._control.moveJ(joints, speeds.joint, speeds.joint_acceleration, asynchronous=True)
        else:
            pose = [float(v) for v in step.pose]
            speed = line_speed(step, self._config)
            self._control.moveL(pose, speed, speeds.tool_acceleration, asynchronous=True)
        return before

    def operation(self) -> tuple[int, bool]:
        """Give the number of the newest move, and whether it is under way."""
        status = self._control.getAsyncOperationProgressEx()
        return int(status.operationId()), bool(status.isAsyncOperationRunning())

    def stop(self) -> None:
        """Bring the arm to a standstill."""
        if self._pushing:
            self.end_push()
        else:
            self._control.stopJ(self._config.speeds.stop_deceleration)

    def wrench(self) -> Pose:
        """Give the measured force and torque on the tool, N and Nm, base frame."""
        fx, fy, fz, mx, my, mz = self._receive.getActualTCPForce()
        return fx, fy, fz, mx, my, mz

    def zero_force(self) -> None:
        """Ask the controller to take the force it measures now for none."""
        self._control.zeroFtSensor()

    def push(self, push: Push, frame: Pose) -> None:
        """Order force mode, or order it anew; it goes on until `end_push` or `stop`.

        Args:
            push: Where to yield, with what force and how fast.
            frame: Its axes, in the base frame.
        """
        self._pushing = True
        self._control.forceMode(
            list(frame),
            [int(axis) for axis in push.compliant],
            [float(force) for force in push.wrench],
            _FORCE_FRAME_AS_GIVEN,
            [float(speed) for speed in push.speeds],
        )
        self._kicked_at = time.monotonic()

    def end_push(self) -> None:
        """End force mode and brake."""
        self._pushing = False
        self._control.forceModeStop()

    def set_gripper(self, *, close: bool) -> None:
        """Switch the gripper's output."""
        self._io.setToolDigitalOut(self._config.gripper.output, close)

    def set_payload(
        self, mass_kg: float, centre_of_gravity_m: tuple[float, float, float] | None = None
    ) -> None:
        """Tell the controller what hangs on the flange.

        Args:
            mass_kg: All of it.
            centre_of_gravity_m: From the flange; None is that of the gripper.
        """
        centre = centre_of_gravity_m or self._config.payload.centre_of_gravity_m
        self._control.setPayload(mass_kg, [float(v) for v in centre])

    def end_program(self) -> None:
        """End the program on the controller, so that nothing can resume it."""
        self._control.stopScript()

    def _safety(self) -> str:
        words = stop_in_words(self._receive.getSafetyMode())
        return f"the arm is in {words}{ONLY_ON_YOUR_WORD}" if words else ""

    def _await_program(self) -> None:
        """See that the uploaded program runs. The state stream may be a few states behind."""
        deadline = time.monotonic() + _PROGRAM_WITHIN_S
        while self._receive.getRuntimeState() != _PLAYING:
            if time.monotonic() > deadline:
                raise ControllerError(
                    f"{self._address}: the control program was uploaded but does not run; see the "
                    "controller's log on the teach pendant"
                )
            time.sleep(0.005)

    def _await_tool(self) -> None:
        """Check that the arm out there is the one configured: joints and tool must agree."""
        deadline = time.monotonic() + _TCP_WITHIN_S
        while True:
            expected = tcp_matrix(self._config, self.joints())
            off = float(np.linalg.norm(expected[:3, 3] - self.tcp_pose()[:3]))
            if off <= _MODEL_WITHIN_M:
                return
            if time.monotonic() > deadline:
                raise ControllerError(
                    f"{self._address}: model: the tool is {off:.3f} m from where a "
                    f"{self._config.model} would have it; is this the arm that the configuration "
                    "describes?"
                )
            self.kick()
            time.sleep(0.005)


def pose_error(pose: Pose, target: Pose) -> tuple[float, float]:
    """Give distance (m) and angle (rad) between two poses; rotation vectors are not unique."""
    a, b = pose_to_matrix(pose), pose_to_matrix(target)
    cosine = (float(np.trace(a[:3, :3].T @ b[:3, :3])) - 1) / 2
    return math.dist(pose[:3], target[:3]), math.acos(max(-1.0, min(1.0, cosine)))


def _construct(interface: Any, address: str, what: str) -> Any:
    """Open one of the client's connections.

    A program that has just been killed holds the registers for another moment: its successor waits.
    """
    deadline = time.monotonic() + _LET_GO_WITHIN_S
    while True:
        try:
            return interface(address)
        except RuntimeError as error:
            said = str(error)
            if _OCCUPIED in said.lower() and time.monotonic() < deadline:
                time.sleep(_ASK_AGAIN_S)
                continue
            to_do = next((words for sign, words in _REFUSALS.items() if sign in said.lower()), said)
            raise ControllerError(f"{address}: cannot open the {what}: {to_do}") from None
