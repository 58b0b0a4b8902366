"""Where the arm will be after the steps so far, and the moves all commands are made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from icarus_lite import Action
from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.limits import (
    MotionError,
    arm_solutions,
    check_joint_move,
    check_joints,
    check_place,
    joint_distance,
    linear_path,
    tcp_matrix,
)
from runtime.drivers.motions.places import Place, Places
from runtime.drivers.steps import Grip, MoveJoints, MoveLinear, Press, Progress, Step, Tare
from runtime.kinematics import Joints, Matrix, matrix_to_pose, pose_to_matrix
from runtime.parts import PartModel

_YAWS: Final = tuple(math.radians(turn) for turn in (0, 30, -30, 60, -60, 90, -90))
_BRANCHES: Final = 2  # of the inverse, nearest first, that are tried for each way to turn the tool
_STILL: Final = 1e-6  # rad and m below which a move is none
_START_SLACK: Final = 0.005  # m and rad by which a standing arm may have missed a limit


class Planner:
    """Adds steps, each checked, and follows the arm through them.

    Args:
        places: What stands where.
        state: Where the arm is and what it holds.
        config: The robot and its limits.

    Raises:
        MotionError: The arm stands outside its limits.
    """

    def __init__(self, places: Places, state: ArmState, config: RobotConfig) -> None:
        self.config: Final = config
        self.places: Final = places
        self.steps: list[Step] = []
        self.remaining: tuple[Action, ...] = ()
        self.progress = Progress()
        self.joints = state.joints
        self.tcp = pose_to_matrix(state.tcp_pose)
        self.closed = state.gripper_closed
        self.gripped = state.gripped
        self.hangs_m = 0.0
        look = tcp_matrix(config, config.look_joints)
        self._yaw = math.atan2(look[1, 0], look[0, 0])
        try:
            check_joints(config, state.joints, slack=_START_SLACK)
        except MotionError as error:
            raise MotionError(
                f"the arm stands outside its limits ({error}); move it back by hand"
            ) from None

    @property
    def height(self) -> float:
        """Height of the tool centre point, m."""
        return float(self.tcp[2, 3])

    @property
    def turned_rad(self) -> float:
        """How far the tool is turned about the vertical from how it is at the look pose."""
        return math.remainder(self._tool_yaw() - self._yaw, 2 * math.pi)

    def lift(self) -> None:
        """Go straight up to transit height, unless the tool is that high."""
        heights, box = self.config.heights, self.config.workspace
        transit = box.table_z_m + heights.transit_m
        if self.height < transit - self.config.watch.position_tolerance_m:
            self.shift(max(transit, self.height + heights.retreat_m), "go straight up")

    def shift(self, height: float, what: str, *, guarded: bool = False) -> None:
        """Go straight up or down to a height, m."""
        target = self.tcp.copy()
        target[2, 3] = height
        try:
            path = linear_path(self.config, self.joints, self.tcp, target)
        except MotionError as error:
            raise MotionError(f"cannot {what}: {error}") from None
        self._move_linear(target, path[-1], guarded=guarded)

    def rest(self) -> None:
        """Go to the look pose."""
        self.lift()
        self.turn_joints(self.config.look_joints, "go to the look pose")

    def turn_joints(self, target: Joints, what: str) -> None:
        """Go to joint angles, straight in joint space."""
        try:
            check_joint_move(self.config, self.joints, target, hangs_m=self.hangs_m)
        except MotionError as error:
            raise MotionError(f"cannot {what}: {error}") from None
        self._move_joints(target)

    def reach(
        self,
        target: Place | Callable[[float], Place],
        what: str,
        *,
        prefer: Callable[[Joints], Joints] = lambda joints: joints,
        above_m: float = 0.0,
        turnable: bool = True,
    ) -> tuple[Matrix, Joints]:
        """Go over a place and straight down to it; steps are added only if all is within.

        Args:
            target: The place, or what gives it for the angle by which the tool is turned about
                the vertical from how it is at the look pose.
            what: What this is for, as it stands in a refusal.
            prefer: Another way to hold the arm in the same pose, if there is one.
            above_m: How far above the place to stop; the rest of the way down is checked too.
            turnable: Whether the tool may be turned about the vertical if that helps.

        Returns:
            The tool centre point at the place itself, and the joint angles there.
        """
        place_at = target if callable(target) else _always(target)
        heights, box = self.config.heights, self.config.workspace
        x, y, z = place_at(0.0)
        refusal = MotionError(
            f"cannot {what}: ({x:.3f}, {y:.3f}, {z:.3f}) m is out of the arm's reach"
        )
        refused = False
        top = max(box.table_z_m + heights.transit_m, z + heights.approach_m)
        try:
            check_place(self.config, (x, y, z))
            check_place(self.config, (x, y, top))
        except MotionError as error:
            raise MotionError(f"cannot {what}: {error}") from None
        for turn in _YAWS if turnable else _YAWS[:1]:
            x, y, z = place_at(turn)
            yaw = self._yaw + turn
            over, stop, down = (
                _pointing_down(x, y, height, yaw) for height in (top, z + above_m, z)
            )
            for found in arm_solutions(self.config, over, self.joints)[:_BRANCHES]:
                joints = prefer(found)
                try:
                    check_joint_move(self.config, self.joints, joints, hangs_m=self.hangs_m)
                    path = linear_path(self.config, joints, over, stop)
                    rest = linear_path(self.config, path[-1], stop, down)
                except MotionError as error:
                    if not refused:  # the first is about the way the tool would best be turned
                        refusal, refused = MotionError(f"cannot {what}: {error}"), True
                    continue
                self._move_joints(joints)
                self.steps.append(Tare())
                self._move_linear(stop, path[-1], guarded=True)
                return down, rest[-1]
        raise refusal

    def press(
        self,
        target: Matrix,
        joints: Joints,
        *,
        press_n: float,
        tolerance_m: float,
        search_m: float = 0.0,
        spiral_m: float = 0.0,
    ) -> None:
        """Go down by force to a target straight below, (4, 4), and be there; see `Press`."""
        self.steps.append(
            Press(
                matrix_to_pose(target),
                joints,
                self.joints,
                math.dist(target[:3, 3].tolist(), self.tcp[:3, 3].tolist()),
                press_n,
                search_m,
                spiral_m,
                tolerance_m,
                self.remaining,
            )
        )
        self.joints, self.tcp = joints, target

    def grip(self, *, close: bool, part: PartModel | None = None, again: bool = False) -> None:
        """Close the gripper on a part, or open it, perhaps to take hold again."""
        payload, tcp = self.config.payload, self.config.tcp
        if part is None:
            self.steps.append(Grip(close, close, payload.gripper_kg, again=again))
        else:
            own, kg = payload.gripper_kg, payload.part(part.type)
            whole = own + kg
            # The part's weight is taken to hang between the fingertips.
            x, y, z = (
                (own * mine + kg * there) / whole if whole > 0 else mine
                for mine, there in zip(payload.centre_of_gravity_m, tcp[:3], strict=True)
            )
            self.steps.append(Grip(close, close, whole, (x, y, z)))
        self.closed = self.gripped = close

    def _move_joints(self, joints: Joints) -> None:
        if joint_distance(joints, self.joints) > _STILL:
            self.steps.append(MoveJoints(joints, self.joints, holding=self.gripped))
        self.joints, self.tcp = joints, tcp_matrix(self.config, joints)

    def _move_linear(self, target: Matrix, joints: Joints, *, guarded: bool = False) -> None:
        length = float(np.linalg.norm(target[:3, 3] - self.tcp[:3, 3]))
        if length > _STILL:
            self.steps.append(
                MoveLinear(
                    matrix_to_pose(target),
                    joints,
                    self.joints,
                    length,
                    holding=self.gripped,
                    guarded=guarded,
                )
            )
        self.joints, self.tcp = joints, target

    def _tool_yaw(self) -> float:
        return math.atan2(self.tcp[1, 0], self.tcp[0, 0])


def names(command: Action, *roles: str) -> tuple[str, ...]:
    """Give a command's arguments.

    Raises:
        MotionError: They are not as many as their roles.
    """
    arguments: Sequence[object] = command.args
    if len(arguments) != len(roles):
        raise MotionError(
            f"{command} has {len(arguments)} arguments; "
            f"expected ({' '.join((command.name, *roles))})"
        )
    return tuple(map(str, arguments))


def _always(place: Place) -> Callable[[float], Place]:
    return lambda _turn: place


def _pointing_down(x: float, y: float, z: float, yaw: float) -> Matrix:
    """Give the tool centre point, (4, 4), with the tool axis down and its x axis at yaw, rad."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, s, 0.0, x], [s, -c, 0.0, y], [0.0, 0.0, -1.0, z], [0.0, 0.0, 0.0, 1.0]])
