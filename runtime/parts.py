"""What is known of the parts from their drawings: shape, where to hold them, where they fit.

The driver plans grasps and insertions from it, the simulated cell builds its scene from it. A part
stands upright; its centre is the centre of the box around it, which is also where a detector
reports it. The file is YAML; its format is told at the top of `runtime/data/gearbox.yaml`.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Final, Literal, TypeAlias

import yaml

from runtime.errors import ConfigError

Shape: TypeAlias = Literal["box", "cylinder"]
Vector: TypeAlias = tuple[float, float, float]

GRIPPER_OPENING_M: Final = 0.085
"""How far apart the fingers are when the hand is open, m."""

GEARBOX: Final = Path(__file__).parent / "data" / "gearbox.yaml"
"""The parts of the paper's gearbox."""

_LONGEST_M: Final = 0.5
_KEYS: Final = ("colour", "grasp", "grip", "solids", "seats")
_SEAT_KEYS: Final = ("into", "at", "press_n", "clearance_m", "chamfer_m", "engages_m", "thread")
_THREAD_KEYS: Final = ("pitch_m", "turns")


@dataclass(frozen=True, slots=True)
class Primitive:
    """One solid of a part.

    Args:
        shape: A box, or an upright cylinder.
        size: Full width (x), depth (y) and height (z), m; a cylinder's width is its diameter.
        offset: Its centre relative to the part's centre, m.
        colour: Red, green and blue in [0, 1].
    """

    shape: Shape
    size: Vector
    offset: Vector
    colour: Vector


@dataclass(frozen=True, slots=True)
class ScrewThread:
    """The thread by which a part is screwed into its seat, right-handed.

    Args:
        pitch_m: How far one turn goes down.
        turns: From where the thread takes hold to where the part is tight.
    """

    pitch_m: float
    turns: float

    @property
    def depth_m(self) -> float:
        """How far all its turns go down."""
        return self.pitch_m * self.turns


@dataclass(frozen=True, slots=True)
class Seat:
    """A place a part fits into.

    Args:
        into: Type of the receiving part.
        offset: Centre of the seated part relative to the receiver's centre, m, receiver unturned.
        press_n: The force that seats it, N.
        clearance_m: How far its axis may be beside the seat's when it goes in.
        chamfer_m: How far beyond that the edge, broken at 45 degrees, still leads it in.
        engages_m: The part stands at least this high above its seat until it is in line with it.
        thread: How it is screwed in, None if it is only pushed in.
    """

    into: str
    offset: Vector
    press_n: float = 12.0
    clearance_m: float = 0.0006
    chamfer_m: float = 0.003
    engages_m: float = 0.0
    thread: ScrewThread | None = None


@dataclass(frozen=True, slots=True)
class PartModel:
    """A type of part.

    Args:
        type: The detector's class, such as "hubcover".
        primitives: Its solids.
        size: Width (x), depth (y) and height (z) of the box around it, m.
        grasp_height_m: The tool centre point above the part's centre when gripped (may be < 0).
        grip_width_m: Distance between the fingers holding it; wider than the hand: not grippable.
        seats: Where it fits.
    """

    type: str
    primitives: tuple[Primitive, ...]
    size: Vector
    grasp_height_m: float
    grip_width_m: float
    seats: tuple[Seat, ...] = ()

    @property
    def grippable(self) -> bool:
        """Whether the hand opens wide enough for it."""
        return self.grip_width_m < GRIPPER_OPENING_M


def load_parts(path: str | Path | None = None) -> Mapping[str, PartModel]:
    """Read part models, by type, in the order of the file.

    Args:
        path: A YAML file; None reads the gearbox that comes with the package.

    Raises:
        ConfigError: The file cannot be read, or a value is wrong: names key, value and range.
    """
    file = GEARBOX if path is None else Path(path)
    try:
        tree = yaml.safe_load(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{file}: cannot be read ({error}).") from error
    except yaml.YAMLError as error:
        raise ConfigError(f"{file}: not valid YAML: {' '.join(str(error).split())}") from error
    try:
        drawings = _mapping(tree, "the file")
        heights = {name: _Drawing(name, body) for name, body in drawings.items()}
        models = {name: drawing.model(heights) for name, drawing in heights.items()}
    except ConfigError as error:
        raise ConfigError(f"{file}: {error}") from None
    return MappingProxyType(models)


class _Drawing:
    """One entry of the file: measured from the lower face, as on a drawing."""

    def __init__(self, name: str, body: object) -> None:
        self.name = name
        self.fields = _mapping(body, name)
        _check_keys(self.fields, name, _KEYS, needed=_KEYS[:-1])
        colour = _vector(self.fields["colour"], f"{name}.colour", 0.0, 1.0)
        rows = _sequence(self.fields["solids"], f"{name}.solids")
        if not rows:
            raise ConfigError(f"{name}.solids: [] is empty; expected at least one solid.")
        self.solids = [
            _solid(row, f"{name}.solids[{index}]", colour) for index, row in enumerate(rows)
        ]
        self.lows, self.highs = (
            tuple(
                choose(s.offset[axis] + sign * s.size[axis] / 2 for s in self.solids)
                for axis in range(3)
            )
            for choose, sign in ((min, -1), (max, 1))
        )
        centre = [(low + high) / 2 for low, high in zip(self.lows, self.highs, strict=True)]
        if max(abs(centre[0]), abs(centre[1]), abs(self.lows[2])) > 1e-6:
            raise ConfigError(
                f"{name}.solids: the box around them is centred at x {centre[0]:g}, y {centre[1]:g}"
                f" with its lower face at z {self.lows[2]:g}; expected 0, 0, 0."
            )
        self.height = self.highs[2]

    def model(self, drawings: Mapping[str, _Drawing]) -> PartModel:
        middle = self.height / 2
        return PartModel(
            type=self.name,
            primitives=tuple(
                Primitive(
                    s.shape, s.size, (s.offset[0], s.offset[1], s.offset[2] - middle), s.colour
                )
                for s in self.solids
            ),
            size=(self.highs[0] - self.lows[0], self.highs[1] - self.lows[1], self.height),
            grasp_height_m=_number(self.fields["grasp"], f"{self.name}.grasp", 0.0, self.height)
            - middle,
            grip_width_m=_number(self.fields["grip"], f"{self.name}.grip", 0.001, _LONGEST_M),
            seats=tuple(
                self._seat(row, f"{self.name}.seats[{index}]", drawings)
                for index, row in enumerate(
                    _sequence(self.fields.get("seats", []), f"{self.name}.seats")
                )
            ),
        )

    def _seat(self, row: object, where: str, drawings: Mapping[str, _Drawing]) -> Seat:
        fields = _mapping(row, where)
        _check_keys(fields, where, _SEAT_KEYS, needed=("into", "at"))
        into = fields["into"]
        if not isinstance(into, str) or into not in drawings or into == self.name:
            others = [name for name in drawings if name != self.name]
            raise ConfigError(f"{where}.into: {into!r} is no other part; {_hint(into, others)}.")
        x, y, z = _vector(fields["at"], f"{where}.at", -_LONGEST_M, _LONGEST_M)
        rise = z + (self.height - drawings[into].height) / 2
        return Seat(
            into,
            (x, y, round(rise, 9)),
            _number(fields.get("press_n", 12.0), f"{where}.press_n", 0.0, 100.0),
            _number(fields.get("clearance_m", 0.0006), f"{where}.clearance_m", 0.0001, 0.005),
            _number(fields.get("chamfer_m", 0.003), f"{where}.chamfer_m", 0.0, 0.01),
            _number(fields.get("engages_m", 0.0), f"{where}.engages_m", 0.0, 0.05),
            None if fields.get("thread") is None else _thread(fields["thread"], f"{where}.thread"),
        )


def _thread(value: object, where: str) -> ScrewThread:
    fields = _mapping(value, where)
    _check_keys(fields, where, _THREAD_KEYS, needed=_THREAD_KEYS)
    return ScrewThread(
        _number(fields["pitch_m"], f"{where}.pitch_m", 0.0002, 0.01),
        _number(fields["turns"], f"{where}.turns", 0.25, 20.0),
    )


def _solid(row: object, where: str, colour: Vector) -> Primitive:
    values = _sequence(row, where)
    if len(values) not in {7, 8}:
        raise ConfigError(
            f"{where}: {row!r} has {len(values)} entries; expected shape, width, depth, height,"
            " x, y, z and perhaps a shade."
        )
    shape = values[0]
    if shape not in {"box", "cylinder"}:
        raise ConfigError(f"{where}: unknown shape {shape!r}; expected 'box' or 'cylinder'.")
    width, depth, height = _vector(values[1:4], f"{where} size", 0.0005, _LONGEST_M)
    if shape == "cylinder" and width != depth:
        raise ConfigError(
            f"{where}: a cylinder of width {width:g} and depth {depth:g}; expected them equal."
        )
    x, y, z = _vector(values[4:7], f"{where} place", -_LONGEST_M, _LONGEST_M)
    shade = _number(values[7], f"{where} shade", 0.1, 2.0) if len(values) == 8 else 1.0
    red, green, blue = (min(1.0, shade * value) for value in colour)
    kind: Shape = "box" if shape == "box" else "cylinder"
    return Primitive(kind, (width, depth, height), (x, y, z + height / 2), (red, green, blue))


def _check_keys(
    fields: Mapping[str, object], where: str, known: Sequence[str], needed: Sequence[str]
) -> None:
    for key in fields:
        if key not in known:
            raise ConfigError(f"{where}: unknown key {key!r}; {_hint(key, known)}.")
    for key in needed:
        if key not in fields:
            raise ConfigError(f"{where}: the key {key!r} is missing.")


def _mapping(value: object, where: str) -> dict[str, object]:
    if not isinstance(value, dict) or not all(isinstance(key, str) for key in value):
        raise ConfigError(f"{where}: {value!r:.60} found; expected names with values.")
    return value


def _sequence(value: object, where: str) -> Sequence[object]:
    if not isinstance(value, list):
        raise ConfigError(f"{where}: {value!r:.60} found; expected a list.")
    return value


def _vector(value: object, where: str, low: float, high: float) -> Vector:
    numbers = _sequence(value, where)
    if len(numbers) != 3:
        raise ConfigError(f"{where}: {value!r} has {len(numbers)} entries; expected 3 numbers.")
    x, y, z = (_number(number, where, low, high) for number in numbers)
    return x, y, z


def _number(value: object, where: str, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ConfigError(f"{where}: {value!r} is no number; expected {low:g} to {high:g}.")
    if not low <= value <= high:
        raise ConfigError(f"{where}: {value:g} is out of range; expected {low:g} to {high:g}.")
    return float(value)


def _hint(word: object, known: Sequence[str]) -> str:
    close = difflib.get_close_matches(str(word), known, n=1)
    return f"did you mean {close[0]!r}?" if close else f"expected one of {', '.join(known)}"
