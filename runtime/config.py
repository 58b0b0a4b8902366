"""Robot configuration: what one arm in one cell may do, read from YAML and checked value by value.

Every number carries its allowed range and unit in its annotation. They are checked whenever a
configuration is made, `dataclasses.replace` included: no driver ever holds one that is not allowed.
The caps on speeds are those of this package, not of the arm: 0.25 m/s at the tool, the limit that
ISO 10218-1 sets for reduced speed, and 1 rad/s at the joints.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Final, TypeAlias

from runtime.checked_yaml import Limit, Masses, check, load
from runtime.errors import ConfigError
from runtime.kinematics import MODELS, ArmModel, Joints, Pose, link_frames, pose_to_matrix

Range: TypeAlias = tuple[float, float]
"""Lowest and highest value."""

DATA: Final = Path(__file__).parent / "data"
MAX_TOOL_SPEED: Final = 0.25
MAX_JOINT_SPEED: Final = 1.0

_TURN: Final = 2 * math.pi
_DOWN: Final = math.cos(math.radians(5))  # the tool points down if it is no more than this off


@dataclass(frozen=True, slots=True, kw_only=True)
class Speeds:
    """How fast it moves.

    Args:
        joint: Of the leading joint in joint moves, rad/s.
        joint_acceleration: rad/s^2.
        tool: Of the tool centre point in straight moves, m/s.
        tool_acceleration: m/s^2.
        stop_deceleration: Of the leading joint when a motion is called off, rad/s^2.
    """

    joint: Annotated[float, Limit(0.01, MAX_JOINT_SPEED, "rad/s")]
    joint_acceleration: Annotated[float, Limit(0.05, 2.0, "rad/s^2")]
    tool: Annotated[float, Limit(0.005, MAX_TOOL_SPEED, "m/s")]
    tool_acceleration: Annotated[float, Limit(0.02, 1.2, "m/s^2")]
    stop_deceleration: Annotated[float, Limit(1.0, 10.0, "rad/s^2")] = 4.0

    def __post_init__(self) -> None:
        check(self, "speeds")


@dataclass(frozen=True, slots=True, kw_only=True)
class Workspace:
    """Where the arm may be, in the base frame with the table's top at `table_z_m`.

    Args:
        x: Of the tool centre point, m.
        y: Of the tool centre point, m.
        z: Of the tool centre point, m.
        table_z_m: Height of the table's top, m.
        table_clearance_m: Least height of the tool centre point, and of what it holds while it is
            carried, over the table, m.
        link_clearance_m: Least height of the arm's joints from elbow to flange over the table, m.
        base_clearance_m: Least horizontal distance of the tool centre point from the base axis, m.
        joint_limit_rad: Greatest absolute joint angle, rad.
        put_down: x and y of the area in which a part may be put down, m, as (x0, x1, y0, y1).
    """

    x: Annotated[Range, Limit(-1.2, 1.2, "m")]
    y: Annotated[Range, Limit(-1.2, 1.2, "m")]
    z: Annotated[Range, Limit(-0.5, 1.5, "m")]
    table_z_m: Annotated[float, Limit(-0.5, 0.5, "m")] = 0.0
    table_clearance_m: Annotated[float, Limit(0.001, 0.1, "m")] = 0.003
    link_clearance_m: Annotated[float, Limit(0.02, 0.3, "m")] = 0.06
    base_clearance_m: Annotated[float, Limit(0.1, 0.5, "m")] = 0.2
    joint_limit_rad: Annotated[float, Limit(0.5, _TURN - 0.05, "rad")] = 6.1
    put_down: Annotated[tuple[float, float, float, float], Limit(-1.2, 1.2, "m")]

    def __post_init__(self) -> None:
        check(self, "workspace")
        x0, x1, y0, y1 = self.put_down
        for key, (low, high) in (
            ("x", self.x),
            ("y", self.y),
            ("z", self.z),
            ("put_down", (x0, x1)),
            ("put_down", (y0, y1)),
        ):
            if low >= high:
                raise ConfigError(
                    f"workspace.{key}: {low:g} to {high:g} m is empty; "
                    "the first number of each pair must be the smaller one"
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Payload:
    """What hangs on the flange.

    Args:
        gripper_kg: Mass of the gripper.
        centre_of_gravity_m: Of the gripper, from the flange, m.
        part_kg: Mass taken for a held part whose type `parts_kg` does not list.
        parts_kg: Pairs of part type and mass, kg; a mapping in the file.
    """

    gripper_kg: Annotated[float, Limit(0.0, 10.0, "kg")]
    centre_of_gravity_m: Annotated[tuple[float, float, float], Limit(-0.5, 0.5, "m")]
    part_kg: Annotated[float, Limit(0.0, 16.0, "kg")]
    parts_kg: Annotated[Masses, Limit(0.0, 16.0, "kg")] = ()

    def __post_init__(self) -> None:
        check(self, "payload")

    def part(self, type_: str) -> float:
        """Give the mass of a part of a type, kg."""
        return dict(self.parts_kg).get(type_, self.part_kg)


@dataclass(frozen=True, slots=True, kw_only=True)
class Gripper:
    """A two-finger gripper wired to the tool connector.

    Args:
        output: Tool digital output that closes it while on.
        input: Tool digital input that is on while a part is felt.
        close_time_s: Time it takes to close or open, s.
        sense_time_s: Longest wait for the sensor after that, s.
        opening_m: Widest part it can take, m.
        width_m: Its outline across the tool axis, m.
        length_m: From the tool centre point back to where it is widest, m.
    """

    output: Annotated[int, Limit(0, 1, "")] = 0
    input: Annotated[int, Limit(0, 1, "")] = 0
    close_time_s: Annotated[float, Limit(0.05, 5.0, "s")] = 0.4
    sense_time_s: Annotated[float, Limit(0.05, 10.0, "s")] = 2.0
    opening_m: Annotated[float, Limit(0.005, 0.3, "m")] = 0.085
    width_m: Annotated[float, Limit(0.01, 0.4, "m")] = 0.11
    length_m: Annotated[float, Limit(0.01, 0.4, "m")] = 0.15

    def __post_init__(self) -> None:
        check(self, "gripper")


@dataclass(frozen=True, slots=True, kw_only=True)
class Heights:
    """How high it travels; heights of the tool centre point.

    Args:
        transit_m: Least height over the table from which it goes across, m.
        transit_sag_m: How far a joint move may sag below the lower of its two ends, m.
        approach_m: Least height over the target at which the straight way down begins, m.
        retreat_m: Least height of the straight way up before it goes across, m.
    """

    transit_m: Annotated[float, Limit(0.05, 0.8, "m")]
    transit_sag_m: Annotated[float, Limit(0.0, 0.3, "m")] = 0.05
    approach_m: Annotated[float, Limit(0.01, 0.5, "m")] = 0.1
    retreat_m: Annotated[float, Limit(0.01, 0.5, "m")] = 0.1

    def __post_init__(self) -> None:
        check(self, "heights")


@dataclass(frozen=True, slots=True, kw_only=True)
class Watch:
    """What ends a motion that does not go as planned.

    Args:
        connect_s: Longest wait for the controller to accept the driver, s.
        silence_s: Longest time without a new state from the controller, s.
        worker_silence_s: Longest time without a sign of life from the driver's own process, s.
        deadline_factor: A motion may take this much longer than planned...
        deadline_margin_s: ...and this much on top, s of the controller's clock.
        watchdog_hz: The controller stops the arm by itself when it is addressed less often.
        start_tolerance_rad: Greatest joint difference between planned and measured start, rad.
        joint_tolerance_rad: Greatest joint difference between target and measured end, rad.
        position_tolerance_m: Greatest distance of target and measured end, m.
    """

    connect_s: Annotated[float, Limit(1.0, 60.0, "s")] = 20.0
    silence_s: Annotated[float, Limit(0.05, 2.0, "s")] = 0.15
    worker_silence_s: Annotated[float, Limit(0.2, 5.0, "s")] = 1.0
    deadline_factor: Annotated[float, Limit(1.0, 3.0, "")] = 1.1
    deadline_margin_s: Annotated[float, Limit(0.1, 5.0, "s")] = 0.5
    watchdog_hz: Annotated[float, Limit(1.0, 50.0, "Hz")] = 4.0
    start_tolerance_rad: Annotated[float, Limit(0.001, 0.05, "rad")] = 0.01
    joint_tolerance_rad: Annotated[float, Limit(0.0001, 0.05, "rad")] = 0.005
    position_tolerance_m: Annotated[float, Limit(0.0001, 0.01, "m")] = 0.001

    def __post_init__(self) -> None:
        check(self, "watch")


@dataclass(frozen=True, slots=True, kw_only=True)
class Force:
    """What the arm may do by force: pressing parts home, and driving screws.

    Args:
        descent_n: Pressed downward while it comes down and feels for an opening, N.
        descent_speed: Of the tool on its way down, m/s.
        guard_m: How far above its target the way down by force begins, m.
        search_radius_m: How far around where it should be an opening is looked for, m.
        search_n: Pushed sideways at most while looking for it, N.
        search_speed: Of the tool while looking for it, m/s.
        seat_tolerance_m: How far above the expected height a part counts as seated, m.
        torque_nm: At which a screw is tight, Nm.
        turning_speed: Of the tool while it turns a screw, rad/s.
        regrip_m: How far the hand goes up to turn back and take hold of a screw again, m.
        press_time_s: Longest time to bring a part home...
        turn_time_s: ...and for one stroke of the wrist, s of the controller's clock.
        most_n: Whatever it does by force, and on its way down, ends above this, N. The arm's own
            protective stop comes at about 150 N.
    """

    descent_n: Annotated[float, Limit(2.0, 40.0, "N")] = 8.0
    descent_speed: Annotated[float, Limit(0.002, 0.05, "m/s")] = 0.02
    guard_m: Annotated[float, Limit(0.005, 0.1, "m")] = 0.03
    search_radius_m: Annotated[float, Limit(0.001, 0.015, "m")] = 0.006
    search_n: Annotated[float, Limit(1.0, 30.0, "N")] = 5.0
    search_speed: Annotated[float, Limit(0.001, 0.02, "m/s")] = 0.005
    seat_tolerance_m: Annotated[float, Limit(0.0003, 0.005, "m")] = 0.001
    torque_nm: Annotated[float, Limit(0.2, 8.0, "Nm")] = 1.5
    turning_speed: Annotated[float, Limit(0.05, MAX_JOINT_SPEED, "rad/s")] = 0.9
    regrip_m: Annotated[float, Limit(0.01, 0.2, "m")] = 0.03
    press_time_s: Annotated[float, Limit(5.0, 120.0, "s")] = 45.0
    turn_time_s: Annotated[float, Limit(5.0, 120.0, "s")] = 60.0
    most_n: Annotated[float, Limit(10.0, 120.0, "N")] = 60.0

    def __post_init__(self) -> None:
        check(self, "force")
        if self.descent_n > self.most_n / 2:
            raise ConfigError(
                f"force.descent_n: {self.descent_n:g}; expected at most half of force.most_n "
                f"({self.most_n:g} N), which ends whatever is done by force"
            )
        if self.search_n > self.descent_n:
            raise ConfigError(
                f"force.search_n: {self.search_n:g}; expected at most force.descent_n "
                f"({self.descent_n:g} N), or a part climbs out of every chamfer that leads it in"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotConfig:
    """One arm, its tool and its cell.

    Args:
        model: The arm, by its name in `runtime.kinematics.MODELS`.
        look_joints: From here the camera sees the whole parts area; the tool points down, rad.
        tcp: From the flange to the tool centre point between the fingertips, m and rad.
        look_cycles: Camera frames taken at the look pose before a motion relies on them.
        speeds, workspace, payload, gripper, heights, force, watch: See there.
    """

    model: str
    look_joints: Annotated[Joints, Limit(-_TURN, _TURN, "rad")]
    tcp: Annotated[Pose, Limit(-0.5, 0.5, "m"), Limit(-math.pi, math.pi, "rad")]
    look_cycles: Annotated[int, Limit(1, 100, "cycles")] = 3
    speeds: Speeds
    workspace: Workspace
    payload: Payload
    gripper: Gripper
    heights: Heights
    force: Force = field(default_factory=Force)
    watch: Watch = field(default_factory=Watch)

    def __post_init__(self) -> None:
        if str(self.model) not in MODELS:
            raise ConfigError(
                f"model: {self.model!r} is not an arm that is known; "
                f"expected one of {', '.join(sorted(MODELS))}"
            )
        check(self, "")
        _check_tool(self)
        _check_load(self)
        _check_watchdog(self)
        _check_look_pose(self)

    @property
    def arm(self) -> ArmModel:
        """The arm's geometry."""
        return MODELS[self.model]

    @property
    def reach_m(self) -> float:
        """How far from the base axis the tool centre point may come, m."""
        box = self.workspace
        return min(self.arm.reach_m, math.hypot(*(max(map(abs, span)) for span in (box.x, box.y))))


def load_robot(name_or_path: str | Path) -> RobotConfig:
    """Read a robot configuration.

    Args:
        name_or_path: A name that ships with the package, such as "ur5", or the path of a YAML file.

    Raises:
        ConfigError: There is no such file, it is not YAML, or a key or value in it is wrong; the
            text names file, line, key, value and what is allowed.
    """
    shipped = DATA / f"{name_or_path}.yaml"
    try:
        return load(RobotConfig, shipped if shipped.is_file() else Path(name_or_path))
    except FileNotFoundError:
        raise ConfigError(
            f"{name_or_path}: no robot configuration of this name and no such file; "
            f"expected a YAML file or one of {', '.join(_shipped())}"
        ) from None


def _shipped() -> list[str]:
    return sorted(
        path.stem for path in DATA.glob("*.yaml") if path.stem.partition("-")[0] in MODELS
    )


def _check_tool(config: RobotConfig) -> None:
    length = math.hypot(*config.tcp[:3])
    if length > 0.5:
        raise ConfigError(
            f"tcp: {length:g} m from the flange to the tool centre point; expected at most 0.5 m"
        )


def _check_load(config: RobotConfig) -> None:
    payload = config.payload
    heaviest = payload.gripper_kg + max((payload.part_kg, *(kg for _, kg in payload.parts_kg)))
    if heaviest > config.arm.payload_kg:
        raise ConfigError(
            f"payload: gripper and heaviest part weigh {heaviest:g} kg; "
            f"expected at most the {config.arm.payload_kg:g} kg a {config.model} may carry"
        )


def _check_watchdog(config: RobotConfig) -> None:
    """The controller hears nothing while it stops the arm: the watchdog must outlast that."""
    speeds, watchdog_hz = config.speeds, config.watch.watchdog_hz
    if speeds.joint / speeds.stop_deceleration > 0.8 / watchdog_hz:
        raise ConfigError(
            f"speeds.stop_deceleration: {speeds.stop_deceleration:g}; expected at least "
            f"{speeds.joint * watchdog_hz / 0.8:g} rad/s^2, or the watchdog ({watchdog_hz:g} Hz) "
            "acts first"
        )


def _check_look_pose(config: RobotConfig) -> None:
    """Refuse a look pose in which the arm could not stand: it is gone to all the time."""
    box, joints = config.workspace, config.look_joints
    if max(map(abs, joints)) > box.joint_limit_rad:
        raise ConfigError(
            f"look_joints: {max(joints, key=abs):g}; expected at most workspace.joint_limit_rad, "
            f"{box.joint_limit_rad:g} rad either way"
        )
    frames = link_frames(config.arm, joints)
    tcp = frames[6] @ pose_to_matrix(config.tcp)
    places = zip("xyz", tcp[:3, 3].tolist(), (box.x, box.y, box.z), strict=True)
    for axis, value, (low, high) in places:
        if not low <= value <= high:
            raise ConfigError(
                f"look_joints: they bring the tool of a {config.model} to {axis} = {value:.3f} m; "
                f"expected within workspace.{axis}, {low:g} to {high:g} m"
            )
    if float(frames[2:, 2, 3].min()) < box.table_z_m + box.link_clearance_m:
        raise ConfigError(
            "look_joints: they bring a joint of the arm to "
            f"{float(frames[2:, 2, 3].min()) - box.table_z_m:.3f} m over the table; expected at "
            f"least workspace.link_clearance_m, {box.link_clearance_m:g} m"
        )
    if float(tcp[2, 2]) > -_DOWN:
        off = math.degrees(math.acos(max(-1.0, min(1.0, -float(tcp[2, 2])))))
        raise ConfigError(
            f"look_joints: the tool of a {config.model} would point {off:.0f} degrees away from "
            "straight down; expected at most 5 (are they this arm's angles, in rad?)"
        )
