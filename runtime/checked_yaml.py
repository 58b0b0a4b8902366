"""Configuration classes whose numbers carry their ranges, and reading them from YAML.

A number is declared as `Annotated[float, Limit(low, high, unit)]`. It is checked whenever an
instance is made; what is read from a file is refused with the file, the line, the key, the value
and the allowed range, and with a guess where the number would do in another unit.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from pathlib import Path
from typing import (
    Annotated,
    Any,
    Final,
    NamedTuple,
    TypeAlias,
    TypeVar,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

import yaml

from runtime.errors import ConfigError

Masses: TypeAlias = tuple[tuple[str, float], ...]
"""Part types with their mass, kg. Pairs, so that a configuration can be hashed and pickled."""

Configuration = TypeVar("Configuration")

_OTHER_UNITS: Final[Mapping[str, tuple[str, float]]] = {
    "m": ("mm", 1e-3),
    "m/s": ("mm/s", 1e-3),
    "m/s^2": ("mm/s^2", 1e-3),
    "rad": ("degrees", math.pi / 180),
    "rad/s": ("degrees/s", math.pi / 180),
    "rad/s^2": ("degrees/s^2", math.pi / 180),
    "kg": ("g", 1e-3),
    "s": ("ms", 1e-3),
}
"""For each unit the one that is taken for it, and what one of that is."""

_FAR_OFF: Final = 8  # times the greatest allowed: less is too much, not another unit


class Limit(NamedTuple):
    """The range and unit of a number, or of each number of a tuple."""

    low: float
    high: float
    unit: str


def check(config: Any, place: str) -> None:
    """Check every number of a configuration against its declared range.

    Args:
        config: An instance of a dataclass with `Annotated` numbers.
        place: The key under which it stands, empty at the top.

    Raises:
        ConfigError: Names key, value and range.
    """
    for key, annotated in get_type_hints(type(config), include_extras=True).items():
        if get_origin(annotated) is not Annotated:
            continue
        hint, *limits = get_args(annotated)
        name, value = join(place, key), getattr(config, key)
        if hint == Masses:
            _check_masses(name, value, limits[0])
        elif get_origin(hint) is tuple:
            _check_tuple(name, value, len(get_args(hint)), limits)
        else:
            _check_number(name, value, limits[0], whole=hint is int)


def join(place: str, name: str) -> str:
    """Give the dotted key of a name under another."""
    return f"{place}.{name}" if place else name


def load(kind: type[Configuration], path: Path) -> Configuration:
    """Read a configuration class from a YAML file.

    Args:
        kind: A dataclass; the keys of the file are its fields, and its dataclasses' fields.
        path: The file.

    Raises:
        FileNotFoundError: There is no such file.
        ConfigError: It is not YAML, or a key or value is wrong; says where.
    """
    try:
        text = path.read_text(encoding="utf-8")
        tree = yaml.compose(text, Loader=yaml.SafeLoader)
        content = yaml.safe_load(text)
    except FileNotFoundError:
        raise
    except yaml.MarkedYAMLError as error:
        line = "" if error.problem_mark is None else f":{error.problem_mark.line + 1}"
        raise ConfigError(f"{path}{line}: cannot be read as YAML: {error.problem}") from None
    except (OSError, ValueError, yaml.YAMLError) as error:
        raise ConfigError(f"{path}: cannot be read as YAML: {error}") from None
    try:
        return read(kind, content)
    except ConfigError as error:
        line = _line_of(str(error).partition(":")[0], dict(_lines(tree, "")))
        raise ConfigError(f"{path}{line}: {error}") from None


def read(kind: type[Configuration], content: object, place: str = "") -> Configuration:
    """Build a configuration class from parsed YAML, refusing keys it does not have.

    Raises:
        ConfigError: Names the key, its value, and what is expected.
    """
    if not isinstance(content, Mapping):
        raise ConfigError(f"{place or 'the file'}: expected keys with values, got {content!r}")
    known = {entry.name: entry for entry in fields(cast("Any", kind))}
    for key in content:
        if key not in known:
            close = difflib.get_close_matches(str(key), known, n=1)
            hint = f"did you mean {close[0]!r}?" if close else f"expected {', '.join(known)}"
            raise ConfigError(f"{join(place, str(key))}: unknown key; {hint}")
    hints = get_type_hints(kind)
    values: dict[str, object] = {}
    for name, entry in known.items():
        if name not in content:
            if entry.default is MISSING and entry.default_factory is MISSING:
                raise ConfigError(f"{join(place, name)}: missing")
            continue
        value, inner = content[name], hints[name]
        if is_dataclass(inner):
            values[name] = read(cast("type[Any]", inner), value, join(place, name))
        elif inner == Masses and isinstance(value, dict):
            values[name] = tuple(sorted((str(key), item) for key, item in value.items()))
        else:
            values[name] = tuple(value) if isinstance(value, list) else value
    return kind(**values)


def _check_masses(name: str, value: object, limit: Limit) -> None:
    pairs = isinstance(value, tuple) and all(isinstance(pair, tuple) for pair in value)
    if not pairs or any(len(pair) != 2 for pair in cast("Masses", value)):
        raise ConfigError(f"{name}: {value!r}; expected part types with {limit.unit}")
    for type_, mass in cast("Masses", value):
        _check_number(join(name, type_), mass, limit)


def _check_tuple(name: str, value: object, size: int, limits: list[Limit]) -> None:
    """Check a tuple; several limits share its numbers among them in equal parts."""
    if not isinstance(value, tuple) or len(value) != size:
        units = " and ".join(limit.unit for limit in limits)
        raise ConfigError(f"{name}: {value!r}; expected {size} numbers, {units}")
    for index, item in enumerate(value):
        _check_number(name, item, limits[index * len(limits) // size])


def _check_number(name: str, value: object, limit: Limit, *, whole: bool = False) -> None:
    number = isinstance(value, int if whole else int | float) and not isinstance(value, bool)
    if number and limit.low <= cast("float", value) <= limit.high:  # also refuses NaN
        return
    kind = "a whole number" if whole else "a number"
    expected = f"expected {kind} from {limit.low:.6g} to {limit.high:.6g} {limit.unit}".rstrip()
    raise ConfigError(f"{name}: {value!r}; {expected}{_guess(value, limit)}")


def _guess(value: object, limit: Limit) -> str:
    """Ask whether a number was meant in another unit, if it would do in it."""
    if limit.unit not in _OTHER_UNITS or isinstance(value, bool):
        return ""
    if not isinstance(value, int | float) or not math.isfinite(value):
        return ""
    unit, factor = _OTHER_UNITS[limit.unit]
    meant = value * factor
    far_off = abs(value) >= _FAR_OFF * max(abs(limit.low), abs(limit.high))
    if not (far_off and limit.low <= meant <= limit.high):
        return ""
    return f"; did you mean {meant:.4g} {limit.unit} ({value:g} {unit})?"


def _lines(node: yaml.Node | None, place: str) -> Iterator[tuple[str, int]]:
    """Give the line, from 1, on which each key stands."""
    if not isinstance(node, yaml.MappingNode):
        return
    for key, value in node.value:
        name = join(place, str(key.value))
        yield name, key.start_mark.line + 1
        yield from _lines(value, name)


def _line_of(key: str, lines: Mapping[str, int]) -> str:
    """Give ":line" of a key, or of the nearest key above it that is in the file."""
    while key and key not in lines:
        key = key.rpartition(".")[0]
    return f":{lines[key]}" if key else ""
