"""Text into the formatter's tree: which comment belongs to what, what stays as it is."""

from __future__ import annotations

import re

from icarus_lite.language.formatting.tree import (
    Comment,
    Group,
    Item,
    Leaf,
    Node,
    Verbatim,
    is_block,
    make_group,
)
from icarus_lite.language.reading.lines import MAX_DEPTH
from icarus_lite.records import dataclass, field, replace

_TOKEN = re.compile(
    r"""(?P<blank>[ \t\n\r\f\v]+)
    |(?P<open>\()
    |(?P<close>\))
    |(?P<comment>;[^\n]*|\#\|[\s\S]*?\|\#)
    |(?P<leaf>"[^"\\]*(?:\\[\s\S][^"\\]*)*"
        |(?:[^ \t\n\r\f\v()"';#]|\#(?!\|))++(?![^ \t\n\r\f\v()"';]))""",
    re.VERBOSE,
)
_OFF = re.compile(r";+[ \t]*fmt:[ \t]*off")
_ON = re.compile(r";+[ \t]*fmt:[ \t]*on")


def read_tree(text: str) -> Group | None:
    """Read a text, whatever it says, as nested lists with comments.

    Returns:
        The top-level forms, or None if parentheses, quotes or block comments do not match, words
        hold characters that no word may hold, or lists are nested more than `MAX_DEPTH` deep.
    """
    stack = [_List(text)]
    newlines = offset = 0
    while offset < len(text):
        match = _TOKEN.match(text, offset)
        if match is None:
            return None
        offset = match.end()
        match match.lastgroup:
            case "blank":
                newlines = match[0].count("\n")
                continue
            case "open":
                stack.append(_List(text, newlines))
                if len(stack) - 1 > MAX_DEPTH:
                    return None
            case "close":
                if len(stack) == 1:
                    return None
                closed = stack.pop()
                stack[-1].add(closed.group(), closed.newlines, offset)
            case "comment":
                stack[-1].comment(match[0], newlines, match.start(), offset)
            case _:
                stack[-1].add(Leaf(stack[-1].canonical(match[0])), newlines, offset)
        newlines = 0
    return stack[0].group() if len(stack) == 1 else None


@dataclass(frozen=True, slots=True)
class _Found:
    """A comment, and how many line ends precede it."""

    text: str
    newlines: int


@dataclass(frozen=True, slots=True)
class _Off:
    """A `; fmt: off` that is in force: its item in the making, where it is, and what came first."""

    item: Item
    index: int
    stop: int


@dataclass(slots=True)
class _List:
    """A list in the making."""

    text: str
    newlines: int = 0
    items: list[Item] = field(default_factory=list)
    waiting: list[_Found] = field(default_factory=list)
    off: _Off | None = None
    stop: int = 0

    def canonical(self, word: str) -> str:
        """Write the marker of an attribute as `^`; at the head of a list a star is no marker."""
        follows = self.items and not isinstance(self.items[0].node, Verbatim)
        return f"^{word[1:]}" if follows and word[0] == "*" and len(word) > 1 else word

    def comment(self, text: str, newlines: int, start: int, stop: int) -> None:
        """Take in a comment, which may switch formatting off or on."""
        begins_line = newlines > 0 or not (self.items or self.waiting)
        if self.off is None and begins_line and _OFF.fullmatch(text.rstrip()):
            node = Verbatim(text.rstrip(), "", None, ends_in_comment=True)
            self.off = _Off(self._item(node, newlines), len(self.items), stop)
        elif self.off is not None and newlines and _ON.fullmatch(text.rstrip()):
            line = self.text.rfind("\n", 0, start) + 1
            self._freeze(self.text[self.off.stop + 1 : line], text.rstrip(), ends_in_comment=True)
        else:
            self.waiting.append(_Found(_tidy(text), newlines))
        self.stop = stop

    def add(self, node: Node, newlines: int, stop: int) -> None:
        """Take in a word or list."""
        self.items.append(self._item(node, newlines))
        self.stop = stop

    def group(self) -> Group:
        """Close the list."""
        if self.off is not None and self.stop > self.off.stop:
            ends_in_comment = bool(self.waiting) and not is_block(self.waiting[-1].text)
            frozen = self.text[self.off.stop + 1 : self.stop]
            self._freeze(frozen, None, ends_in_comment=ends_in_comment)
        elif self.off is not None:
            self._freeze("", None, ends_in_comment=True)
        self._trail()
        end = [Comment(found.text, found.newlines > 1) for found in self.waiting]
        return make_group(self.items, end)

    def _freeze(self, text: str, closing: str | None, *, ends_in_comment: bool) -> None:
        """Put one item in the place of all that came since formatting was switched off."""
        assert self.off is not None
        opening = self.off.item.node
        assert isinstance(opening, Verbatim)
        node = Verbatim(opening.opening, text, closing, ends_in_comment)
        self.items[self.off.index :] = [replace(self.off.item, node=node)]
        self.waiting.clear()
        self.off = None

    def _item(self, node: Node, newlines: int) -> Item:
        """Make an item, sharing the comments that wait between it and the one before it."""
        prefix: list[str] = []
        while self.waiting and newlines == 0:
            found = self.waiting.pop()
            prefix.insert(0, found.text)
            newlines = found.newlines
        self._trail()
        before = tuple([Comment(found.text, found.newlines > 1) for found in self.waiting])
        self.waiting.clear()
        return Item(node, newlines > 1, before, tuple(prefix))

    def _trail(self) -> None:
        """Give the last item the comments on its line."""
        count = 0
        while self.items and count < len(self.waiting) and not self.waiting[count].newlines:
            count += 1
        if count:
            after = tuple([found.text for found in self.waiting[:count]])
            self.items[-1] = replace(self.items[-1], after=after)
            del self.waiting[:count]


def _tidy(comment: str) -> str:
    """Drop blanks at the end of a comment, and carriage returns at the ends of its lines."""
    if is_block(comment):
        return comment.replace("\r\n", "\n")
    return comment.rstrip(" \t\r\f\v")
