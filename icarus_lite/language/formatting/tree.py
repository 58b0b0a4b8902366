"""The concrete tree that the formatter works on: words, parentheses, and where comments belong."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeAlias

from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment on a line of its own; `blank_before` tells whether a blank line precedes it."""

    text: str
    blank_before: bool


@dataclass(frozen=True, slots=True)
class Leaf:
    """A word, number or string, as it is written."""

    text: str

    @property
    def width(self) -> int | None:
        """How many columns it takes, or None if it is a string over several lines."""
        return None if "\n" in self.text else len(self.text)


@dataclass(frozen=True, slots=True)
class Verbatim:
    """What stands between `; fmt: off` and `; fmt: on`.

    Args:
        opening: The comment that begins it.
        text: The lines in between.
        closing: The comment that ends it, or None if it runs to the end of its list or file.
        ends_in_comment: Whether nothing may follow it on its last line.
    """

    opening: str
    text: str
    closing: str | None
    ends_in_comment: bool

    @property
    def width(self) -> None:
        """It never shares a line."""
        return


@dataclass(frozen=True, slots=True)
class Group:
    """A list in parentheses, or a whole file, which has none.

    Args:
        items: What stands in it.
        end: Comments on lines of their own behind the last item.
        width: How many columns it takes on one line, or None if it cannot stand on one.
    """

    items: tuple[Item, ...]
    end: tuple[Comment, ...]
    width: int | None


Node: TypeAlias = Leaf | Group | Verbatim


@dataclass(frozen=True, slots=True)
class Item:
    """An entry of a list with the comments that belong to it.

    Args:
        node: The entry.
        blank_before: Whether a blank line separates it from what precedes it, comments included.
        before: Comments on the lines above it.
        prefix: Block comments on its line, in front of it.
        after: Comments on its line, behind it; nothing else follows on that line.
    """

    node: Node
    blank_before: bool = False
    before: tuple[Comment, ...] = ()
    prefix: tuple[str, ...] = ()
    after: tuple[str, ...] = ()

    @property
    def width(self) -> int | None:
        """How many columns it takes on one line, or None; what comes behind it is not counted."""
        width = self.node.width
        if width is None or self.before or any("\n" in block for block in self.prefix):
            return None
        return width + sum(len(block) + 1 for block in self.prefix)

    @property
    def is_keyword(self) -> bool:
        """Whether it names a field, as `:elements` does."""
        return isinstance(self.node, Leaf) and self.node.text[0] == ":"

    @property
    def is_apart(self) -> bool:
        """Whether a blank line comes before it and its comments."""
        return self.before[0].blank_before if self.before else self.blank_before


def make_group(items: Sequence[Item], end: Sequence[Comment] = ()) -> Group:
    """Make a list and find out whether it can stand on one line."""
    return Group(tuple(items), tuple(end), None if end else _width(items))


def _width(items: Sequence[Item]) -> int | None:
    if _is_always_spread(items):
        return None
    total = 2
    for position, item in enumerate(items, start=1):
        width = item.width
        if width is None:
            return None
        total += width + (position > 1)
        if item.after:
            if position < len(items) or not all(map(_is_short_block, item.after)):
                return None
            total += sum(len(block) + 1 for block in item.after)
    return total


def _is_always_spread(items: Sequence[Item]) -> bool:
    """Tell what has its fields on lines of their own even where they would fit on one.

    Clauses with several lists, which ICARUS has always been printed like that, and the cycles of a
    test, which have no head to begin with.
    """
    head, its_fields = fields(items)
    lists = sum(_is_list_of_literals(field) for field in its_fields)
    return lists > 1 or (not head and len(its_fields) > 1)


def _is_short_block(comment: str) -> bool:
    return is_block(comment) and "\n" not in comment


def is_block(comment: str) -> bool:
    """Tell a block comment, after which the line may go on, from one that ends its line."""
    return comment.startswith("#|")


def fields(items: Iterable[Item]) -> tuple[list[Item], list[list[Item]]]:
    """Split a list's items into its head and its fields, each a keyword with its values."""
    head: list[Item] = []
    found: list[list[Item]] = []
    for item in items:
        if item.is_keyword or (found and isinstance(item.node, Verbatim)):
            found.append([item])
        else:
            (found[-1] if found else head).append(item)
    return head, found


def begins_with_group(node: Node) -> bool:
    """Tell whether a node is a list whose first item is a list, as clauses are."""
    return isinstance(node, Group) and bool(node.items) and isinstance(node.items[0].node, Group)


def _is_list_of_literals(field: list[Item]) -> bool:
    return any(begins_with_group(value.node) for value in field[1:])


def flat(node: Node) -> str:
    """Write a node that has a width on one line."""
    if isinstance(node, Leaf):
        return node.text
    assert isinstance(node, Group)
    return f"({' '.join([flat_item(item) for item in node.items])})"


def flat_item(item: Item) -> str:
    """Write an item that has a width, with its block comments, on one line."""
    if not item.prefix and not item.after:
        return flat(item.node)
    return " ".join((*item.prefix, flat(item.node), *item.after))
