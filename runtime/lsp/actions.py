"""Quick fixes: what the hints of diagnostics say, carried out on request."""

from __future__ import annotations

from lsprotocol import types

from icarus_lite.language.editing import Fix, fixes
from icarus_lite.language.reading.lines import Lines
from runtime.lsp.documents import Project
from runtime.lsp.findings import diagnosed, diagnostic

KINDS = (types.CodeActionKind.QuickFix,)
"""The kinds of actions that are offered."""


def code_actions(project: Project, params: types.CodeActionParams) -> list[types.CodeAction]:
    """Give what can be done about the findings in a range of an open text."""
    only = params.context.only
    if only and not any(_covers(kind, types.CodeActionKind.QuickFix) for kind in only):
        return []
    start, stop = project.offset(params.range.start), project.offset(params.range.end)
    lines = Lines(project.text)
    actions: dict[tuple[str, str], types.CodeAction] = {}
    for found in diagnosed(project):
        if found.path != project.path or not found.span.line:
            continue
        first = lines.offset(found.span.line, found.span.column)
        last = lines.offset(found.span.end_line, found.span.end_column)
        if first <= stop and start <= last:
            shown = diagnostic(project, lines, found)
            for fix in fixes(project.text, found):
                action = _action(project, fix, shown)
                actions.setdefault((fix.title, repr(fix.replacements)), action)
    return list(actions.values())


def _action(project: Project, fix: Fix, about: types.Diagnostic) -> types.CodeAction:
    positions = project.positions()
    edits = [
        types.TextEdit(positions.range(each.start, each.stop), each.text)
        for each in fix.replacements
    ]
    return types.CodeAction(
        title=fix.title,
        kind=types.CodeActionKind.QuickFix,
        diagnostics=[about],
        is_preferred=fix.is_sure,
        edit=types.WorkspaceEdit(changes={project.uris[project.path]: edits}),
    )


def _covers(wanted: types.CodeActionKind | str, kind: types.CodeActionKind) -> bool:
    """Tell whether a kind is the one asked for, or a special case of it."""
    name = wanted.value if isinstance(wanted, types.CodeActionKind) else wanted
    return not name or kind.value == name or kind.value.startswith(f"{name}.")
