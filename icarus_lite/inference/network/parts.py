"""What a generated module is connected to, and what it is told."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

from icarus_lite.inference.network.pair_stores import PairStore
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value

Known: TypeAlias = Mapping[str, Value] | None
"""The attributes of an object or belief, or None where it is not there."""

Show: TypeAlias = tuple[Callable[[Any, Any], None], Any, Any]
"""A row that is to be shown: by which function, its key and its value."""

Functions: TypeAlias = Mapping[str, Callable[..., Any]]
"""The functions of a generated module by name."""


class Move(NamedTuple):
    """Objects of one type of which some attributes have changed.

    Args:
        types: The type of the objects and its supertypes.
        names: The objects, all of them there.
        columns: For each attribute that has changed one value an object.
        plain: Whether all these values are numbers, none of them large: see `PLAIN`.
    """

    types: Sequence[str]
    names: Sequence[str]
    columns: Mapping[str, tuple[Value, ...]]
    plain: bool


@dataclass(frozen=True, slots=True)
class Parts:
    """What the generated module is connected to.

    Args:
        rows: The rows of each relation, and the indexes, by identifier.
        pairs: The pairs that kernels keep.
        names: For each percept type the names of its objects by slot.
        columns: For each type and attribute its values by slot.
        asked: The functions that evaluate tests and binds by the language's own rules.
        record: Is told of the changes of a cycle.
        stale: Which components have to be derived from scratch.
        stage: Numbers the beliefs of recursive concepts in the order of their proofs.
        tick: Looks at the clock.
        too_many: Stops a cycle that concludes too much.
        most: How many beliefs a concept may have.
        attributed: Gives what settles and loads a concept whose beliefs have attributes.
        recomputed: Gives what settles and loads a component that is derived from scratch.
    """

    rows: dict[str, dict[Any, Any]]
    pairs: dict[str, PairStore]
    names: dict[str, list[Value]]
    columns: dict[tuple[str, str], list[Value | None]]
    asked: dict[str, Callable[[tuple[Value, ...]], Any]]
    record: Callable[[Any], None]
    stale: dict[int, bool]
    stage: Iterator[int]
    tick: Callable[[int], None]
    too_many: Callable[[int], None]
    most: int
    attributed: Callable[..., tuple[Callable[[], None], Callable[[], None]]]
    recomputed: Callable[..., tuple[Callable[[], None], Callable[[], None]]]
