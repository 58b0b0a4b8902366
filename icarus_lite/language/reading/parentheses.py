"""What is said of a text whose parentheses do not match, and the text as it was probably meant.

The mended text is read on, so that one parenthesis does not hide whatever else is wrong.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from icarus_lite.language.diagnostics import Diagnostic, Severity
from icarus_lite.language.reading.brackets import FORM_NAMES
from icarus_lite.language.reading.indentation import Token, tokens
from icarus_lite.language.reading.lines import Lines
from icarus_lite.language.reading.mending import Edit, EditKind, Mender, Mending, Parse
from icarus_lite.language.reading.stumbles import shortened
from icarus_lite.language.syntax import Span
from icarus_lite.records import dataclass, replace

# A form at the margin begins anew even where its own parenthesis is doubled or forgotten.
_FORM_AT_MARGIN = re.compile(
    rf"(?<![^\n])\(*(?:{'|'.join(FORM_NAMES)})(?=[ \t\n\r\f\v()\"';])"
    r'|;[^\n]*|#\|[\s\S]*?\|#|"[^"\\]*(?:\\[\s\S][^"\\]*)*"'
)
_WITH_CLAUSES = frozenset(
    {"concepts", "skills", "attachments", "contradictions", "create-concepts", "create-skills"}
)
_NAMED = frozenset({"test", "task", "long-term-goal"})
_OF_CLAUSE = 2


@dataclass(frozen=True, slots=True)
class Mended:
    """A text whose parentheses match, and what was wrong with them.

    Args:
        text: The text; every word stands in the line and, but for a few, the column that it had.
        problems: What was wrong, in the order of the text.
        lines: The lines in which it was mended: what else is wrong there may come of it.
    """

    text: str
    problems: tuple[Diagnostic, ...]
    lines: frozenset[int]


def mend_parentheses(text: str, path: str, parse: Parse) -> Mended | None:
    """Mend the parentheses of a text, form by form.

    Args:
        text: The text; its strings and comments are closed.
        path: What to call it in messages.
        parse: Gives the offset in a text at which the parser stumbles, or None.

    Returns:
        The mended text; None if nothing has to be mended, or too much.
    """
    pieces: list[str] = []
    problems: list[Diagnostic] = []
    lines: set[int] = set()
    mender = Mender(parse)
    line = 0
    for region in _regions(text):
        mending = mender.mend(region)
        if mending is None:
            return None
        if mending.edits:
            problems += _problems(mending, region, path, line)
        lines |= {line + 1 + mending.text.count("\n", 0, e.offset) for e in mending.edits}
        pieces.append(mending.text)
        line += region.count("\n")
    if not problems:
        return None
    return Mended("".join(pieces), tuple(problems), frozenset(lines))


def _regions(text: str) -> Iterator[str]:
    """Cut a text where forms begin at the margin."""
    start = 0
    for match in _FORM_AT_MARGIN.finditer(text):
        if match[0][0] not in ';#"' and match.start() > start:
            yield text[start : match.start()]
            start = match.start()
    yield text[start:]


def _problems(mending: Mending, region: str, path: str, above: int) -> Iterator[Diagnostic]:
    words = tokens(mending.text)
    places = _Places(Lines(region), above, mending.edits)
    for edits in _together(mending.edits):
        yield _Account(words, places, path, edits).problem()


@dataclass(frozen=True, slots=True)
class _Places:
    """Turns places in a mended stretch into those in the file as it is."""

    lines: Lines
    above: int
    edits: tuple[Edit, ...]

    def span(self, start: int, length: int) -> Span:
        """Give the place of a word of the mended stretch."""
        added = sum(1 for each in self.edits if not each.replaces and each.offset < start)
        found = self.lines.span(start - added, start - added + length)
        line, end_line = found.line + self.above, found.end_line + self.above
        return replace(found, line=line, end_line=end_line)


def _together(edits: Sequence[Edit]) -> Iterator[tuple[Edit, ...]]:
    """Group closing parentheses that are added in a row."""
    group: list[Edit] = []
    for edit in edits:
        if group and not (
            edit.kind is group[-1].kind is EditKind.ADD_CLOSING
            and edit.offset == group[-1].offset + 1
        ):
            yield tuple(group)
            group = []
        group.append(edit)
    if group:
        yield tuple(group)


@dataclass(frozen=True, slots=True)
class _Account:
    """Edits at one place of a mended form, to be put into words."""

    words: Sequence[Token]
    places: _Places
    path: str
    edits: tuple[Edit, ...]

    def problem(self) -> Diagnostic:
        """Say what was wrong at the place."""
        kind, offset = self.edits[0].kind, self.edits[0].offset
        stack = self._open_at(offset)
        after = next((t for t in self.words if t.offset > self.edits[-1].offset), None)
        code, length = "ICR003", 1
        match kind:
            case EditKind.ADD_CLOSING if stack:
                code, opening = "ICR002", stack[-min(len(self.edits), len(stack))]
                place = opening.offset
                message = f"{self._named(opening, stack)} is never closed"
                hint = f'add "{")" * len(self.edits)}" {self._where(offset, after)}'
            case EditKind.REMOVE_CLOSING if stack:
                place = offset
                what = self._named(stack[-1], stack)
                message = f'this ")" is one too many: it closes {what} too early'
                hint = "remove it: what follows still belongs inside"
            case EditKind.REMOVE_CLOSING:
                place, message, hint = offset, 'this ")" closes nothing', "remove it"
            case EditKind.REMOVE_OPENING:
                code, place = "ICR002", offset
                message, hint = 'this "(" is one too many', "remove it"
            case _:  # EditKind.ADD_OPENING
                word = after.text if after else ""
                place = after.offset if after else offset
                length = max(len(word), 1)
                message = f'a "(" is missing before {_quoted(word)}'
                hint = f"write ({shortened(word)}" if word not in ("", "(") else 'write "("'
        span = self.places.span(place, length)
        return Diagnostic(self.path, span, Severity.ERROR, code, message, hint)

    def _open_at(self, offset: int) -> list[Token]:
        stack: list[Token] = []
        for token in self.words:
            if token.offset >= offset:
                break
            if token.text == "(":
                stack.append(token)
            elif token.text == ")" and stack:
                stack.pop()
        return stack

    def _named(self, opening: Token, stack: Sequence[Token]) -> str:
        """Say what a parenthesis opens: a form, a clause, or something inside one."""
        form = self._first_word(stack[0])
        if opening is stack[0]:
            return f"the form {_quoted(form)}" if form else 'this "("'
        if form in _WITH_CLAUSES and len(stack) >= _OF_CLAUSE:
            clause = f"the clause of {_quoted(self._head(stack[1]))}"
            return clause if opening is stack[1] else f'this "(" in {clause}'
        if form in _NAMED:
            name = self._next(self._next(stack[0]))
            title = name.text.strip('"') if name else ""
            return f'this "(" in the {form} {_quoted(title)}'
        return f'this "(" in the form {_quoted(form)}'

    def _head(self, clause: Token) -> str:
        head = self._next(clause)
        return self._first_word(head) if head and head.text == "(" else ""

    def _first_word(self, opening: Token) -> str:
        word = self._next(opening)
        return word.text if word and word.text not in ("(", ")") else ""

    def _next(self, token: Token | None) -> Token | None:
        if token is None:
            return None
        return next((each for each in self.words if each.offset > token.offset), None)

    def _where(self, offset: int, after: Token | None) -> str:
        line = self.places.span(offset, 1).line
        if after is not None and self.places.span(after.offset, 1).line == line:
            return f"before {_quoted(after.text)} in line {line}"
        return f"at the end of line {line}"


def _quoted(word: str) -> str:
    word = shortened(word)
    return f'"{word}"' if word in ("(", ")") else f"`{word}`"
