"""The connection to a UR controller through the ur-rtde client, and what must be true of it.

Lives in the worker process only. The client's return values are not believed: after faults it has
been seen to report moves as done that were never made. What the controller's own state stream
says counts.
"""

from __future__ import annotations

import contextlib
import math
import re
import time
from typing import Any, Final

import numpy as np
from dashboard_client import DashboardClient
from rtde_control import RTDEControlInterface
from rtde_io import RTDEIOInterface
from rtde_receive import RTDEReceiveInterface

from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.limits import tcp_matrix
from runtime.drivers.steps import MoveJoints, MoveLinear
from runtime.drivers.ur_link import Silence
from runtime.errors import ControllerError
from runtime.kinematics import Joints, Pose, pose_to_matrix

SUPPORTED: Final = "3.9 to 3.15 and 5.6 or newer"

_TOOL_BIT: Final = 16  # of the digital inputs and outputs, the first on the tool connector
_PLAYING: Final = 2  # runtime_state
_SAFE: Final = (1, 2)  # safety_mode: normal, reduced
_SAFETY: Final = {
    3: "a protective stop: find its cause, wait 5 s, unlock it on the teach pendant",
    4: "recovery mode: move the arm back within its limits on the teach pendant",
    5: "a safeguard stop: clear the safeguarded space and reset the safeguard",
    6: "an emergency stop: clear the danger, release the button, power the arm on again",
    7: "an emergency stop: clear the danger, release the button, power the arm on again",
    8: "a safety violation: restart the safety system on the teach pendant",
    9: "a safety fault: restart the safety system on the teach pendant",
}
_AFTERWARDS: Final = ", then start this program again; it recovers nothing by itself"
_STILL_RAD_S: Final = 0.005
_KICK_EVERY_S: Final = 0.02
_LONGEST_BLINK_S: Final = 0.02  # looks are 4 ms apart, unless this process was kept waiting
_MODEL_WITHIN_M: Final = 0.02  # factory calibration moves a real arm by a few millimetres
_TCP_WITHIN_S: Final = 2.0


class UrConnection:
    """An open connection to one controller, ready to move its arm.

    Raises:
        ControllerError: It cannot be had; the text says what to do.
    """

    def __init__(self, address: str, config: RobotConfig) -> None:
        self._address: Final = address
        self._config: Final = config
        self.version: Final = _check_dashboard(address, config)
        self._receive: Any = _construct(RTDEReceiveInterface, address, "state stream")
        if not self._receive.isConnected():
            raise ControllerError(f"{address}: the controller sends no state stream (RTDE)")
        if unsafe := self._safety():
            raise ControllerError(f"{address}: {unsafe}")
        began = (self._receive.getTimestamp(), time.monotonic())
        self._io: Any = _construct(RTDEIOInterface, address, "digital outputs")
        self._control: Any = _construct(RTDEControlInterface, address, "control program")
        robot_s, wall_s = (
            now - then
            for now, then in zip(
                (self._receive.getTimestamp(), time.monotonic()), began, strict=True
            )
        )
        self._control.setTcp(list(config.tcp))
        self.set_payload(config.payload.gripper_kg)
        # A stand-in may run faster than real time; the watchdog is meant in real time.
        pace = max(1, round(robot_s / wall_s))
        self._control.setWatchdog(config.watch.watchdog_hz / pace)
        self._kicked_at = time.monotonic()
        self._silence = Silence(_LONGEST_BLINK_S)
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
        silent_s = self._silence.since(self.timestamp_s(), time.monotonic())
        where = f"the controller at {self._address}"
        if not (self._receive.isConnected() and self._control.isConnected()):
            return (
                f"the connection to {where} was lost; see that it is on and reachable{_AFTERWARDS}"
            )
        if unsafe := self._safety():
            return unsafe
        if silent_s > self._config.watch.silence_s:
            return (
                f"{where} has sent no new state for {silent_s:.2f} s; "
                f"see that it is on and reachable{_AFTERWARDS}"
            )
        if self._receive.getRuntimeState() != _PLAYING:
            return (
                f"the control program on {where} was stopped; see that nobody else uses the arm"
                f"{_AFTERWARDS}"
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
            self._control.moveL(pose, speeds.tool, speeds.tool_acceleration, asynchronous=True)
        return before

    def operation(self) -> tuple[int, bool]:
        """Give the number of the newest move, and whether it is under way."""
        status = self._control.getAsyncOperationProgressEx()
        return int(status.operationId()), bool(status.isAsyncOperationRunning())

    def stop(self) -> None:
        """Bring the arm to a standstill."""
        self._control.stopJ(self._config.speeds.stop_deceleration)

    def set_gripper(self, *, close: bool) -> None:
        """Switch the gripper's output."""
        self._io.setToolDigitalOut(self._config.gripper.output, close)

    def set_payload(self, mass_kg: float) -> None:
        """Tell the controller what hangs on the flange."""
        self._control.setPayload(mass_kg, list(self._config.payload.centre_of_gravity_m))

    def end_program(self) -> None:
        """End the program on the controller, so that nothing can resume it."""
        self._control.stopScript()

    def _safety(self) -> str:
        mode = self._receive.getSafetyMode()
        if mode in _SAFE:
            return ""
        what = _SAFETY.get(mode, f"safety mode {mode}: see the teach pendant")
        return f"the arm is in {what}{_AFTERWARDS}"

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
                    f"{self._address}: the tool is {off:.3f} m from where a {self._config.model} "
                    "would have it; is this the arm that the configuration describes?"
                )
            self.kick()
            time.sleep(0.005)


def end_program_by_dashboard(address: str) -> None:
    """End the program on the controller without the client's control connection, if it listens.

    After a protective stop a program is only paused: "play" on the pendant would go on with the
    interrupted move.
    """
    with contextlib.suppress(RuntimeError):
        dashboard = DashboardClient(address)
        dashboard.connect(500)
        dashboard.stop()


def pose_error(pose: Pose, target: Pose) -> tuple[float, float]:
    """Give distance (m) and angle (rad) between two poses; rotation vectors are not unique."""
    a, b = pose_to_matrix(pose), pose_to_matrix(target)
    cosine = (float(np.trace(a[:3, :3].T @ b[:3, :3])) - 1) / 2
    return math.dist(pose[:3], target[:3]), math.acos(max(-1.0, min(1.0, cosine)))


def check_version(text: str) -> tuple[int, int]:
    """Refuse controllers on which the client is known to hang or crash.

    Args:
        text: What the dashboard answers to `PolyscopeVersion`.

    Returns:
        Major and minor version.

    Raises:
        ControllerError: Names the version and those that are supported.
    """
    match = re.search(r"(\d+)\.(\d+)", text)
    if match is None:
        raise ControllerError(f"the controller does not tell its version (it says {text!r})")
    major, minor = int(match[1]), int(match[2])
    if not ((major == 3 and 9 <= minor <= 15) or (major == 5 and minor >= 6)):
        raise ControllerError(
            f"PolyScope {major}.{minor} is not supported (supported: {SUPPORTED}); "
            "update the controller"
        )
    return major, minor


def _check_dashboard(address: str, config: RobotConfig) -> str:
    """Ask version, model and power before the client is let near the controller."""
    dashboard = DashboardClient(address)
    try:
        dashboard.connect(2000)
        version = dashboard.polyscopeVersion()
        mode = dashboard.robotmode()
    except RuntimeError as error:
        raise ControllerError(
            f"{address}: no answer from a UR controller's dashboard (port 29999): {error}. "
            "See that address and network are right and the controller is on"
        ) from None
    check_version(version)
    if "RUNNING" not in mode.upper():
        raise ControllerError(
            f"{address}: the arm is not running ({mode}); power it on and release its brakes"
        )
    with contextlib.suppress(RuntimeError):  # older controllers do not tell their model
        model = dashboard.getRobotModel().strip().lower()
        if model.startswith("ur") and model.rstrip("e") != config.model.rstrip("e"):
            raise ControllerError(
                f"{address}: this is a {model.upper()}, the configuration is for a {config.model}"
            )
    dashboard.disconnect()
    return str(version)


def _construct(interface: Any, address: str, what: str) -> Any:
    try:
        return interface(address)
    except RuntimeError as error:
        raise ControllerError(f"{address}: cannot open the {what}: {error}") from None
