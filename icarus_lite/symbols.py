"""The ground symbols that pass between perception, inference, planning and the body.

A *pattern* with variables lives in `icarus_lite.language.syntax`; everything here is ground.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

from icarus_lite.records import dataclass, field

Value = str | int | float
"""What a variable may be bound to: a symbol (or string), an integer or a float."""

ATTACHED = "attached"
"""The predicate of the attachment hierarchy: `(attached child parent)`."""

_SYMBOL = r"[^\s()\"';?:^*|#]+(?<![.])|\d+(\.\d+)+"


def format_value(value: Value) -> str:
    """Write a value as a domain file would: symbols bare, strings quoted, numbers by `repr`."""
    if isinstance(value, str):
        if _is_symbol(value) and not _reads_as_number(value):
            return value
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return repr(value)


def _is_symbol(text: str) -> bool:
    # Nearly all are letters, digits, - and _; for the others there is a pattern.
    if text.isascii() and text.replace("-", "_").isidentifier():
        return True
    import re  # noqa: PLC0415 - see above

    return re.fullmatch(_SYMBOL, text, re.ASCII) is not None


def _reads_as_number(text: str) -> bool:
    if text[0].isalpha() and text[0] not in "iInN":  # infinity and nan are numbers
        return False
    try:
        float(text)
    except ValueError:
        return False
    return True


def is_number(value: object) -> bool:
    """Tell whether a value is a finite number (booleans are not numbers here)."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


@dataclass(frozen=True, slots=True)
class Percept:
    """One object as perception reports it this cycle: type, unique name, attributes.

    Example:
        >>> Percept("object", "o1", {"type": "plug", "x": 0.31}).attributes["x"]
        0.31
    """

    type: str
    name: str
    attributes: Mapping[str, Value] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "attributes", MappingProxyType(dict(self.attributes)))

    def __str__(self) -> str:
        parts = [self.type, format_value(self.name)]
        parts += [f"^{key} {format_value(value)}" for key, value in self.attributes.items()]
        return f"({' '.join(parts)})"

    def __hash__(self) -> int:
        return hash((self.type, self.name))

    def __reduce__(self) -> tuple[object, ...]:
        return Percept, (self.type, self.name, dict(self.attributes))


@dataclass(frozen=True, slots=True)
class Belief:
    """A ground relation that is held to be true, such as `(attached hubcover case)`.

    Two beliefs are the same when predicate and positional arguments are the same; attributes
    computed by `:binds` are values of that one belief.
    """

    predicate: str
    args: tuple[Value, ...] = ()
    attributes: Mapping[str, Value] = field(default_factory=dict, compare=False)

    def __str__(self) -> str:
        return f"({' '.join([self.predicate, *map(format_value, self.args)])})"


@dataclass(frozen=True, slots=True)
class Action:
    """A ground skill instance that an agent executes, such as `(pick-up hand1 hubcover)`."""

    name: str
    args: tuple[Value, ...] = ()

    def __str__(self) -> str:
        return f"({' '.join([self.name, *map(format_value, self.args)])})"
