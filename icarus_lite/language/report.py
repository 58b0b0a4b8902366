"""Collecting diagnostics about one source, and finding the exact words they are about."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from icarus_lite.language.brackets import Lines
from icarus_lite.language.diagnostics import Diagnostic, Severity
from icarus_lite.language.syntax import Atom, Source, Span


@dataclass(slots=True)
class Report:
    """The findings about one source, in the order in which they were made."""

    source: Source
    diagnostics: list[Diagnostic] = field(default_factory=list)
    _lines: Lines | None = None

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

    def name_of(self, atom: Atom) -> Span:
        """Give the place of an atom's predicate."""
        return self._find(atom.span, rf"\([\s]*\*?({re.escape(atom.predicate)})")

    def attribute_of(self, atom: Atom, attribute: str) -> Span:
        """Give the place of an attribute's marker and name in an atom."""
        return self._find(atom.span, rf"([\^*]{re.escape(attribute)})(?=[\s()\"';])")

    def _find(self, span: Span, pattern: str) -> Span:
        """Give the place of the first group of a pattern inside a span, or else the span."""
        if not span.line:
            return span
        if self._lines is None:
            self._lines = Lines(self.source.text)
        start = self._lines.offset(span.line, span.column)
        stop = self._lines.offset(span.end_line, span.end_column)
        match = re.compile(pattern).search(self.source.text, start, stop)
        return self._lines.span(match.start(1), match.end(1)) if match else span

    def _add(
        self, severity: Severity, span: Span, code: str, message: str, hint: str, label: str
    ) -> None:
        found = Diagnostic(self.source.path, span, severity, code, message, hint, label)
        self.diagnostics.append(found)
