"""Faults as data: what is to go wrong with a controller, and when.

A schedule is a list of entries such as

    - fault: protective_stop
      when: {move: 3, travel_rad: [0.1, 0.6]}

`when` counts from the moment the schedule is given: robot time (`time_s`), the way of the leading
joint (`travel_rad`), or the movej or movel that begins (`move`, counted from 1); with `move`,
`travel_rad` counts from its beginning. A list of two stands for any value between them: the seed
decides which.
"""

from __future__ import annotations

import difflib
import random
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple, TypeAlias

import yaml

from runtime.errors import ConfigError

Setting: TypeAlias = float | str
"""The value of a fault's parameter."""


class Span(NamedTuple):
    """The range of a number; `default` is None where the number must be given."""

    low: float
    high: float
    unit: str
    default: float | None
    words: str


class Choice(NamedTuple):
    """A word out of a few."""

    options: tuple[str, ...]
    default: str
    words: str


_FOR_EVER: Final = 0.0
_RELEASE: Final = Span(0, 3600, "s", _FOR_EVER, "robot time until it is undone; 0 never")

KINDS: Final[Mapping[str, Mapping[str, Span | Choice]]] = MappingProxyType(
    {
        "protective_stop": {},
        "emergency_stop": {"release_after_s": _RELEASE},
        "kill_script": {},
        "drop_rtde": {},
        "drop_dashboard": {},
        "stall": {"wall_s": Span(0.001, 600, "s", 1.0, "wall time in which nothing happens")},
        "slow": {
            "factor": Span(1, 1000, "", 3.0, "how many times slower everything runs"),
            "wall_s": Span(0, 3600, "s", _FOR_EVER, "for how long, wall time; 0 for ever"),
        },
        "refuse_remote": {"release_after_s": _RELEASE},
        "occupy_registers": {
            "range": Choice(("lower", "upper", "all"), "lower", "which input registers"),
            "release_after_s": _RELEASE,
        },
        "garbage": {
            "port": Choice(("rtde", "dashboard"), "rtde", "whose clients get it"),
            "bytes": Span(1, 65536, "", 64.0, "how many random bytes"),
        },
        "die": {},
    }
)
"""The faults there are, each with its parameters."""

_WHEN: Final[Mapping[str, Span]] = MappingProxyType(
    {
        "time_s": Span(0, 1e6, "s", None, "robot time"),
        "travel_rad": Span(0, 1e6, "rad", None, "way of the leading joint"),
        "move": Span(1, 1e6, "", None, "the movej or movel that begins"),
    }
)
_DRAWN: Final = ("time_s", "travel_rad", "move")


@dataclass(frozen=True, slots=True)
class Fault:
    """One thing that is to go wrong, with everything drawn that was left to the seed.

    Args:
        kind: One of `KINDS`.
        time_s: After which robot time, if that decides.
        travel_rad: After which way of the leading joint, if that decides.
        move: With which move, counted from 1, if that decides.
        settings: The kind's parameters, all of them.
        seed: For what the fault itself leaves to chance.
    """

    kind: str
    time_s: float | None
    travel_rad: float | None
    move: int | None
    settings: tuple[tuple[str, Setting], ...]
    seed: str

    def number(self, name: str) -> float:
        """Give a parameter that is a number."""
        value = dict(self.settings)[name]
        assert isinstance(value, float)
        return value

    def word(self, name: str) -> str:
        """Give a parameter that is a word."""
        return str(dict(self.settings)[name])

    def __str__(self) -> str:
        settings = "".join(f", {name} {value}" for name, value in self.settings)
        return f"{self.kind}{settings}"


def load_faults(path: Path, seed: int = 0) -> tuple[Fault, ...]:
    """Read a schedule from a YAML file.

    Args:
        path: The file.
        seed: Decides what the schedule leaves open.

    Raises:
        ConfigError: It cannot be read, or is no schedule; names file, entry, key and value.
    """
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from None
    except (ValueError, yaml.YAMLError) as error:
        words = " ".join(str(error).split())
        raise ConfigError(f"{path}: cannot be read as YAML: {words}") from None
    return parse_faults(content, seed, f"{path}: ")


def parse_faults(content: Any, seed: int = 0, source: str = "") -> tuple[Fault, ...]:
    """Read a schedule from parsed YAML or JSON.

    Args:
        content: A list of entries; None is an empty one.
        seed: Decides what the schedule leaves open.
        source: What to begin a refusal with.

    Raises:
        ConfigError: It is no schedule; names entry, key, value and what is allowed.
    """
    if content is None:
        return ()
    if not isinstance(content, list):
        raise ConfigError(f"{source}a schedule is a list of faults, not {content!r:.80}")
    return tuple(
        _fault(entry, f"{seed}:{index}", f"{source}entry {index}")
        for index, entry in enumerate(content, 1)
    )


def _fault(entry: Any, seed: str, place: str) -> Fault:
    if not isinstance(entry, dict):
        raise ConfigError(f"{place}: expected a fault with its keys, got {entry!r:.80}")
    if "fault" not in entry:
        raise ConfigError(f"{place}: fault: missing; one of {', '.join(KINDS)}")
    kind = entry["fault"]
    if not isinstance(kind, str) or kind not in KINDS:
        raise ConfigError(f"{place}: fault: {kind!r:.80}; {_meant(str(kind), KINDS)}")
    known = KINDS[kind]
    for key in entry:
        if key not in ("fault", "when", *known):
            keys = {"when": None, **known}
            raise ConfigError(f"{place}: {key}: unknown for {kind}; {_meant(str(key), keys)}")
    time_s, travel_rad, move = _when(entry.get("when"), _chance(f"when:{seed}"), place)
    settings = tuple(
        (name, _setting(entry.get(name), allowed, f"{place}: {name}"))
        for name, allowed in known.items()
    )
    return Fault(
        kind, time_s, travel_rad, None if move is None else int(move), settings, f"what:{seed}"
    )


def _chance(seed: str) -> random.Random:
    return random.Random(seed)  # noqa: S311 - a test's chance, not a secret


def _when(given: Any, chance: random.Random, place: str) -> list[float | None]:
    if not isinstance(given, dict) or not given:
        raise ConfigError(
            f"{place}: when: {given!r:.80}; expected time_s, travel_rad or move, "
            "such as {time_s: 2.5}"
        )
    for key in given:
        if key not in _WHEN:
            raise ConfigError(f"{place}: when.{key}: unknown; {_meant(str(key), _WHEN)}")
    if "time_s" in given and len(given) > 1:
        raise ConfigError(f"{place}: when: time_s stands alone; only travel_rad goes with move")
    return [
        _drawn(given[key], _WHEN[key], chance, f"{place}: when.{key}") if key in given else None
        for key in _DRAWN
    ]


def _drawn(given: Any, span: Span, chance: random.Random, place: str) -> float:
    whole = span is _WHEN["move"]
    if not isinstance(given, list):
        return _number(given, span, place, whole=whole)
    if len(given) != 2:
        raise ConfigError(f"{place}: {given!r:.80}; expected a number, or a list of least and most")
    least, most = (_number(value, span, place, whole=whole) for value in given)
    if least > most:
        raise ConfigError(f"{place}: {given!r:.80}; the least stands before the most")
    return chance.randint(int(least), int(most)) if whole else chance.uniform(least, most)


def _setting(given: Any, allowed: Span | Choice, place: str) -> Setting:
    if isinstance(allowed, Choice):
        if given is None:
            return allowed.default
        if given not in allowed.options:
            raise ConfigError(f"{place}: {given!r:.80}; one of {', '.join(allowed.options)}")
        return str(given)
    if given is None and allowed.default is not None:
        return allowed.default
    return _number(given, allowed, place, whole=False)


def _number(given: Any, span: Span, place: str, *, whole: bool) -> float:
    proper = isinstance(given, int if whole else int | float) and not isinstance(given, bool)
    if proper and span.low <= given <= span.high:  # not a number is refused too
        return float(given)
    kind = "a whole number" if whole else "a number"
    expected = f"expected {kind} from {span.low:g} to {span.high:g} {span.unit}".rstrip()
    raise ConfigError(f"{place}: {given!r:.80}; {expected}")


def _meant(word: str, known: Mapping[str, object]) -> str:
    close = difflib.get_close_matches(word, known, n=1)
    return f"did you mean {close[0]}?" if close else f"one of {', '.join(known)}"
