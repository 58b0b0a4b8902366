"""Where a parenthesis was probably forgotten, or is one too many.

A text whose parentheses do not match is mended one parenthesis at a time. Places where the lines
begin to be at odds with the parentheses, and the place where the parser stumbles, are tried; the
edit that leaves the fewest lines at odds and lets the parser through is taken.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Sequence
from enum import Enum, auto

from icarus_lite.language.reading.indentation import Oddity, Token, oddities, tokens
from icarus_lite.records import dataclass, replace

MAX_EDITS = 12
"""How many parentheses are mended in one form; a text with more is no domain."""

_MOST_ODDITIES = 8
_BLANKS = " \t"

Parse = Callable[[str], int | None]
"""Gives the offset at which the parser stumbles over a text, or None if it takes it all."""


class EditKind(Enum):
    """What is done to a text."""

    ADD_CLOSING = auto()
    REMOVE_CLOSING = auto()
    ADD_OPENING = auto()
    REMOVE_OPENING = auto()


@dataclass(frozen=True, slots=True)
class Edit:
    """One parenthesis added or taken away.

    Args:
        kind: What is done.
        offset: Where, in the text as it is after all edits.
        replaces: Whether it takes the place of another character, so that nothing moves.
    """

    kind: EditKind
    offset: int
    replaces: bool

    @property
    def is_closing(self) -> bool:
        """Whether it is about a closing parenthesis."""
        return self.kind in (EditKind.ADD_CLOSING, EditKind.REMOVE_CLOSING)


@dataclass(frozen=True, slots=True)
class Mending:
    """A text whose parentheses match.

    Args:
        text: The text.
        edits: What was done to it, in the order of the text.
        stumble: Where the parser still stumbles, or None if it takes the text.
    """

    text: str
    edits: tuple[Edit, ...]
    stumble: int | None


def _balance(words: Sequence[Token]) -> tuple[list[Token], list[Token]]:
    """Give the opening parentheses never closed, and the closing ones that close nothing."""
    stack: list[Token] = []
    strays: list[Token] = []
    for token in words:
        if token.text == "(":
            stack.append(token)
        elif token.text == ")" and stack:
            stack.pop()
        elif token.text == ")":
            strays.append(token)
    return stack, strays


def _moved(earlier: Edit, later: Edit) -> Edit:
    """Give an edit at its place after another one has been made."""
    moves = not later.replaces and later.offset <= earlier.offset
    return replace(earlier, offset=earlier.offset + 1) if moves else earlier


@dataclass(slots=True)
class Mender:
    """Mends one stretch of text after the other, with an eye on how much work it is in all.

    Args:
        parse: Tries a text.
        characters: How many characters may be parsed, over all stretches.
        walked: How many words may be looked at.
    """

    parse: Parse
    characters: int = 100_000
    walked: int = 150_000

    def mend(self, text: str) -> Mending | None:
        """Mend a stretch of text, such as a form with what follows up to the next one.

        Returns:
            The mended text, or None if it would take more than `MAX_EDITS`.
        """
        edits: list[Edit] = []
        stumble: int | None = None
        while True:
            words = tokens(text)
            surplus, strays = _balance(words)
            if not surplus and not strays:
                return Mending(text, tuple(sorted(edits, key=lambda each: each.offset)), stumble)
            if len(edits) == MAX_EDITS:
                return None
            if not edits:
                stumble = self._stumble(text)
            wants_closing = bool(surplus) and not (strays and strays[0].offset < surplus[0].offset)
            text, edit, stumble = self._step(text, words, stumble, strays, adds=wants_closing)
            edits = [*(_moved(each, edit) for each in edits), edit]

    def _stumble(self, text: str) -> int | None:
        """Parse a text as long as there is time for it; otherwise it is taken to be at fault."""
        if self.characters < len(text):
            return 0
        self.characters -= len(text)
        return self.parse(text)

    def _step(
        self,
        text: str,
        words: Sequence[Token],
        stumble: int | None,
        strays: Sequence[Token],
        *,
        adds: bool,
    ) -> tuple[str, Edit, int | None]:
        """Make the one edit that helps most; give the text, the edit and the parser's stumble."""
        wrong = sum(map(len, _balance(words)))
        odd = list(itertools.islice(oddities(words), _MOST_ODDITIES))
        place = len(text) if stumble is None else stumble
        at = next((i for i, each in enumerate(words) if each.offset >= place), len(words))
        if adds:
            candidates = _for_unclosed(text, words, odd, at)
        else:
            candidates = _for_strays(text, words, odd, at, strays)
        rated: list[tuple[int, bool, int, Edit, str]] = []
        for edit in dict.fromkeys(candidates):
            if rated and self.walked < len(words):
                break
            edited = _applied(text, edit)
            self.walked -= len(words)
            after = tokens(edited)
            if sum(map(len, _balance(after))) < wrong:
                weight = sum(each.weight for each in oddities(after))
                rated.append((weight, not edit.is_closing, len(rated), edit, edited))
        rated.sort(key=lambda each: each[:3])
        furthest = -1
        for weight, is_opening, _, edit, edited in rated:
            # An edit behind the place where the parser stumbles does not get it past that.
            is_behind = stumble is not None and edit.offset > stumble
            stop = stumble if is_behind else self._stumble(edited)
            if stop is None:
                return edited, edit, None
            # With more to be mended, how far the parser gets says little of the unlikelier kind.
            is_as_good = weight == rated[0][0] and (is_opening == rated[0][1] or wrong == 1)
            if furthest < 0 or (stop > furthest and is_as_good):
                furthest, best = stop, (edited, edit)
        return *best, furthest


def _applied(text: str, edit: Edit) -> str:
    """Make an edit."""
    mark = {EditKind.ADD_CLOSING: ")", EditKind.ADD_OPENING: "("}.get(edit.kind, " ")
    return text[: edit.offset] + mark + text[edit.offset + edit.replaces :]


def _for_unclosed(
    text: str, words: Sequence[Token], odd: Sequence[Oddity], at: int
) -> Iterator[Edit]:
    """Propose places for a closing parenthesis, and opening ones that may be too many."""
    lines = [each.before for each in odd]
    if at < len(words):
        if not words[at].is_first:
            yield _closing_before(text, words[at])
        lines.append(max(at - 1, 0))
    for position in lines:
        yield _closing_behind(text, words[position])
    # Behind the lines themselves as well: a line may be at odds before something is missing in it.
    for position in [*lines, len(words) - 1]:
        yield _closing_behind(text, _last_of_line(words, position))
    for token in words[max(at - 1, 0) : at + 1]:
        if token.text == "(":
            yield Edit(EditKind.REMOVE_OPENING, token.offset, replaces=True)


def _last_of_line(words: Sequence[Token], position: int) -> Token:
    line = words[position].line
    while position + 1 < len(words) and words[position + 1].line == line:
        position += 1
    return words[position]


def _closing_before(text: str, token: Token) -> Edit:
    is_blank = token.offset > 0 and text[token.offset - 1] in _BLANKS
    return Edit(EditKind.ADD_CLOSING, token.offset - is_blank, replaces=is_blank)


def _closing_behind(text: str, token: Token) -> Edit:
    is_blank = token.stop < len(text) and text[token.stop] in _BLANKS
    return Edit(EditKind.ADD_CLOSING, token.stop, replaces=is_blank)


def _for_strays(
    text: str, words: Sequence[Token], odd: Sequence[Oddity], at: int, strays: Sequence[Token]
) -> Iterator[Edit]:
    """Propose closing parentheses that may be too many, and places for an opening one."""
    places = [each.before for each in odd]
    if at < len(words):
        places.append(at)
    for position in places:
        closing = next((t for t in words[position::-1] if t.text == ")"), None)
        if closing is not None:
            yield Edit(EditKind.REMOVE_CLOSING, closing.offset, replaces=True)
    yield Edit(EditKind.REMOVE_CLOSING, strays[0].offset, replaces=True)
    if at < len(words):
        token = words[at]
        # At the start of a line it takes a column of its own, under those of its neighbours.
        is_blank = not token.is_first and text[token.offset - 1] in _BLANKS
        yield Edit(EditKind.ADD_OPENING, token.offset - is_blank, replaces=is_blank)
