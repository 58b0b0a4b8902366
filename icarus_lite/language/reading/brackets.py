"""Which parenthesis belongs to which: what can be said about a text before it is parsed.

The scan finds unclosed and stray parentheses, unclosed strings and comments, and nesting that is
too deep, and it cuts the text into its top-level forms, so that one broken form does not hide the
mistakes in the others.
"""

from __future__ import annotations

import re

from icarus_lite.language.reading.lines import MAX_DEPTH
from icarus_lite.records import dataclass

MODERN_FORMS = (
    "domain",
    "include",
    "percepts",
    "concepts",
    "skills",
    "attachments",
    "contradictions",
    "agents",
    "task",
    "goals",
    "long-term-goal",
    "break",
    "test",
)
"""The first words of the top-level forms, in the order in which a file has them."""

FORM_NAMES = (
    *MODERN_FORMS,
    "create-concepts",
    "create-skills",
    "create-goals",
    "create-problems",
)
"""The same with the older ones, which still load, at the end."""

# Kept as text: who reads PDDL needs none of them, and `re` keeps what it has compiled.
_MARKS = r'[()]|"[^"\\]*(?:\\[\s\S][^"\\]*)*"|;[^\n]*|#\|[\s\S]*?\|#|"|#\|'
_FORM_AT_MARGIN = rf"(?<![^\n])\((?:{'|'.join(FORM_NAMES)})(?=[ \t\n\r\f\v()\"';])"
_FIRST_WORD = r"[^ \t\n\r\f\v()\"';]+"
# Possessive, for a row of semicolons could be cut into comments in exponentially many ways.
_NAMELESS = r"(?:[ \t\n\r\f\v]|;[^\n]*+|(?>#\|[\s\S]*?\|#))*+\(\s*\("


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of the text that begins with a top-level form, or that lies between forms.

    Args:
        start: The offset of its first character.
        stop: The offset behind its last one.
        unclosed: Offsets of the parentheses opened in it and never closed, outermost first.
        too_deep: The offset of the first parenthesis that is nested too deeply, or None.
    """

    start: int
    stop: int
    unclosed: tuple[int, ...] = ()
    too_deep: int | None = None


@dataclass(frozen=True, slots=True)
class Scan:
    """What a text's parentheses, quotes and comments look like.

    Args:
        segments: The forms, in order.
        strays: Offsets of closing parentheses that close nothing.
        unclosed_quote: The offset of a quote or `#|` that is never closed, or None. The scan
            ends there.
    """

    segments: tuple[Segment, ...]
    strays: tuple[int, ...]
    unclosed_quote: int | None

    @property
    def is_sound(self) -> bool:
        """Whether the text may be parsed as it is."""
        return (
            not self.strays
            and self.unclosed_quote is None
            and not any(s.unclosed or s.too_deep is not None for s in self.segments)
        )


def scan(text: str) -> Scan:
    """Match the parentheses of a text and cut it into forms.

    Only when one is left open at the end does layout count: a known form that begins a line then
    also begins anew, because a forgotten ")" would otherwise swallow the rest of the file.
    """
    result = _scan(text, margins=frozenset())
    if result.segments and result.segments[-1].unclosed:
        margins = frozenset(match.start() for match in re.finditer(_FORM_AT_MARGIN, text))
        result = _scan(text, margins)
    return result


def _scan(text: str, margins: frozenset[int]) -> Scan:
    segments: list[Segment] = []
    strays: list[int] = []
    unclosed_quote: int | None = None
    stack: list[int] = []
    start = 0
    too_deep: int | None = None
    for match in re.finditer(_MARKS, text):
        mark, offset = match[0], match.start()
        if mark == "(":
            if offset in margins and stack:
                segments.append(Segment(start, offset, tuple(stack), too_deep))
                stack, start, too_deep = [], offset, None
            if len(stack) == MAX_DEPTH and too_deep is None:
                too_deep = offset
            stack.append(offset)
        elif mark == ")":
            if not stack:
                segments.append(Segment(start, offset))
                strays.append(offset)
                start = offset + 1
                continue
            stack.pop()
            if not stack:
                segments.append(Segment(start, offset + 1, (), too_deep))
                start, too_deep = offset + 1, None
        elif mark in ('"', "#|"):
            unclosed_quote = offset
            break
    end = len(text) if unclosed_quote is None else unclosed_quote
    # Parentheses before an unclosed quote may be closed inside it: only the quote is at fault.
    open_at_end = tuple(stack) if unclosed_quote is None else ()
    if unclosed_quote is None or not stack:
        segments.append(Segment(start, end, open_at_end, too_deep))
    return Scan(tuple(segments), tuple(strays), unclosed_quote)


def innermost_open(text: str, start: int, stop: int) -> int | None:
    """Give the offset of the innermost parenthesis open at `stop`, or None at top level."""
    stack: list[int] = []
    for match in re.compile(_MARKS).finditer(text, start, stop):
        if match[0] == "(":
            stack.append(match.start())
        elif match[0] == ")" and stack:
            stack.pop()
    return stack[-1] if stack else None


def first_word(text: str, opening: int) -> str:
    """Give the word that follows an opening parenthesis, or an empty text."""
    after = opening + 1
    while after < len(text) and text[after] in " \t\n\r\f\v":
        after += 1
    match = re.compile(_FIRST_WORD).match(text, after)
    return match[0] if match else ""


def begins_nameless(text: str, segment: Segment) -> bool:
    """Tell whether a segment begins with `((`, as no form does."""
    return re.compile(_NAMELESS).match(text, segment.start, segment.stop) is not None
