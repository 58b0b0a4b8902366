"""Collecting diagnostics about one source, and finding the exact words they are about."""

from __future__ import annotations

import re
from collections.abc import Iterable

from icarus_lite.language.diagnostics import Diagnostic, Severity
from icarus_lite.language.reading.brackets import Lines
from icarus_lite.language.syntax import Atom, Source, Span
from icarus_lite.language.wording import closest
from icarus_lite.records import dataclass, field, replace

_MOST_SEARCHED = 5_000  # words: what half a second is enough for
_OPENING = r"\([ \t\n\r\f\v]*\*?"
_WORD_ENDS = " \t\n\r\f\v()\"';"


@dataclass(slots=True)
class Report:
    """The findings about one source, in the order in which they were made."""

    source: Source
    diagnostics: list[Diagnostic] = field(default_factory=list)
    _lines: dict[str, Lines] = field(default_factory=dict)
    _searched: int = 0

    def error(
        self, span: Span, code: str, message: str, hint: str = "", *, label: str = ""
    ) -> None:
        """Add something that keeps the domain from loading."""
        self._add(Severity.ERROR, span, code, message, hint, label)

    def warning(
        self, span: Span, code: str, message: str, hint: str = "", *, label: str = ""
    ) -> None:
        """Add something that is probably a mistake."""
        self._add(Severity.WARNING, span, code, message, hint, label)

    def note(self, span: Span, code: str, message: str, hint: str = "", *, label: str = "") -> None:
        """Add something that is worth knowing."""
        self._add(Severity.NOTE, span, code, message, hint, label)

    def closest(self, word: str, candidates: Iterable[str]) -> str | None:
        """Give the candidate that the word was probably meant to be, or None.

        In a file with thousands of unknown words only the first ones are worth the search.
        """
        if self._searched > _MOST_SEARCHED:
            return None
        others = sorted({each for each in candidates if each != word})
        self._searched += len(others)
        return closest(word, others)

    def name_of(self, atom: Atom) -> Span:
        """Give the place of an atom's predicate."""
        if not atom.span.line:
            return atom.span
        text, lines = self._text(atom.span)
        match = re.compile(_OPENING).match(text, lines.offset(atom.span.line, atom.span.column))
        if match is None or not text.startswith(atom.predicate, match.end()):
            return atom.span
        return self._span(lines, match.end(), len(atom.predicate), atom.span)

    def attribute_of(self, atom: Atom, attribute: str) -> Span:
        """Give the place of an attribute's marker and name in an atom."""
        if not atom.span.line:
            return atom.span
        text, lines = self._text(atom.span)
        stop = lines.offset(atom.span.end_line, atom.span.end_column)
        for marker in "^*":
            word = marker + attribute
            found = text.find(word, lines.offset(atom.span.line, atom.span.column), stop)
            while found >= 0:
                if text[found + len(word)] in _WORD_ENDS:
                    return self._span(lines, found, len(word), atom.span)
                found = text.find(word, found + 1, stop)
        return atom.span

    def _text(self, span: Span) -> tuple[str, Lines]:
        """Give the text in which a span lies, and its lines."""
        text = self.source.text_of(span.path)
        if span.path not in self._lines:
            self._lines[span.path] = Lines(text)
        return text, self._lines[span.path]

    def _span(self, lines: Lines, offset: int, length: int, inside: Span) -> Span:
        return replace(lines.span(offset, offset + length), path=inside.path)

    def _add(
        self, severity: Severity, span: Span, code: str, message: str, hint: str, label: str
    ) -> None:
        path = span.path or self.source.path
        found = Diagnostic(path, span, severity, code, message, hint, label)
        self.diagnostics.append(found)
