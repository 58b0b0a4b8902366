"""What is wrong with a domain file, where, and what to do about it.

A `Diagnostic` is plain data; the command line, the REPL and the Python exception show the same one.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Mapping
from enum import StrEnum
from types import MappingProxyType

from icarus_lite.errors import IcarusError
from icarus_lite.language.syntax import Source, Span
from icarus_lite.records import dataclass

CODES: Mapping[str, str] = MappingProxyType(
    {
        "ICR001": "The file cannot be read as UTF-8 text.",
        "ICR002": 'A "(" is never closed.',
        "ICR003": 'A ")" is one too many, or a "(" is missing.',
        "ICR004": "A string or a block comment is never closed.",
        "ICR005": "Parentheses are nested too deeply.",
        "ICR006": "The file holds no form at all.",
        "ICR007": "A top-level form has an unknown name.",
        "ICR008": "A field has an unknown name, or cannot stand in this form.",
        "ICR009": "A word or parenthesis stands where the language does not allow it.",
        "ICR010": "A number or a string escape cannot be represented.",
        "ICR011": "Something is stated twice, or a required field is missing.",
        "ICR012": "A variable is used but never bound.",
        "ICR013": "A predicate is neither perceived, derived, asserted nor `attached`.",
        "ICR014": "A predicate, skill or action has the wrong number of arguments.",
        "ICR015": "An attribute is not declared.",
        "ICR016": "A function is unknown.",
        "ICR017": "A function has the wrong number or kind of arguments.",
        "ICR018": "The clauses of one concept have different attributes.",
        "ICR019": "A concept depends on its own negation.",
        "ICR020": "Two tasks have the same name.",
        "ICR021": "A task has no goal.",
        "ICR022": "A skill has both :actions and :subskills, or neither.",
        "ICR023": "A skill is called that has no clause.",
        "ICR024": "The child or parent of an attachment does not occur in its attach pattern.",
        "ICR025": "A variable stands in a test, where everything must be ground.",
        "ICR026": "A driver command is written without its star.",
        "ICR027": "A predicate is taken to be perceived, because no percept type is declared.",
        "ICR028": "An older spelling is used that still loads.",
        "ICR029": "A variable occurs only once.",
        "ICR030": "A variable occurs only inside `not`, which then reads: there is none.",
        "ICR031": "A removing effect has a variable that is never bound: it removes every match.",
        "ICR032": "A name is both a percept type and a concept.",
        "ICR033": "A skill's argument is bound by nothing but its caller.",
        "ICR034": "A recursive concept computes one of its arguments and may never come to an end.",
        "ICR035": "A skill uses a command that the driver does not offer.",
        "ICR036": "A file cannot be included.",
        "ICR037": "An older construct has no counterpart and is refused.",
        "ICR039": "The supertype of a percept type is unknown, leads back to it, or too far up.",
        "ICR040": "Nothing uses this name (only told on request).",
        "ICR041": "A concept can never be true, a skill never start, a contradiction never hold.",
        "ICR042": "An effect speaks of what only perception can change.",
        "ICR043": "The detach action of an attachment never undoes it.",
        "ICR044": "A test compares what can never be compared, such as a symbol with a number.",
        "ICR045": "No skill can ever change what a goal asks for.",
        "ICR046": "A breakpoint is set for a moment that there is not.",
        "ICR047": "A word is taken for a name, though something else must be meant.",
        "ICR048": "An agent is unknown.",
        "ICR049": "An agent has nothing to do, or a request is made to nobody.",
        "ICR050": "A contradiction speaks of what does not persist.",
        "ICR070": "A fact of :init cannot be given, or serves nothing.",
    }
)
"""Every code that can be reported, with the one sentence that says what it means."""

_TAB = 4
_LONGEST_LINE = 120


class Severity(StrEnum):
    """How bad it is: only errors keep a domain from loading."""

    ERROR = "error"
    WARNING = "warning"
    NOTE = "note"


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding about a domain file.

    Args:
        path: The file, as shown to the user.
        span: The stretch of text it is about; `NOWHERE` if it has no place.
        severity: Error, warning or note.
        code: One of `CODES`.
        message: What is wrong, without a full stop.
        hint: What to do about it; may be empty.
        label: A few words beside the carets; may be empty.
    """

    path: str
    span: Span
    severity: Severity
    code: str
    message: str
    hint: str = ""
    label: str = ""

    def to_json(self) -> dict[str, str | int]:
        """Give the object that `icarus check --json` lists."""
        return to_json(self)


class DomainError(IcarusError, ValueError):
    """A domain cannot be loaded; `str()` shows every error with its line and carets.

    Args:
        diagnostics: Everything found, warnings and notes included.
        source: The text the diagnostics point into.
    """

    def __init__(self, diagnostics: Iterable[Diagnostic], source: Source) -> None:
        self.diagnostics = tuple(diagnostics)
        self.source = source
        errors = [found for found in self.diagnostics if found.severity is Severity.ERROR]
        texts = [render(error, source) for error in errors]
        if len(errors) > 1:
            texts.append(f"{source.path}: {len(errors)} errors")
        super().__init__("\n".join(texts))

    def __reduce__(self) -> tuple[type[DomainError], tuple[tuple[Diagnostic, ...], Source]]:
        return DomainError, (self.diagnostics, self.source)


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Tell whether any of the diagnostics keeps the domain from loading."""
    return any(found.severity is Severity.ERROR for found in diagnostics)


def in_order(diagnostics: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Sort diagnostics by their place in the file, keeping the order of those at one place.

    Included files follow one another as they are first spoken of.
    """
    found = list(diagnostics)
    rank: dict[str, int] = {}
    for each in found:
        rank.setdefault(each.path, len(rank))
    found.sort(key=lambda each: (rank[each.path], each.span.line, each.span.column))
    return tuple(found)


def to_json(diagnostic: Diagnostic) -> dict[str, str | int]:
    """Give the diagnostic as the object that `icarus check --json` lists."""
    span = diagnostic.span
    return {
        "file": diagnostic.path,
        "line": span.line,
        "column": span.column,
        "end_line": span.end_line,
        "end_column": span.end_column,
        "severity": diagnostic.severity.value,
        "code": diagnostic.code,
        "message": diagnostic.message,
        "hint": diagnostic.hint,
    }


def render(diagnostic: Diagnostic, source: Source | str) -> str:
    """Write the diagnostic out: place and message, the line with carets under it, the hint.

    A span over several lines is underlined to the end of its first line. Tabs are shown as
    spaces, wide and combining characters keep the carets in place, long lines are cut.

    Args:
        diagnostic: What to show.
        source: The text it points into.
    """
    text = source if isinstance(source, str) else source.text_of(diagnostic.path)
    place = diagnostic.path
    if diagnostic.span.line:
        place += f":{diagnostic.span.line}:{diagnostic.span.column}"
    lines = [f"{place}: {diagnostic.severity}[{diagnostic.code}]: {diagnostic.message}"]
    lines += _excerpt(diagnostic, text)
    if diagnostic.hint:
        lines.append(f"   hint: {diagnostic.hint}")
    return "\n".join(lines)


def _excerpt(diagnostic: Diagnostic, source: str) -> list[str]:
    """Give the source line and the line of carets, or nothing if the place is not in the text."""
    span = diagnostic.span
    starts = _line_starts(source)
    if not 1 <= span.line <= len(starts):
        return []
    begin = starts[span.line - 1]
    end = starts[span.line] - 1 if span.line < len(starts) else len(source)
    line = source[begin:end].rstrip("\r")
    start = min(span.column - 1, len(line))
    stop = span.end_column - 1 if span.end_line == span.line else len(line)
    stop = max(start + 1, min(stop, len(line)))
    cut_from = 0
    if len(line) > _LONGEST_LINE and stop > _LONGEST_LINE:
        cut_from = max(0, start - _LONGEST_LINE // 4)  # so that the span stays in sight
    shown = _cells(line[cut_from : cut_from + _LONGEST_LINE])
    before = sum(width for _, width in shown[: start - cut_from])
    under = sum(width for _, width in shown[start - cut_from : stop - cut_from])
    opening = "…" if cut_from else ""
    closing = "…" if cut_from + _LONGEST_LINE < len(line) else ""
    text = opening + "".join(glyph for glyph, _ in shown) + closing
    carets = " " * (len(opening) + before) + "^" * max(under, 1)
    label = f" {diagnostic.label}" if diagnostic.label else ""
    return [f"{span.line:>5} | {text}".rstrip(), f"{'':>5} | {carets}{label}"]


@functools.lru_cache(maxsize=8)
def _line_starts(text: str) -> tuple[int, ...]:
    """Give the offset of each line; kept, for the findings about one text come together."""
    return (0, *(match.end() for match in re.finditer("\n", text)))


def _cells(line: str) -> list[tuple[str, int]]:
    """Give what is shown for each character, with the number of columns it takes."""
    import unicodedata  # noqa: PLC0415 - most runs show no line of a text

    cells: list[tuple[str, int]] = []
    column = 0
    for character in line:
        if character == "\t":
            glyph = " " * (_TAB - column % _TAB)
            width = len(glyph)
        elif unicodedata.category(character) in ("Mn", "Me"):
            glyph, width = character, 0
        elif not character.isprintable():
            glyph, width = "\N{REPLACEMENT CHARACTER}", 1
        else:
            wide = unicodedata.east_asian_width(character) in ("W", "F")
            glyph, width = character, 2 if wide else 1
        cells.append((glyph, width))
        column += width
    return cells
