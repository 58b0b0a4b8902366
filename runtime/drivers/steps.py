"""The steps a motion is made of, each of which an arm carries out in one go.

A step says where it starts as well as where it ends: it was checked from there, and must not be
carried out from anywhere else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from icarus_lite import Action
from runtime.config import RobotConfig
from runtime.drivers.limits import joint_distance, travel_time
from runtime.kinematics import Joints, Pose


@dataclass(frozen=True, slots=True)
class MoveJoints:
    """Go to joint angles, straight in joint space.

    Args:
        joints: The target, rad.
        start: Where the move was planned from, rad.
        holding: Whether a part must be felt all the way.
    """

    joints: Joints
    start: Joints
    holding: bool = False

    def __str__(self) -> str:
        return f"move joints to ({', '.join(f'{q:.3f}' for q in self.joints)}) rad"


@dataclass(frozen=True, slots=True)
class MoveLinear:
    """Go to a pose, the tool centre point on a straight line.

    Args:
        pose: The target of the tool centre point, m and rad.
        joints: The joint angles expected there, rad.
        start: Where the move was planned from, rad.
        length_m: Length of the line.
        holding: Whether a part must be felt all the way.
    """

    pose: Pose
    joints: Joints
    start: Joints
    length_m: float
    holding: bool = False

    def __str__(self) -> str:
        return f"move in a line to ({', '.join(f'{v:.3f}' for v in self.pose[:3])}) m"


@dataclass(frozen=True, slots=True)
class Grip:
    """Close or open the gripper.

    Args:
        close: Close it, or else open it.
        expect_gripped: Whether a part must be felt afterwards; if not, none may be felt.
        payload_kg: What hangs on the flange afterwards, gripper included.
    """

    close: bool
    expect_gripped: bool
    payload_kg: float

    def __str__(self) -> str:
        return "close the gripper" if self.close else "open the gripper"


@dataclass(frozen=True, slots=True)
class Look:
    """Stand still for some cycles so that perception gets fresh frames, then plan the rest anew.

    Args:
        cycles: How many.
        then: The commands still to be carried out, the first of them from its look on.
    """

    cycles: int
    then: tuple[Action, ...]

    def __str__(self) -> str:
        return f"look for {self.cycles} cycles"


Step: TypeAlias = MoveJoints | MoveLinear | Grip | Look


def duration_s(step: MoveJoints | MoveLinear, config: RobotConfig) -> float:
    """Give the time a move takes at the configured speeds, s."""
    speeds = config.speeds
    if isinstance(step, MoveJoints):
        travel = joint_distance(step.start, step.joints)
        return travel_time(travel, speeds.joint, speeds.joint_acceleration)
    return travel_time(step.length_m, speeds.tool, speeds.tool_acceleration)


def grip_failure(step: Grip) -> str:
    """Say what the sensor does not show after a grip."""
    if step.expect_gripped:
        return "the gripper closed but feels no part"
    return "the gripper opened but still feels a part"
