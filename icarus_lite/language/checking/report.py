"""Collecting diagnostics about one source, and finding the exact words they are about."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.language.reading.lines import Lines
from icarus_lite.language.syntax import Atom, Source, Span
from icarus_lite.language.wording import closest
from icarus_lite.records import dataclass, field, replace

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.language.diagnostics import Diagnostic

_MOST_SEARCHED = 5_000  # words: what half a second is enough for
_BLANKS = " \t\n\r\f\v"
_WORD_ENDS = _BLANKS + "()\"';"


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
        self._add("error", span, code, message, hint, label)

    def warning(
        self, span: Span, code: str, message: str, hint: str = "", *, label: str = ""
    ) -> None:
        """Add something that is probably a mistake."""
        self._add("warning", span, code, message, hint, label)

    def note(self, span: Span, code: str, message: str, hint: str = "", *, label: str = "") -> None:
        """Add something that is worth knowing."""
        self._add("note", span, code, message, hint, label)

    @property
    def has_errors(self) -> bool:
        """Whether anything found so far keeps the domain from loading."""
        return any(found.severity == "error" for found in self.diagnostics)

    def findings(self) -> tuple[Diagnostic, ...]:
        """Give what was found, in the order of the text."""
        if not self.diagnostics:
            return ()
        from icarus_lite.language.diagnostics import in_order  # noqa: PLC0415 - mostly not needed

        return in_order(self.diagnostics)

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
        start = lines.offset(atom.span.line, atom.span.column)
        if not text.startswith("(", start):
            return atom.span
        start += 1
        while text.startswith(tuple(_BLANKS), start):
            start += 1
        start += text.startswith("*", start)
        if not text.startswith(atom.predicate, start):
            return atom.span
        return self._span(lines, start, len(atom.predicate), atom.span)

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
        self, severity: str, span: Span, code: str, message: str, hint: str, label: str
    ) -> None:
        from icarus_lite.language.diagnostics import Diagnostic, Severity  # noqa: PLC0415

        path = span.path or self.source.path
        found = Diagnostic(path, span, Severity(severity), code, message, hint, label)
        self.diagnostics.append(found)
