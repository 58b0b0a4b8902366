"""What `icarus check` has to say, as diagnostics under the words they are about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from lsprotocol import types

from icarus_lite.language import Diagnostic, Severity, diagnose_text
from icarus_lite.language.editing import Role
from icarus_lite.language.reading.lines import Lines
from runtime.lsp.documents import Project

_SEVERITIES: Mapping[Severity, types.DiagnosticSeverity] = MappingProxyType(
    {
        Severity.ERROR: types.DiagnosticSeverity.Error,
        Severity.WARNING: types.DiagnosticSeverity.Warning,
        Severity.NOTE: types.DiagnosticSeverity.Information,
    }
)
_TAGS: Mapping[str, types.DiagnosticTag] = MappingProxyType(
    {
        "ICR028": types.DiagnosticTag.Deprecated,
        "ICR040": types.DiagnosticTag.Unnecessary,
    }
)


def findings(project: Project) -> list[types.Diagnostic]:
    """Check an open text; what is wrong in files that it includes is told where it does so."""
    found = diagnosed(project)
    own = [each for each in found if each.path == project.path]
    others: dict[str, list[Diagnostic]] = {}
    for each in found:
        if each.path != project.path and each.severity is Severity.ERROR:
            others.setdefault(each.path, []).append(each)
    lines = Lines(project.text)
    here = [diagnostic(project, lines, each) for each in own]
    return here + [_about_include(project, path, each) for path, each in others.items()]


def diagnosed(project: Project) -> tuple[Diagnostic, ...]:
    """Check an open text; files that it includes count as they are in the editor."""
    text, path = project.text, project.path
    return diagnose_text(text, path, thorough=True, unsaved=project.unsaved)[2]


def diagnostic(project: Project, lines: Lines, found: Diagnostic) -> types.Diagnostic:
    """Give a finding about an open text as the protocol has it."""
    span = found.span
    start = stop = 0
    if span.line:
        start = lines.offset(span.line, span.column)
        stop = lines.offset(span.end_line, span.end_column)
    label = f" ({found.label})" if found.label else ""
    hint = f"\n{found.hint}" if found.hint else ""
    severity = _SEVERITIES[found.severity]
    tag = _TAGS.get(found.code)
    if tag is types.DiagnosticTag.Unnecessary:
        severity = types.DiagnosticSeverity.Hint
    return types.Diagnostic(
        range=project.positions().range(start, stop),
        message=f"{found.message}{label}{hint}",
        severity=severity,
        code=found.code,
        source="icarus",
        tags=[tag] if tag else None,
    )


def _about_include(project: Project, path: str, errors: Sequence[Diagnostic]) -> types.Diagnostic:
    """Tell of the errors of an included file, under the first include of the open text."""
    includes = [
        word
        for word in project.index.words(project.path)
        if word.place.form == "include" and word.role is Role.STRING
    ]
    named = [word for word in includes if path.endswith(word.name.strip('"'))] or includes
    start, stop = (named[0].start, named[0].stop) if named else (0, 0)
    first = errors[0]
    more = f", and {len(errors) - 1} more" if len(errors) > 1 else ""
    return types.Diagnostic(
        range=project.positions().range(start, stop),
        message=f"{path}:{first.span.line}:{first.span.column}: {first.message}{more}",
        severity=types.DiagnosticSeverity.Error,
        code=first.code,
        source="icarus",
    )
