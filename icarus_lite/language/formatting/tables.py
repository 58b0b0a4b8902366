"""Clauses that say the same of different things, such as attachments, set as a table."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.language.formatting.tree import Group, Item, fields, flat, flat_item

_FEWEST_FIELDS = 2


def aligned_rows(items: Sequence[Item], width: int) -> dict[int, str]:
    """Find clauses that follow one another, fit on a line and have the same fields.

    Args:
        items: The clauses of a form, or whatever else stands below each other.
        width: The columns a row may take.

    Returns:
        The text of each such clause, its fields in columns, by its position. Tables that would be
        too wide are left out, and so are clauses of a single field.
    """
    rows: dict[int, str] = {}
    run: list[tuple[int, list[str]]] = []
    keywords: list[str] = []
    for position, item in enumerate(items):
        names, cells = _cells(item, width)
        if names != keywords or item.before or item.is_apart:
            rows |= _table(run, width)
            run, keywords = [], names
        if names:
            run.append((position, cells))
    return rows | _table(run, width)


def _cells(item: Item, width: int) -> tuple[list[str], list[str]]:
    """Give the keywords and the cells of a clause that can be a row, or nothing."""
    node = item.node
    if not isinstance(node, Group) or node.width is None or node.width > width or item.prefix:
        return [], []
    head, its_fields = fields(node.items)
    if len(its_fields) < _FEWEST_FIELDS or not head or not isinstance(head[0].node, Group):
        return [], []
    names = [flat(field[0].node) for field in its_fields]
    return names, [" ".join(map(flat_item, part)) for part in (head, *its_fields)]


def _table(run: Sequence[tuple[int, list[str]]], width: int) -> dict[int, str]:
    if len(run) < 2:
        return {}
    widths = [max(map(len, column)) for column in zip(*(cells for _, cells in run), strict=True)]
    if sum(widths) + len(widths) + 1 > width:
        return {}
    widths[-1] = 0
    return {position: f"({' '.join(map(str.ljust, cells, widths))})" for position, cells in run}
