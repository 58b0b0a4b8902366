"""From driver commands to steps: what an arm will do, worked out and checked before it moves.

The tool always points straight down, turned as at the look pose where that can be had: a part then
keeps its place between the fingers from grasp to insertion, and only distances count. The arm goes
across at transit height, and comes down and goes up in straight lines.

| command | steps |
|---|---|
| `(grasp hand obj)` | up, over the part, down, close; it ends holding the part where it lies |
| `(take-out hand obj into)` | the same, and straight up out of the receiver |
| `(insert hand obj into)` | up, to the look pose, look, over the seat, down, open |
| `(place hand obj)` | up, over the nearest free spot, down, open |
| `(rest hand)` | up, to the look pose |
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

import numpy as np

from aapa import Anchor
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
from runtime.drivers.spots import free_spots
from runtime.drivers.steps import Grip, Look, MoveJoints, MoveLinear, Step
from runtime.kinematics import Joints, Matrix, matrix_to_pose, pose_to_matrix
from runtime.parts import PartModel

_YAWS: Final = tuple(math.radians(turn) for turn in (0, 30, -30, 60, -60, 90, -90))
_BRANCHES: Final = 2  # of the inverse, nearest first, that are tried for each way to turn the tool
_SPOTS: Final = 10  # free spots tried before giving up
_STILL: Final = 1e-6  # rad and m below which a move is none
_START_SLACK: Final = 0.005  # m and rad by which a standing arm may have missed a limit
_IN_HAND_SLACK: Final = 0.03  # m by which a held part may be anchored beside its place in the hand
_LEAST_PLAY: Final = 0.004  # m that the open fingers leave around a part


def plan_motion(
    commands: Sequence[Action],
    anchors: Mapping[str, Anchor],
    state: ArmState,
    config: RobotConfig,
    parts: Mapping[str, PartModel],
    *,
    looked: bool = False,
) -> tuple[Step, ...]:
    """Work out the steps that carry driver commands out, every one checked along its way.

    Args:
        commands: In order; their names without the star.
        anchors: Where the objects are, by name.
        state: Where the arm is and what it holds.
        config: The robot and its limits.
        parts: What is known of the parts, by type.
        looked: The arm stands at the look pose and has looked: the first command goes on from
            there. Used to plan the rest anew with what was seen.

    Raises:
        MotionError: A command is unknown or malformed, an object is unknown or not anchored, the
            hand is full or empty when it should not be, or the way is not within the limits.
    """
    planner = _Planner(anchors, state, config, parts)
    for index, command in enumerate(commands):
        carry_out = _COMMANDS.get(command.name)
        if carry_out is None:
            raise MotionError(
                f"unknown driver command {command.name!r}; "
                f"this arm carries out {', '.join(sorted(_COMMANDS))}"
            )
        planner.remaining = tuple(commands[index:])
        planner.looked = looked and index == 0
        carry_out(planner, command)
    return tuple(planner.steps)


@dataclass(frozen=True, slots=True)
class _Held:
    """A part in the hand: its model, and the tool centre point relative to its centre, m."""

    part: PartModel
    offset: tuple[float, float, float]

    @property
    def hangs_m(self) -> float:
        """How far it reaches below the tool centre point."""
        return max(0.0, self.offset[2] + self.part.size[2] / 2)


class _Planner:
    """Where arm and objects will be after the steps so far."""

    def __init__(
        self,
        anchors: Mapping[str, Anchor],
        state: ArmState,
        config: RobotConfig,
        parts: Mapping[str, PartModel],
    ) -> None:
        self.config = config
        self.steps: list[Step] = []
        self.remaining: tuple[Action, ...] = ()
        self.looked = False
        self._anchors = anchors
        self._parts = parts
        # Objects this plan moves stand elsewhere by the time of later commands.
        self._moved: dict[str, tuple[float, float, float]] = {}
        self._joints = state.joints
        self._tcp = pose_to_matrix(state.tcp_pose)
        self._closed = state.gripper_closed
        self._gripped = state.gripped
        self._hangs_m = 0.0
        look = tcp_matrix(config, config.look_joints)
        self._yaw = math.atan2(look[1, 0], look[0, 0])
        try:
            check_joints(config, state.joints, slack=_START_SLACK)
        except MotionError as error:
            raise MotionError(
                f"the arm stands outside its limits ({error}); move it back by hand"
            ) from None

    def grasp(self, hand: str, obj: str) -> None:
        """Take hold of a part where it lies."""
        part, (x, y, z) = self._part(obj), self._position(obj)
        if self._gripped:
            raise MotionError(f"{hand} cannot grasp {obj}: the gripper already feels a part")
        widest = self.config.gripper.opening_m - _LEAST_PLAY
        if part.grip_width_m > widest:
            raise MotionError(
                f"{obj} is {part.grip_width_m:.3f} m wide where it is gripped; "
                f"the gripper takes at most {widest:.3f} m"
            )
        if self._closed:
            self._grip(close=False, payload_kg=0.0)
        self.lift()
        self._reach((x, y, z + part.grasp_height_m), f"reach {obj}")
        self._grip(close=True, payload_kg=self.config.payload.part(part.type))
        self._moved[hand] = (x, y, z + part.grasp_height_m)

    def take_out(self, hand: str, obj: str, _into: str) -> None:
        """Take hold of a part and lift it out of what it sits in."""
        self.grasp(hand, obj)
        self.lift()

    def insert(self, hand: str, obj: str, into: str) -> None:
        """Seat the held part in another one."""
        held = self._held(hand, obj)
        receiver = self._part(into)
        seat = next((seat for seat in held.part.seats if seat.into == receiver.type), None)
        if seat is None:
            raise MotionError(f"{obj} ({held.part.type}) fits nowhere in {into} ({receiver.type})")
        self._hangs_m = held.hangs_m
        if not self.looked:
            self.rest()
            self.steps.append(Look(self.config.look_cycles, self.remaining))
        centre = _add(self._position(into), seat.offset)
        self._reach(_add(centre, held.offset), f"reach the seat of {obj} in {into}")
        self._release(hand, obj, centre, held)

    def place(self, hand: str, obj: str) -> None:
        """Put the held part down at the nearest free spot of the put-down area."""
        held = self._held(hand, obj)
        self._hangs_m = held.hangs_m
        self.lift()
        here = (float(self._tcp[0, 3]), float(self._tcp[1, 3]))
        others = (anchor for name, anchor in self._anchors.items() if name not in (hand, obj))
        spots = free_spots(held.part, here, others, self.config, self._parts)
        height = self.config.workspace.table_z_m + held.part.size[2] / 2
        refusal = MotionError(f"there is no free spot to put {obj} down")
        for x, y in itertools.islice(spots, _SPOTS):
            try:
                self._reach(_add((x, y, height), held.offset), f"put {obj} down")
            except MotionError as error:
                refusal = error
            else:
                self._release(hand, obj, (x, y, height), held)
                return
        raise refusal

    def rest(self, _hand: str = "") -> None:
        """Go to the look pose."""
        self.lift()
        target = self.config.look_joints
        try:
            check_joint_move(self.config, self._joints, target, hangs_m=self._hangs_m)
        except MotionError as error:
            raise MotionError(f"cannot go to the look pose: {error}") from None
        self._move_joints(target)

    def lift(self) -> None:
        """Go straight up to transit height, unless the tool is that high."""
        heights, box = self.config.heights, self.config.workspace
        transit = box.table_z_m + heights.transit_m
        height = float(self._tcp[2, 3])
        if height >= transit - self.config.watch.position_tolerance_m:
            return
        target = self._tcp.copy()
        target[2, 3] = max(transit, height + heights.retreat_m)
        try:
            path = linear_path(self.config, self._joints, self._tcp, target)
        except MotionError as error:
            raise MotionError(f"cannot go straight up: {error}") from None
        self._move_linear(target, path[-1])

    def _reach(self, target: tuple[float, float, float], what: str) -> None:
        """Go over a place and straight down to it; the steps are added only if all is within."""
        x, y, z = target
        heights, box = self.config.heights, self.config.workspace
        top = max(box.table_z_m + heights.transit_m, z + heights.approach_m)
        refusal = MotionError(
            f"cannot {what}: ({x:.3f}, {y:.3f}, {z:.3f}) m is out of the arm's reach"
        )
        refused = False
        try:
            check_place(self.config, target)
            check_place(self.config, (x, y, top))
        except MotionError as error:
            raise MotionError(f"cannot {what}: {error}") from None
        for turn in _YAWS:
            over, down = (_pointing_down(x, y, height, self._yaw + turn) for height in (top, z))
            for joints in arm_solutions(self.config, over, self._joints)[:_BRANCHES]:
                try:
                    check_joint_move(self.config, self._joints, joints, hangs_m=self._hangs_m)
                    path = linear_path(self.config, joints, over, down)
                except MotionError as error:
                    if not refused:  # the first is about the way the tool would best be turned
                        refusal, refused = MotionError(f"cannot {what}: {error}"), True
                    continue
                self._move_joints(joints)
                self._move_linear(down, path[-1])
                return
        raise refusal

    def _move_joints(self, joints: Joints) -> None:
        if joint_distance(joints, self._joints) > _STILL:
            self.steps.append(MoveJoints(joints, self._joints, holding=self._gripped))
        self._joints, self._tcp = joints, tcp_matrix(self.config, joints)

    def _move_linear(self, target: Matrix, joints: Joints) -> None:
        length = float(np.linalg.norm(target[:3, 3] - self._tcp[:3, 3]))
        if length > _STILL:
            self.steps.append(
                MoveLinear(
                    matrix_to_pose(target), joints, self._joints, length, holding=self._gripped
                )
            )
        self._joints, self._tcp = joints, target

    def _grip(self, *, close: bool, payload_kg: float) -> None:
        self.steps.append(Grip(close, close, self.config.payload.gripper_kg + payload_kg))
        self._closed = self._gripped = close

    def _release(
        self, hand: str, obj: str, centre: tuple[float, float, float], held: _Held
    ) -> None:
        self._grip(close=False, payload_kg=0.0)
        self._moved[obj], self._moved[hand] = centre, _add(centre, held.offset)
        self._hangs_m = 0.0

    def _part(self, name: str) -> PartModel:
        anchor = self._anchors.get(name)
        if anchor is None:
            raise MotionError(f"{name} is not anchored")
        part = self._parts.get(anchor.type)
        if part is None:
            raise MotionError(f"{name} is a {anchor.type}, of which nothing is known")
        return part

    def _position(self, name: str) -> tuple[float, float, float]:
        if name in self._moved:
            return self._moved[name]
        anchor = self._anchors.get(name)
        if anchor is None:
            raise MotionError(f"{name} is not anchored")
        if anchor.position is None:
            raise MotionError(f"{name} is anchored in the image only, its place is not known")
        return anchor.position

    def _held(self, hand: str, obj: str) -> _Held:
        part = self._part(obj)
        if not self._gripped:
            raise MotionError(f"{hand} does not hold {obj}: the gripper feels no part")
        x, y, z = (
            tool - centre
            for tool, centre in zip(self._position(hand), self._position(obj), strict=True)
        )
        beside, above = math.hypot(x, y), abs(z - part.grasp_height_m)
        if max(beside, above) > _IN_HAND_SLACK:
            raise MotionError(
                f"{obj} is anchored {max(beside, above):.3f} m away from its place in {hand}"
            )
        return _Held(part, (x, y, z))


_COMMANDS: Final[Mapping[str, Callable[[_Planner, Action], None]]] = MappingProxyType(
    {
        "grasp": lambda planner, command: planner.grasp(*_names(command, "hand", "obj")),
        "insert": lambda planner, command: planner.insert(*_names(command, "hand", "obj", "into")),
        "place": lambda planner, command: planner.place(*_names(command, "hand", "obj")),
        "rest": lambda planner, command: planner.rest(*_names(command, "hand")),
        "take-out": lambda planner, command: planner.take_out(
            *_names(command, "hand", "obj", "into")
        ),
    }
)

COMMANDS: Final = frozenset(_COMMANDS)
"""The names of the driver commands, without the star."""


def _names(command: Action, *roles: str) -> Iterator[str]:
    if len(command.args) != len(roles):
        raise MotionError(
            f"{command} has {len(command.args)} arguments; "
            f"expected ({' '.join((command.name, *roles))})"
        )
    return map(str, command.args)


def _pointing_down(x: float, y: float, z: float, yaw: float) -> Matrix:
    """Give the tool centre point, (4, 4), with the tool axis down and its x axis at yaw, rad."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.array([[c, s, 0.0, x], [s, -c, 0.0, y], [0.0, 0.0, -1.0, z], [0.0, 0.0, 0.0, 1.0]])


def _add(
    a: tuple[float, float, float], b: tuple[float, float, float]
) -> tuple[float, float, float]:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]
