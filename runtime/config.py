"""Robot configuration: what one arm in one cell may do, read from YAML and checked value by value.

Every number carries its allowed range and unit in its annotation. They are checked whenever a
configuration is made, `dataclasses.replace` included: no driver ever holds one that is not allowed.
The caps on speeds are those of this package, not of the arm: 0.25 m/s at the tool, the limit that
ISO 10218-1 sets for reduced speed, and 1 rad/s at the joints.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields, is_dataclass
from pathlib import Path
from typing import (
    Annotated,
    Any,
    Final,
    NamedTuple,
    TypeAlias,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

import yaml

from runtime.errors import ConfigError
from runtime.kinematics import MODELS, ArmModel, Joints, Pose

Range: TypeAlias = tuple[float, float]
"""Lowest and highest value."""

Masses: TypeAlias = tuple[tuple[str, float], ...]
"""Part types with their mass, kg. Pairs, so that a configuration can be hashed and pickled."""

DATA: Final = Path(__file__).parent / "data"
MAX_TOOL_SPEED: Final = 0.25
MAX_JOINT_SPEED: Final = 1.0

_TURN: Final = 2 * math.pi


class Limit(NamedTuple):
    """The range and unit of a number, or of each number of a tuple."""

    low: float
    high: float
    unit: str


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
        _validate(self, "speeds")


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
        _validate(self, "workspace")
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
        _validate(self, "payload")

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
        _validate(self, "gripper")


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
        _validate(self, "heights")


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
        _validate(self, "watch")


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotConfig:
    """One arm, its tool and its cell.

    Args:
        model: The arm, by its name in `runtime.kinematics.MODELS`.
        look_joints: From here the camera sees the whole parts area; the tool points down, rad.
        tcp: From the flange to the tool centre point between the fingertips, m and rad.
        look_cycles: Camera frames taken at the look pose before a motion relies on them.
        speeds, workspace, payload, gripper, heights, watch: See there.
    """

    model: str
    look_joints: Annotated[Joints, Limit(-_TURN, _TURN, "rad")]
    tcp: Annotated[Pose, Limit(-math.pi, math.pi, "m and rad")]
    look_cycles: Annotated[int, Limit(1, 100, "cycles")] = 3
    speeds: Speeds
    workspace: Workspace
    payload: Payload
    gripper: Gripper
    heights: Heights
    watch: Watch = field(default_factory=Watch)

    def __post_init__(self) -> None:
        if str(self.model) not in MODELS:
            raise ConfigError(
                f"model: {self.model!r} is not an arm that is known; "
                f"expected one of {', '.join(sorted(MODELS))}"
            )
        _validate(self, "")
        if math.hypot(*self.tcp[:3]) > 0.5:
            raise ConfigError(
                f"tcp: {math.hypot(*self.tcp[:3]):g} m from the flange to the tool centre point; "
                "expected at most 0.5 m"
            )
        heaviest = self.payload.gripper_kg + max(
            (self.payload.part_kg, *(kg for _, kg in self.payload.parts_kg))
        )
        if heaviest > self.arm.payload_kg:
            raise ConfigError(
                f"payload: gripper and heaviest part weigh {heaviest:g} kg; "
                f"expected at most the {self.arm.payload_kg:g} kg a {self.model} may carry"
            )
        # The controller hears nothing while it stops the arm: the watchdog must outlast that.
        stopping = self.speeds.joint / self.speeds.stop_deceleration
        if stopping > 0.8 / self.watch.watchdog_hz:
            least = self.speeds.joint * self.watch.watchdog_hz / 0.8
            raise ConfigError(
                f"speeds.stop_deceleration: {self.speeds.stop_deceleration:g}; expected at least "
                f"{least:g} rad/s^2, or the watchdog ({self.watch.watchdog_hz:g} Hz) acts first"
            )

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
            text names file, key, value and what is allowed.
    """
    shipped = DATA / f"{name_or_path}.yaml"
    path = shipped if shipped.is_file() else Path(name_or_path)
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ConfigError(
            f"{name_or_path}: no robot configuration of this name and no such file; "
            f"expected a YAML file or one of {', '.join(_shipped())}"
        ) from None
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise ConfigError(f"{path}: cannot be read as YAML: {error}") from None
    try:
        return cast("RobotConfig", _read(RobotConfig, content, ""))
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}") from None


def _shipped() -> list[str]:
    return sorted(
        path.stem for path in DATA.glob("*.yaml") if path.stem.partition("-")[0] in MODELS
    )


def _read(kind: type[Any], content: object, place: str) -> object:
    """Build a configuration class from parsed YAML, refusing keys it does not have."""
    if not isinstance(content, Mapping):
        raise ConfigError(f"{place or 'the file'}: expected keys with values, got {content!r}")
    known = {entry.name: entry for entry in fields(kind)}
    for key in content:
        if key not in known:
            close = difflib.get_close_matches(str(key), known, n=1)
            hint = f"did you mean {close[0]!r}?" if close else f"expected {', '.join(known)}"
            raise ConfigError(f"{_join(place, str(key))}: unknown key; {hint}")
    hints = get_type_hints(kind)
    values: dict[str, object] = {}
    for name, entry in known.items():
        if name not in content:
            if entry.default is MISSING and entry.default_factory is MISSING:
                raise ConfigError(f"{_join(place, name)}: missing")
            continue
        value, inner = content[name], hints[name]
        if is_dataclass(inner):
            values[name] = _read(cast("type[Any]", inner), value, _join(place, name))
        elif inner == Masses and isinstance(value, dict):
            values[name] = tuple(sorted((str(key), item) for key, item in value.items()))
        else:
            values[name] = tuple(value) if isinstance(value, list) else value
    return kind(**values)


def _validate(config: Any, place: str) -> None:
    """Check every number of a configuration class against its declared range."""
    for key, annotated in get_type_hints(type(config), include_extras=True).items():
        if get_origin(annotated) is not Annotated:
            continue
        hint, limit = get_args(annotated)
        name, value = _join(place, key), getattr(config, key)
        if hint == Masses:
            pairs = isinstance(value, tuple) and all(isinstance(pair, tuple) for pair in value)
            if not pairs or any(len(pair) != 2 for pair in value):
                raise ConfigError(f"{name}: {value!r}; expected part types with {limit.unit}")
            for type_, mass in value:
                _check_number(_join(name, type_), mass, limit)
        elif get_origin(hint) is tuple:
            size = len(get_args(hint))
            if not isinstance(value, tuple) or len(value) != size:
                raise ConfigError(f"{name}: {value!r}; expected {size} numbers, {limit.unit}")
            for item in value:
                _check_number(name, item, limit)
        else:
            _check_number(name, value, limit, whole=hint is int)


def _check_number(name: str, value: object, limit: Limit, *, whole: bool = False) -> None:
    number = isinstance(value, int if whole else int | float) and not isinstance(value, bool)
    if not number or not limit.low <= cast("float", value) <= limit.high:  # also refuses NaN
        kind = "a whole number" if whole else "a number"
        raise ConfigError(
            f"{name}: {value!r}; expected {kind} from {limit.low:.6g} to {limit.high:.6g} "
            f"{limit.unit}".rstrip()
        )


def _join(place: str, name: str) -> str:
    return f"{place}.{name}" if place else name
