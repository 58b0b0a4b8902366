"""The steps a motion is made of, each of which an arm carries out in one go.

A move says where it starts as well as where it ends: it was checked from there, and must not be
carried out from anywhere else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

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
        guarded: Whether it ends, failed, when the tool feels more than the force allowed.
    """

    pose: Pose
    joints: Joints
    start: Joints
    length_m: float
    holding: bool = False
    guarded: bool = False

    def __str__(self) -> str:
        return f"move in a line to ({', '.join(f'{v:.3f}' for v in self.pose[:3])}) m"


@dataclass(frozen=True, slots=True)
class Grip:
    """Close or open the gripper.

    Args:
        close: Close it, or else open it.
        expect_gripped: Whether a part must be felt afterwards; if not, none may be felt.
        payload_kg: What hangs on the flange afterwards, gripper included.
        centre_of_gravity_m: Of all that, from the flange; None is that of the gripper alone.
        again: Whether the part is let go only to be taken hold of again.
    """

    close: bool
    expect_gripped: bool
    payload_kg: float
    centre_of_gravity_m: tuple[float, float, float] | None = None
    again: bool = False

    def __str__(self) -> str:
        return "close the gripper" if self.close else "open the gripper"


@dataclass(frozen=True, slots=True)
class Tare:
    """Take what the force sensor shows now for nothing: at rest, the tool touching nothing."""

    def __str__(self) -> str:
        return "zero the force sensor"


@dataclass(frozen=True, slots=True)
class Press:
    """Go straight down by force, until what the hand holds has come home and is pressed there.

    Args:
        pose: The tool centre point when it is home, m and rad.
        joints: The joint angles expected there, rad.
        start: Where the step was planned from, rad.
        length_m: The way down.
        press_n: The force with which it must have been pressed in the end, N.
        search_m: How far around the pose an opening is looked for, m; 0: it is not.
        spiral_m: From one winding of that search to the next: what an opening forgives, m.
        tolerance_m: How far above the pose it counts as home, m.
        then: If it fails, the commands to be planned anew: how to come away.
    """

    pose: Pose
    joints: Joints
    start: Joints
    length_m: float
    press_n: float
    search_m: float
    spiral_m: float
    tolerance_m: float
    then: tuple[Action, ...] = ()

    def __str__(self) -> str:
        return f"press home at z = {self.pose[2]:.3f} m with {self.press_n:g} N"


@dataclass(frozen=True, slots=True)
class Turn:
    """Turn the tool about its own axis, the torque limited, until it stops or wrist 3 must.

    Args:
        clockwise: Seen from above: the way a screw is driven in.
        angle_rad: How far there is to turn, > 0; screwing in goes a little beyond until it stops.
        most_rad: How far it may turn at most, rad.
        wrist_until_rad: Where wrist 3 must stop.
        press_n: The force downward all the while, N.
        torque_nm: The torque at which it stops, Nm.
        pitch_m: How far one turn takes the tool down or up, m.
        then: The commands to be planned anew after it, the first of them from here on.
        failure: Why a screw is being backed out; empty where it is not.
    """

    clockwise: bool
    angle_rad: float
    most_rad: float
    wrist_until_rad: float
    press_n: float
    torque_nm: float
    pitch_m: float
    then: tuple[Action, ...]
    failure: str = ""

    def __str__(self) -> str:
        way = "clockwise" if self.clockwise else "counter-clockwise"
        return f"turn {self.angle_rad:.2f} rad {way} with at most {self.torque_nm:g} Nm"


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


@dataclass(frozen=True, slots=True)
class GiveUp:
    """The end of a motion that has failed, once the arm has come away.

    Args:
        reason: Why it has failed.
    """

    reason: str

    def __str__(self) -> str:
        return f"give up: {self.reason}"


Step: TypeAlias = MoveJoints | MoveLinear | Grip | Tare | Press | Turn | Look | GiveUp

ArmStep: TypeAlias = MoveJoints | MoveLinear | Grip | Tare | Press | Turn
"""A step that an arm carries out."""


@dataclass(frozen=True, slots=True)
class Felt:
    """What was measured in a step by force.

    Args:
        words: The figures, for the outcome.
        turned_rad: How far the tool has turned, clockwise seen from above, rad.
        stalled: Whether the torque at which it stops was reached.
        sunk_m: How far the tool has gone down while it turned.
    """

    words: str = ""
    turned_rad: float = 0.0
    stalled: bool = False
    sunk_m: float = 0.0


@dataclass(frozen=True, slots=True)
class Progress:
    """How far the first command of a motion has come, when the rest is planned anew.

    Args:
        looked: The arm stands at the look pose and has looked.
        turned_rad: How far a screw has been turned, clockwise, rad; None: that has not begun.
        stalled: Whether the last turn was ended by its torque, or backing out has failed.
        failure: Why the command has failed; what is left is to come away. Empty: it has not.
        sunk_m: How far it has gone down while it was turned; None: that was not measured.
    """

    looked: bool = False
    turned_rad: float | None = None
    stalled: bool = False
    failure: str = ""
    sunk_m: float | None = None


GUARDED_M_S: Final = 0.08
"""No faster is a guarded line. Once the force allowed is passed, 60 N as the configuration comes,
two readings and an order take 0.03 s, and braking at 4 rad/s^2, half a metre from the joints, as
long again: 4 mm, which at 20 N/mm are another 80 N. Above 150 N an arm stops by itself."""


def line_speed(step: MoveLinear, config: RobotConfig) -> float:
    """Give the speed of the tool on a line, m/s."""
    return min(config.speeds.tool, GUARDED_M_S) if step.guarded else config.speeds.tool


def duration_s(step: MoveJoints | MoveLinear | Press | Turn, config: RobotConfig) -> float:
    """Give the time a step takes at the configured speeds if nothing is in the way, s."""
    speeds, force = config.speeds, config.force
    match step:
        case MoveJoints():
            travel = joint_distance(step.start, step.joints)
            return travel_time(travel, speeds.joint, speeds.joint_acceleration)
        case MoveLinear():
            return travel_time(step.length_m, line_speed(step, config), speeds.tool_acceleration)
        case Press():
            return step.length_m / force.descent_speed
        case Turn():
            return step.angle_rad / force.turning_speed


def is_holding(step: Step) -> bool:
    """Tell whether a part must be felt between the fingers all through a step."""
    match step:
        case MoveJoints(holding=holding) | MoveLinear(holding=holding):
            return holding
        case Press() | Turn():
            return True
        case _:
            return False


def grip_failure(step: Grip) -> str:
    """Say what the sensor does not show after a grip."""
    if step.expect_gripped:
        return "the gripper closed but feels no part"
    return "the gripper opened but still feels a part"
