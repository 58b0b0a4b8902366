"""Comments that silence a remark: `; noqa: ICR029` at the end of a line, as linters have it.

`; noqa` alone silences every warning and note whose place is in that line, `; noqa: ICR029 ICR030`
those codes only. `; icarus: noqa: ICR040` on a line of its own silences a code in the whole file.
Errors cannot be silenced: a domain with one does not load.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from icarus_lite.language.diagnostics import Diagnostic, Severity
from icarus_lite.language.syntax import Source
from icarus_lite.records import dataclass, field

_COMMENT = re.compile(
    r";[ \t;]*(?P<file>icarus:[ \t]*)?(?P<noqa>noqa)(?![\w-])(?P<codes>:[^\n]*)?[^\n]*"
    r'|"(?:[^"\\]|\\[\s\S])*+"|#\|[\s\S]*?\|#|;[^\n]*|\n'
)
_CODE = re.compile(r"ICR[0-9]{3}")


def unsilenced(diagnostics: Iterable[Diagnostic], source: Source) -> tuple[Diagnostic, ...]:
    """Leave out the warnings and notes that a comment in their file silences."""
    silences: dict[str, _Silence] = {}
    kept: list[Diagnostic] = []
    for found in diagnostics:
        if found.severity is not Severity.ERROR:
            if found.path not in silences:
                silences[found.path] = _silence(source.text_of(found.path))
            if silences[found.path].covers(found):
                continue
        kept.append(found)
    return tuple(kept)


@dataclass(slots=True)
class _Silence:
    """What the comments of one file silence: codes by line, an empty set for all of them."""

    by_line: dict[int, frozenset[str]] = field(default_factory=dict)
    everywhere: set[str] = field(default_factory=set)

    def covers(self, found: Diagnostic) -> bool:
        """Tell whether a finding is silenced."""
        codes = self.by_line.get(found.span.line)
        here = codes is not None and (not codes or found.code in codes)
        return here or found.code in self.everywhere


def _silence(text: str) -> _Silence:
    silence = _Silence()
    if "noqa" not in text:
        return silence
    line = 1
    for match in _COMMENT.finditer(text):
        if match["noqa"]:
            codes = frozenset(_CODE.findall(match["codes"] or ""))
            if match["file"]:
                silence.everywhere |= codes
            elif codes or not match["codes"]:
                silence.by_line[line] = codes
        line += match[0].count("\n")
    return silence
