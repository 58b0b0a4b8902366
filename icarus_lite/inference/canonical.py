"""The canonical order of values, where one of several has to be chosen whatever the history."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.symbols import Value

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


def canonical(values: Iterable[Value]) -> tuple[tuple[Any, ...], ...]:
    """Give what rows of values are ordered by: cell by cell, numbers before symbols.

    Example:
        >>> sorted([("b", 2), ("a", 3), (10, 1), (9, 1)], key=canonical)
        [(9, 1), (10, 1), ('a', 3), ('b', 2)]
    """
    return tuple((1, value) if isinstance(value, str) else (0, value) for value in values)
