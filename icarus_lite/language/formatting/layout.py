"""The formatter's tree into lines: what stands on one line, what is broken, and where.

Only words, their order and their comments count, never how the author broke the lines; of blank
lines, one is kept where there were some.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.language.formatting.lines import Lines
from icarus_lite.language.formatting.tables import aligned_rows
from icarus_lite.language.formatting.tree import (
    Group,
    Item,
    Leaf,
    Node,
    Verbatim,
    begins_with_group,
    fields,
    flat,
)

WIDTH = 100
"""How many columns a line may fill, comments at its end left out."""

_STEP = 2
_FARTHEST_HANG = 60


def lay_out(tree: Group) -> str:
    """Write a file's tree out."""
    layout = _Layout()
    layout.file(tree)
    return layout.lines.text()


class _Layout:
    """Writes nodes one after the other.

    `tail` is how many parentheses will be closed right behind a node: they must fit as well.
    """

    def __init__(self) -> None:
        self.lines = Lines()

    def file(self, tree: Group) -> None:
        previous: Item | None = None
        for item in tree.items:
            if previous is not None:
                self.lines.newline(0, blank=self._are_apart(previous, item))
            self._item(item, 0, 0, is_form=True)
            previous = item
        self._ending(tree, 0)

    def _are_apart(self, above: Item, below: Item) -> bool:
        """Tell whether a blank line stands between two forms, as it nearly always does."""
        gaps = [*(comment.blank_before for comment in below.before), below.blank_before]
        comments_belong_above = bool(below.before) and not gaps[0] and any(gaps[1:])
        are_alike = _first_word(above) == _first_word(below) is not None
        may_touch = are_alike and self._fits_as_form(above) and self._fits_as_form(below)
        return gaps[0] if may_touch or comments_belong_above else True

    def _fits_as_form(self, item: Item) -> bool:
        node = item.node
        width = node.width
        return width is not None and width <= WIDTH and not _lists_entries(node)

    def _item(self, item: Item, column: int, tail: int, *, is_form: bool = False) -> None:
        """Write an item and its comments, beginning where the current line stands."""
        for position, comment in enumerate(item.before):
            if position:
                self.lines.newline(column, blank=comment.blank_before)
            self.lines.comment(comment.text)
        if item.before:
            self.lines.newline(column, blank=item.blank_before)
        for block in item.prefix:
            self.lines.put(f"{block} ")
        self._node(item.node, column, tail, is_form=is_form)
        for comment_text in item.after:
            self.lines.trail(comment_text)

    def _node(self, node: Node, column: int, tail: int, *, is_form: bool) -> None:
        match node:
            case Leaf():
                self.lines.put(node.text)
            case Verbatim():
                self._verbatim(node, column)
            case Group():
                if self._fits(node.width, tail) and not (is_form and _lists_entries(node)):
                    self.lines.put(flat(node))
                else:
                    self._group(node, tail + 1, is_form=is_form)

    def _fits(self, width: int | None, tail: int) -> bool:
        return width is not None and self.lines.column + width + tail <= WIDTH

    def _verbatim(self, node: Verbatim, column: int) -> None:
        self.lines.put(node.opening)
        if node.text:
            self.lines.put("\n" + node.text.removesuffix("\n"))
        if node.closing is not None:
            self.lines.newline(column)
            self.lines.put(node.closing)
        self.lines.must_break = node.ends_in_comment

    def _group(self, group: Group, tail: int, *, is_form: bool) -> None:
        """Write a list over several lines."""
        opening = self.lines.column
        inner = opening + 1
        self.lines.put("(")
        head, its_fields = fields(group.items)
        begins_with_word = bool(group.items) and isinstance(group.items[0].node, Leaf)
        if its_fields:
            inner += begins_with_word and bool(head)
            self._fields(head, its_fields, inner, tail)
        elif begins_with_word and is_form:
            inner = opening + _STEP
            self._form(group.items, inner, tail)
        elif begins_with_word:
            inner = self._call(group.items, opening, tail)
        else:
            self._stack(group.items, inner, tail)
        self._ending(group, inner)
        if self.lines.must_break:
            self.lines.newline(opening)
        self.lines.put(")")

    def _ending(self, group: Group, column: int) -> None:
        """Write the comments behind a list's last item."""
        for position, comment in enumerate(group.end):
            if position or group.items:
                self.lines.newline(column, blank=comment.blank_before)
            self.lines.comment(comment.text)

    def _stack(self, items: Sequence[Item], column: int, tail: int) -> None:
        """Write items below each other, beginning on the current line."""
        rows = aligned_rows(items, WIDTH - column - tail)
        for position, item in enumerate(items):
            if position:
                self.lines.newline(column, blank=item.is_apart)
            is_last = position == len(items) - 1
            if position in rows:
                self._row(item, rows[position])
            else:
                self._item(item, column, tail if is_last else 0)

    def _form(self, items: Sequence[Item], column: int, tail: int) -> None:
        """Write a top-level form: its words first, then its clauses below each other."""
        count = next((n for n, item in enumerate(items) if not isinstance(item.node, Leaf)), None)
        words, clauses = items[:count], items[count:] if count else ()
        self._item(words[0], column, 0)
        self._fill(words[1:], column, 0 if clauses else tail)
        if clauses:
            self.lines.newline(column)
            self._stack(clauses, column, tail)

    def _fields(
        self, head: Sequence[Item], its_fields: Sequence[Sequence[Item]], column: int, tail: int
    ) -> None:
        """Write the head on the current line and each field on a line of its own."""
        if head:
            self._item(head[0], column, 0)
            self._fill(head[1:], column, 0)
        for position, field in enumerate(its_fields):
            if position or head:
                self.lines.newline(column)
            self._item(field[0], column, 0)
            keyword = field[0].node
            width = len(keyword.text) + 1 if isinstance(keyword, Leaf) else _STEP
            is_last = position == len(its_fields) - 1
            self._fill(field[1:], column + width, tail if is_last else 0)

    def _call(self, items: Sequence[Item], opening: int, tail: int) -> int:
        """Write a pattern or expression: all that follows its first word under the second one.

        Returns:
            The column where that is.
        """
        self._item(items[0], opening + 1, 0)
        column = self.lines.column + 1
        if column > _FARTHEST_HANG or self.lines.should_break:
            column = opening + _STEP
        self._fill(items[1:], column, tail)
        return column

    def _fill(self, items: Sequence[Item], column: int, tail: int) -> None:
        """Write as many items on a line as fit, the next lines indented to a column."""
        units = _units(items)
        for position, unit in enumerate(units):
            unit_tail = tail if position == len(units) - 1 else 0
            could_start_earlier = self.lines.column + 1 > column
            if (
                self.lines.must_break
                or self.lines.should_break
                or bool(unit[0].before)
                or isinstance(unit[0].node, Verbatim)
                or (could_start_earlier and not self._fits(_unit_width(unit), unit_tail + 1))
            ):
                self.lines.newline(column)
            else:
                self.lines.put(" ")
            for place, item in enumerate(unit):
                if place:
                    self.lines.put(" ")
                self._item(item, column, unit_tail)

    def _row(self, item: Item, text: str) -> None:
        """Write an item whose text has been aligned with those around it."""
        self.lines.put(text)
        for comment in item.after:
            self.lines.trail(comment)


def _units(items: Sequence[Item]) -> list[list[Item]]:
    """Keep each attribute together with its value."""
    units: list[list[Item]] = []
    for item in items:
        has_line = bool(item.before) or isinstance(item.node, Verbatim)
        if units and len(units[-1]) == 1 and _is_marker(units[-1][0]) and not has_line:
            units[-1].append(item)
        else:
            units.append([item])
    return units


def _is_marker(item: Item) -> bool:
    return isinstance(item.node, Leaf) and item.node.text[0] == "^" and not item.after


def _unit_width(unit: Sequence[Item]) -> int | None:
    """Tell how many columns a unit takes; of a string over several lines, its first one."""
    total = len(unit) - 1
    for item in unit:
        width = item.width
        if width is None and isinstance(item.node, Leaf):
            width = len(item.node.text.partition("\n")[0])
        if width is None:
            return None
        total += width
    return total


def _lists_entries(node: Node) -> bool:
    """Tell whether a form holds clauses, or several patterns: they never share its line."""
    if not isinstance(node, Group):
        return False
    head, its_fields = fields(node.items)
    entries = [item.node for item in head if isinstance(item.node, Group)]
    return not its_fields and (len(entries) > 1 or any(map(begins_with_group, entries)))


def _first_word(item: Item) -> str | None:
    node = item.node
    if isinstance(node, Group) and node.items and isinstance(node.items[0].node, Leaf):
        return node.items[0].node.text
    return None
