"""Text into a syntax tree, or into a list of everything that keeps it from being one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

from icarus_lite.language.checking.silencing import unsilenced
from icarus_lite.language.diagnostics import (
    Diagnostic,
    DomainError,
    Severity,
    has_errors,
    in_order,
)
from icarus_lite.language.reading.assembly import assemble
from icarus_lite.language.reading.brackets import Scan, Segment, begins_nameless, scan
from icarus_lite.language.reading.explanations import explain, stands_inside
from icarus_lite.language.reading.includes import expand, includes
from icarus_lite.language.reading.lines import MAX_DEPTH, Lines
from icarus_lite.language.reading.parentheses import Mended, mend_parentheses
from icarus_lite.language.reading.parts import MalformedTermError, Outcome
from icarus_lite.language.reading.stumbles import Stumble
from icarus_lite.language.syntax import NOWHERE, Domain, Source, Span
from icarus_lite.records import dataclass, replace

_EMPTY_HINT = "a domain begins with (domain NAME) and has (concepts …) and (skills …)"


def parse_domain(
    text: str, path: str = "<text>", *, folder: Path | None = None
) -> tuple[Domain | None, tuple[Diagnostic, ...]]:
    """Read the text of a domain. It is not checked: that is `check_domain`'s work.

    Args:
        text: The text of a domain file.
        path: What to call the file in messages.
        folder: The folder of the file, from which it may include others; None if it is no file.

    Returns:
        The domain, or None if there is an error among the diagnostics, and the diagnostics in
        the order of the text. Every form is read, so that one mistake does not hide the others.
    """
    read = read_domain(Source(path, text), folder)
    return (None if has_errors(read.diagnostics) else read.domain), read.diagnostics


@dataclass(frozen=True, slots=True)
class DomainRead:
    """A domain as far as it could be read.

    Args:
        domain: The domain. Where only parentheses were wrong, it is the one that was probably
            meant: with errors among the diagnostics it may be checked, but not used.
        source: Its text, with those it includes.
        diagnostics: What there is to say so far, in the order of the text.
        mended: The files and lines in which parentheses were mended.
    """

    domain: Domain | None
    source: Source
    diagnostics: tuple[Diagnostic, ...]
    mended: frozenset[tuple[str, int]] = frozenset()

    def credible(self, found: Iterable[Diagnostic]) -> list[Diagnostic]:
        """Leave out what may come of parentheses that were mended in the same line."""
        return [each for each in found if (each.path, each.span.line) not in self.mended]


def read_domain(
    source: Source, folder: Path | None, unsaved: Mapping[str, str] = MappingProxyType({})
) -> DomainRead:
    """Read a domain as `parse_domain` does, and give its text with those it includes as well."""
    outcome = read_forms(source)
    forms, problems, is_whole = outcome.forms, outcome.problems, outcome.is_whole
    mended = frozenset((source.path, line) for line in outcome.mended)
    if includes(forms):
        expansion = expand(forms, source, folder, read_forms, unsaved)
        forms, source, is_whole = expansion.forms, expansion.source, expansion.is_whole
        problems, mended = (*problems, *expansion.problems), mended | expansion.mended
    if not is_whole:
        return DomainRead(None, source, in_order(problems), mended)
    if not forms:
        return DomainRead(None, source, (_empty(source.path, _EMPTY_HINT),))
    domain, remarks = assemble(forms, source)
    remarks = unsilenced(in_order(remarks), source)
    read = DomainRead(None if has_errors(remarks) else domain, source, (), mended)
    return replace(read, diagnostics=in_order((*problems, *read.credible(remarks))))


def read_forms(source: Source) -> Outcome:
    """Read the top-level forms of one text; includes are left as they are."""
    return _Reading(source).forms()


def read_fragment(text: str, path: str, start: str) -> tuple[object, ...]:
    """Read a text that is one thing only, such as a goal.

    Args:
        text: The text.
        path: What to call it in messages.
        start: The rule of the grammar it must match: `conditions` or `pattern`.

    Returns:
        What the rule gives; at least one part.

    Raises:
        DomainError: The text does not match the rule, or is empty.
    """
    return _Reading(Source(path, text)).fragment(start)


def _empty(path: str, hint: str) -> Diagnostic:
    return Diagnostic(path, NOWHERE, Severity.ERROR, "ICR006", "there is nothing to read", hint)


def _stumble_offset(text: str) -> int | None:
    """Give the place at which the parser stumbles over a text, or None if it takes all of it."""
    return _Reading(Source("", text)).stumble_offset()


class _Reading:
    """One pass over one text."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self._lines = Lines(source.text)
        self._problems: list[Diagnostic] = []

    def forms(self) -> Outcome:
        """Read all forms."""
        if self._has_nul():
            return Outcome((), tuple(self._problems))
        scanned = scan(self._source.text)
        if scanned.is_sound:
            whole = Segment(0, len(self._source.text))
            forms = self._parse(whole, "file", quiet=True)
            if isinstance(forms, tuple):
                return Outcome(forms, ())
        mended = self._mended(scanned)
        if mended is not None:
            return self._read_on(mended)
        self._report_brackets(scanned)
        was_nameless = False
        for segment in scanned.segments:
            # A ")" too many sets all that follows it free: say so once, not for every clause.
            is_nameless = begins_nameless(self._source.text, segment)
            if not (is_nameless and was_nameless):
                self._read_segment(segment)
            was_nameless = is_nameless
        return Outcome((), tuple(self._problems))

    def _mended(self, scanned: Scan) -> Mended | None:
        is_too_deep = any(segment.too_deep is not None for segment in scanned.segments)
        if is_too_deep or scanned.unclosed_quote is not None:
            return None
        return mend_parentheses(self._source.text, self._source.path, _stumble_offset)

    def _read_on(self, mended: Mended) -> Outcome:
        """Read a text whose parentheses have been mended; what is wrong besides counts as well."""
        outcome = _Reading(Source(self._source.path, mended.text)).forms()
        more = [each for each in outcome.problems if each.span.line not in mended.lines]
        return Outcome(outcome.forms, (*mended.problems, *more), mended.lines)

    def fragment(self, start: str) -> tuple[object, ...]:
        """Read the text as one fragment, or raise with all that is wrong with it."""
        result: object = ()
        if not self._has_nul():
            scanned = scan(self._source.text)
            self._report_brackets(scanned)
            for segment in scanned.segments:
                if segment.unclosed:
                    self._report_unclosed(segment, segment.unclosed[-1])
            if scanned.is_sound:
                result = self._parse(Segment(0, len(self._source.text)), start)
        if not self._problems and isinstance(result, tuple) and result:
            return result
        empty = () if self._problems else (_empty(self._source.path, "write (holding ?hand ?obj)"),)
        raise DomainError(in_order((*self._problems, *empty)), self._source)

    def _has_nul(self) -> bool:
        offset = self._source.text.find("\0")
        if offset >= 0:
            message = "the text holds a NUL character: this is no domain file"
            self._error(offset, 1, "ICR001", message, "save the file as UTF-8 text")
        return offset >= 0

    def _report_brackets(self, scanned: Scan) -> None:
        text = self._source.text
        for offset in scanned.strays:
            hint = 'remove it, or look for a ")" too many before it'
            self._error(offset, 1, "ICR003", 'this ")" closes nothing', hint)
        if scanned.unclosed_quote is not None:
            is_string = text[scanned.unclosed_quote] == '"'
            what, end = ("string", '"') if is_string else ("comment", "|#")
            length = 1 if is_string else 2
            message = f"this {what} is never closed"
            hint = f"close it with {end}"
            self._error(scanned.unclosed_quote, length, "ICR004", message, hint)
        for segment in scanned.segments:
            if segment.too_deep is not None:
                message = f"parentheses are nested more than {MAX_DEPTH} deep"
                hint = "split the expression, or look for a forgotten parenthesis"
                self._error(segment.too_deep, 1, "ICR005", message, hint)

    def _read_segment(self, segment: Segment) -> None:
        """Report what is wrong inside one form."""
        if segment.too_deep is not None:
            return
        if not segment.unclosed:
            self._parse(segment, "file")
            return
        stumble = self._stumble(segment, "file")
        if stumble is None or stumble.at_end:
            self._report_unclosed(segment, segment.unclosed[-1])
            return
        inside = stands_inside(stumble, self._source.text)
        if inside is not None:
            self._report_unclosed(segment, inside)
            return
        self._explain(stumble)
        self._report_unclosed(segment, segment.unclosed[-1])

    def _report_unclosed(self, segment: Segment, offset: int) -> None:
        count = len(segment.unclosed)
        missing = 'a ")" is' if count == 1 else f'{count} ")" are'
        form = self._lines.span(segment.unclosed[0], segment.unclosed[0] + 1)
        hint = f"{missing} missing in the form that begins at {form.line}:{form.column}"
        self._error(offset, 1, "ICR002", 'this "(" is never closed', hint)

    def _parse(self, segment: Segment, start: str, *, quiet: bool = False) -> object:
        """Parse a segment; what is wrong with it is reported unless asked to be quiet."""
        try:
            result = self._attempt(segment, start)
        except MalformedTermError as error:
            if not quiet:
                self._add(error.span, "ICR010", error.message, error.hint)
            return None
        if not isinstance(result, Stumble):
            return result
        if not quiet:
            self._explain(result)
        return None

    def stumble_offset(self) -> int | None:
        """Give the place at which the parser stumbles, or None; what is in numbers is no matter."""
        found = self._stumble(Segment(0, len(self._source.text)), "file")
        return None if found is None else found.offset

    def _stumble(self, segment: Segment, start: str) -> Stumble | None:
        try:
            result = self._attempt(segment, start)
        except MalformedTermError:
            return None
        return result if isinstance(result, Stumble) else None

    def _attempt(self, segment: Segment, start: str) -> object:
        """Give the parsed parts, or where the parser stumbled."""
        # Lark takes longer to import than everything else here, and not every caller parses.
        from lark import UnexpectedInput  # noqa: PLC0415

        from icarus_lite.language.reading.parsing import parse  # noqa: PLC0415

        place = self._lines.span(segment.start, segment.start)
        try:
            return parse(self._source.text, segment.start, segment.stop, place, start)
        except UnexpectedInput as error:
            interactive = getattr(error, "interactive_parser", None)
            accepts = frozenset(interactive.accepts()) if interactive is not None else frozenset()
            token = getattr(error, "token", None)
            if token is not None and token.type == "$END":
                return Stumble(segment.stop, accepts, segment.start, start, at_end=True)
            offset = self._lines.offset(error.line, error.column)
            return Stumble(offset, accepts, segment.start, start)

    def _explain(self, stumble: Stumble) -> None:
        found = explain(stumble, self._source.text, self._source.path, self._lines)
        self._problems.append(found)

    def _error(self, offset: int, length: int, code: str, message: str, hint: str) -> None:
        self._add(self._lines.span(offset, offset + length), code, message, hint)

    def _add(self, span: Span, code: str, message: str, hint: str) -> None:
        found = Diagnostic(self._source.path, span, Severity.ERROR, code, message, hint)
        self._problems.append(found)
