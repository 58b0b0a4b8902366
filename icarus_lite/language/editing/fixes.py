"""What an editor can do about a finding at once: the hint, carried out."""

from __future__ import annotations

import re
from collections.abc import Iterator

from icarus_lite.language.diagnostics import Diagnostic
from icarus_lite.language.editing.lexemes import lexemes
from icarus_lite.language.editing.nesting import Group, nest
from icarus_lite.language.editing.occurrences import Role, occurrences
from icarus_lite.language.reading.indentation import tokens
from icarus_lite.language.reading.lines import Lines
from icarus_lite.records import dataclass

_MEANT = re.compile(r"did you mean (?:`([^`]+)`|(\?[^ ?]+))\?")
_QUOTED = re.compile(r"`([^`]+)`")
_ADD_AT_END = re.compile(r'add "(\)+)" at the end of line (\d+)\Z')
_ADD_BEFORE = re.compile(r'add "(\)+)" before `([^`]+)` in line (\d+)\Z')
_WORD = re.compile(r"[^ \t\n\r\f\v()\"';]+\Z")
_WORD_END = r"(?=[ \t\n\r\f\v()\"';]|\Z)"


@dataclass(frozen=True, slots=True)
class Replacement:
    """A stretch of text and what to write instead."""

    start: int
    stop: int
    text: str


@dataclass(frozen=True, slots=True)
class Fix:
    """Something to do about a finding.

    Args:
        title: What it does, in a few words.
        replacements: The stretches to replace; they do not overlap.
        is_sure: Whether it is what nearly everybody would do.
    """

    title: str
    replacements: tuple[Replacement, ...]
    is_sure: bool = True


def fixes(text: str, found: Diagnostic) -> tuple[Fix, ...]:
    """Say what can be done about a finding without knowing what its author had in mind.

    Args:
        text: The text that the finding is about.
        found: The finding.
    """
    span = found.span
    if not span.line:
        return ()
    lines = Lines(text)
    start = lines.offset(span.line, span.column)
    stop = lines.offset(span.end_line, span.end_column)
    return (
        *_meant(text, found, start, stop),
        *_parenthesis(text, found, start),
        *_by_code(text, found, start, stop),
    )


def _meant(text: str, found: Diagnostic, start: int, stop: int) -> Iterator[Fix]:
    """Write what was probably meant."""
    match = _MEANT.search(found.hint)
    if match is None:
        return
    name = match[1] or match[2]
    place = _misspelt(text, found.message, start, stop)
    if place is not None:
        yield Fix(f"Write `{name}`", (Replacement(*place, name),))


def _misspelt(text: str, message: str, start: int, stop: int) -> tuple[int, int] | None:
    """Find the word that a finding is about, if it is one word only."""
    if _WORD.match(text, start, stop):
        return start, stop
    for match in _QUOTED.finditer(message):
        word = re.escape(match[1])
        places = list(re.finditer(rf"(?<![^ (]){word}{_WORD_END}", text[start:stop]))
        if len(places) == 1 and not text[start:stop].startswith(f"({match[1]}"):
            return start + places[0].start(), start + places[0].end()
    return None


def _parenthesis(text: str, found: Diagnostic, start: int) -> Iterator[Fix]:
    """Add or remove a parenthesis where the hint says so."""
    match = _ADD_AT_END.match(found.hint)
    if match:
        last = [each for each in tokens(text) if each.line + 1 == int(match[2])][-1:]
        yield from (
            Fix(f"Add {match[1]} at the end of line {match[2]}", (_insertion(each.stop, match[1]),))
            for each in last
        )
    match = _ADD_BEFORE.match(found.hint)
    if match:
        words = [each for each in tokens(text) if each.line + 1 == int(match[3])]
        places = [each for each in words if each.text == match[2] and each.offset > start]
        if len(places) == 1:
            at = len(text[: places[0].offset].rstrip(" \t"))
            yield Fix(f"Add {match[1]} before {match[2]}", (_insertion(at, match[1]),))
    if found.code in ("ICR002", "ICR003") and found.hint.startswith("remove it"):
        what = text[start : start + 1]
        if what in ("(", ")"):
            yield Fix(f"Remove {what}", (Replacement(start, start + 1, ""),))
    if found.message.startswith('a "(" is missing before'):
        yield Fix("Add (", (_insertion(start, "("),))


def _insertion(offset: int, text: str) -> Replacement:
    return Replacement(offset, offset, text)


def _by_code(text: str, found: Diagnostic, start: int, stop: int) -> Iterator[Fix]:
    match found.code:
        case "ICR026":
            yield Fix("Write it with a star", (_insertion(start + 1, "*"),))
        case "ICR028":
            yield from _modernized(text, start)
        case "ICR029" | "ICR030":
            yield from _anonymous(text, start)
        case "ICR009" if text[start:stop] == "'":
            yield Fix("Remove the quote", (Replacement(start, stop, ""),))


def _modernized(text: str, offset: int) -> Iterator[Fix]:
    """Write the form around an older spelling, or the whole file, as it is written today."""
    # The formatter is needed for little else in an editor.
    from icarus_lite.language.formatting.formatter import format_text  # noqa: PLC0415

    forms = [node for node in nest(text, lexemes(text)) if isinstance(node, Group)]
    for form in forms:
        if form.start <= offset < form.stop:
            old = text[form.start : form.stop]
            new = format_text(old, modernize=True).rstrip("\n")
            if new != old:
                replacement = Replacement(form.start, form.stop, new)
                yield Fix("Write this form as it is written today", (replacement,))
    new = format_text(text, modernize=True)
    if new != text:
        whole = (Replacement(0, len(text), new),)
        yield Fix("Write the whole file as it is written today", whole, is_sure=False)


def _anonymous(text: str, offset: int) -> Iterator[Fix]:
    """Say by its name that any value of a variable will do."""
    words = occurrences(text)
    here = next((each for each in words if each.start == offset), None)
    if here is None or here.role is not Role.VARIABLE:
        return
    name = f"?_{here.name.lstrip('?')}"
    same = [
        each
        for each in words
        if each.role is Role.VARIABLE and each.place.scope == here.place.scope
    ]
    if name not in [each.name for each in same]:
        replacements = [
            Replacement(each.start, each.stop, name) for each in same if each.name == here.name
        ]
        yield Fix(f"Call it {name}: any value will do", tuple(replacements), is_sure=False)
