"""The URScript functions that move the arm or ask where it is.

Functions that take time are generators: each `yield` is one control cycle. A function that is
killed lets go of the arm, which then brakes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Mapping
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from runtime.controller import script_values
from runtime.controller.motions import JointMove, JointServo, JointSpeed, Motion
from runtime.controller.script_values import ScriptPose, ScriptValue, finite
from runtime.controller.tokens import ScriptError
from runtime.controller.tool_motions import LinearMove, Tool, ToolSpeed
from runtime.kinematics import Joints, Pose, forward, matrix_to_pose, pose_to_matrix

if TYPE_CHECKING:
    from runtime.controller.control_box import ControlBox

_Waiting: TypeAlias = Generator[None, None, None]

_STILL: Final = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def motion_functions(box: ControlBox) -> Mapping[str, Callable[..., Any]]:
    """Give the functions about motion, by name."""
    moves, questions = _Moves(box), _Questions(box)
    return {
        "movej": moves.movej,
        "movel": moves.movel,
        "movep": moves.movel,
        "stopj": moves.stopj,
        "stopl": moves.stopl,
        "speedj": moves.speedj,
        "speedl": moves.speedl,
        "servoj": moves.servoj,
        "sleep": moves.sleep,
        "sync": moves.sync,
        "is_steady": lambda: box.arm.is_steady,
        "get_inverse_kin": questions.get_inverse_kin,
        "get_inverse_kin_has_solution": questions.get_inverse_kin_has_solution,
        "get_forward_kin": questions.get_forward_kin,
        "is_within_safety_limits": questions.is_within_safety_limits,
        "get_actual_joint_positions": lambda: list(box.arm.joints),
        "get_target_joint_positions": lambda: list(box.arm.joints),
        "get_actual_joint_speeds": lambda: list(box.arm.state.qd.tolist()),
        "get_actual_joint_positions_history": questions.get_actual_joint_positions_history,
        "get_actual_tcp_pose": lambda: ScriptPose(box.arm.tcp_pose),
        "get_target_tcp_pose": lambda: ScriptPose(box.arm.tcp_pose),
        "get_actual_tcp_speed": lambda: list(box.arm.tcp_speed),
        "get_target_tcp_speed": lambda: list(box.arm.tcp_speed),
        "get_actual_tool_flange_pose": lambda: ScriptPose(
            matrix_to_pose(forward(box.arm.model, box.arm.joints))
        ),
    }


class _Moves:
    """What takes the arm somewhere."""

    def __init__(self, box: ControlBox) -> None:
        self._box = box
        self._arm = box.arm

    def movej(
        self,
        q: ScriptValue,
        a: ScriptValue = 1.4,
        v: ScriptValue = 1.05,
        t: ScriptValue = 0,
        r: ScriptValue = 0,
    ) -> _Waiting:
        target = self._joints(q)
        finite(r, "the blend radius")  # accepted, not imitated: every way-point is a stop
        yield from self._follow(
            JointMove(target, _positive(a, "acceleration"), _positive(v, "speed"), _duration(t))
        )

    def movel(
        self,
        pose: ScriptValue,
        a: ScriptValue = 1.2,
        v: ScriptValue = 0.25,
        t: ScriptValue = 0,
        r: ScriptValue = 0,
    ) -> _Waiting:
        tool = self._arm.tool
        finite(r, "the blend radius")
        if isinstance(pose, ScriptPose):
            target = script_values.pose(pose)
        else:
            target = matrix_to_pose(tool.pose(np.array(script_values.joints(pose))))
        yield from self._follow(
            LinearMove(
                tool, target, _positive(a, "acceleration"), _positive(v, "speed"), _duration(t)
            )
        )

    def stopj(self, a: ScriptValue = 2.0) -> _Waiting:
        yield from self._follow(JointSpeed(_STILL, _positive(a, "deceleration")))

    def stopl(self, a: ScriptValue = 1.0, aRot: ScriptValue = None) -> _Waiting:  # noqa: N803
        linear = _positive(a, "deceleration")
        turning = linear if aRot is None else _positive(aRot, "angular deceleration")
        yield from self._follow(ToolSpeed(self._arm.tool, _STILL, linear, turning))

    def speedj(self, qd: ScriptValue, a: ScriptValue = 1.4, t: ScriptValue = None) -> _Waiting:
        motion = JointSpeed(
            script_values.joints(qd, "the joint speeds"), _positive(a, "acceleration")
        )
        yield from self._hold(motion, t)

    def speedl(
        self,
        xd: ScriptValue,
        a: ScriptValue = 1.2,
        t: ScriptValue = None,
        aRot: ScriptValue = None,  # noqa: N803 - the name URScript gives it
    ) -> _Waiting:
        linear = _positive(a, "acceleration")
        turning = linear if aRot is None else _positive(aRot, "angular acceleration")
        speed = script_values.joints(xd, "the tool speed")
        yield from self._hold(ToolSpeed(self._arm.tool, speed, linear, turning), t)

    def servoj(
        self,
        q: ScriptValue,
        a: ScriptValue = 0,
        v: ScriptValue = 0,
        t: ScriptValue = 0.002,
        lookahead_time: ScriptValue = 0.1,
        gain: ScriptValue = 300,
    ) -> _Waiting:
        for unused in (a, v, gain):
            finite(unused, "an argument of servoj")
        motion = JointServo(self._joints(q), _positive(lookahead_time, "look-ahead time"))
        yield from self._hold(motion, t)

    def sleep(self, t: ScriptValue) -> _Waiting:
        yield from self._cycles(finite(t, "the time"))

    def sync(self) -> _Waiting:
        yield

    def _joints(self, value: ScriptValue) -> Joints:
        if isinstance(value, ScriptPose):
            return _solve(self._arm.tool, script_values.pose(value), self._arm.joints)
        return script_values.joints(value)

    def _follow(self, motion: Motion) -> _Waiting:
        self._arm.command(motion, self._box.thread)
        try:
            while not motion.done:
                yield
        finally:
            self._arm.release(motion)

    def _hold(self, motion: Motion, t: ScriptValue) -> _Waiting:
        """Follow for a time, or, without one, until the motion has reached its speed."""
        if t is None:
            yield from self._follow(motion)
            return
        self._arm.command(motion, self._box.thread)
        try:
            yield from self._cycles(finite(t, "the time"))
        finally:
            self._arm.release(motion)

    def _cycles(self, seconds: float) -> _Waiting:
        left = max(1, math.ceil(seconds / self._box.cycle_s - 1e-9))
        while left > 0:
            left -= 1
            yield


class _Questions:
    """What is asked of the arm's geometry."""

    def __init__(self, box: ControlBox) -> None:
        self._arm = box.arm

    def get_inverse_kin(
        self,
        x: ScriptValue,
        qnear: ScriptValue = None,
        maxPositionError: ScriptValue = 1e-10,  # noqa: N803 - the names URScript gives them
        maxOrientationError: ScriptValue = 1e-10,  # noqa: N803
        tcp: ScriptValue = None,
    ) -> list[float]:
        # The closed form is exact: the permitted errors are checked, not needed.
        finite(maxPositionError, "the position error")
        finite(maxOrientationError, "the orientation error")
        near = self._arm.joints if qnear is None else script_values.joints(qnear, "qnear")
        return list(_solve(self._tool(tcp), script_values.pose(x), near))

    def get_inverse_kin_has_solution(self, *arguments: ScriptValue) -> bool:
        try:
            self.get_inverse_kin(*arguments)
        except _UnreachableError:
            return False
        return True

    def get_forward_kin(self, q: ScriptValue = None, tcp: ScriptValue = None) -> ScriptPose:
        joints = self._arm.joints if q is None else script_values.joints(q)
        return ScriptPose(matrix_to_pose(self._tool(tcp).pose(np.array(joints))))

    def is_within_safety_limits(self, target: ScriptValue) -> bool:
        if not isinstance(target, ScriptPose):
            return self._arm.is_within_limits(script_values.joints(target))
        tool, near = self._arm.tool, np.array(self._arm.joints)
        return tool.reach(pose_to_matrix(script_values.pose(target)), near) is not None

    def get_actual_joint_positions_history(self, steps: ScriptValue = 0) -> list[float]:
        return list(self._arm.joints_before(int(finite(steps, "the number of steps"))))

    def _tool(self, tcp: ScriptValue) -> Tool:
        return self._arm.tool if tcp is None else Tool(self._arm.model, script_values.pose(tcp))


class _UnreachableError(ScriptError):
    pass


def _solve(tool: Tool, target: Pose, near: Joints) -> Joints:
    found = tool.reach(pose_to_matrix(target), np.array(near))
    if found is None:
        raise _UnreachableError(
            f"the pose p{[round(element, 4) for element in target]} is out of reach"
        )
    return found


def _positive(value: ScriptValue, what: str) -> float:
    given = finite(value, f"the {what}")
    if given <= 0:
        raise ScriptError(f"the {what} is {given:g}, but must be greater than 0")
    return given


def _duration(value: ScriptValue) -> float:
    return max(0.0, finite(value, "the time"))
