"""The answers to an editor's questions, in the words of the Language Server Protocol."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from types import MappingProxyType

from lsprotocol import types

from icarus_lite.language.editing import (
    Entry,
    EntryKind,
    File,
    Located,
    Role,
    Thing,
    complete,
    describe,
    outline,
    rename,
    renameable,
    signature,
)
from runtime.lsp.documents import Project
from runtime.lsp.positions import Positions

_COMPLETION_KINDS: Mapping[Role, types.CompletionItemKind] = MappingProxyType(
    {
        Role.FORM: types.CompletionItemKind.Keyword,
        Role.FIELD: types.CompletionItemKind.Keyword,
        Role.NOT: types.CompletionItemKind.Operator,
        Role.MOMENT: types.CompletionItemKind.Keyword,
        Role.PREDICATE: types.CompletionItemKind.Class,
        Role.SKILL: types.CompletionItemKind.Method,
        Role.COMMAND: types.CompletionItemKind.Event,
        Role.FUNCTION: types.CompletionItemKind.Function,
        Role.ATTRIBUTE: types.CompletionItemKind.Property,
        Role.VARIABLE: types.CompletionItemKind.Variable,
    }
)
_SYMBOL_KINDS: Mapping[EntryKind, types.SymbolKind] = MappingProxyType(
    {
        EntryKind.FORM: types.SymbolKind.Namespace,
        EntryKind.DOMAIN: types.SymbolKind.Module,
        EntryKind.PERCEPT: types.SymbolKind.Struct,
        EntryKind.CONCEPT: types.SymbolKind.Class,
        EntryKind.SKILL: types.SymbolKind.Method,
        EntryKind.ATTACHMENT: types.SymbolKind.Event,
        EntryKind.CONTRADICTION: types.SymbolKind.Event,
        EntryKind.TASK: types.SymbolKind.Object,
        EntryKind.GOAL: types.SymbolKind.Object,
        EntryKind.TEST: types.SymbolKind.Boolean,
    }
)


def hover(
    project: Project, position: types.Position, commands: Collection[str]
) -> types.Hover | None:
    """Say what the word at a position means."""
    word = project.index.at(project.path, project.offset(position))
    if word is None:
        return None
    text = describe(project.index, project.path, word, commands=commands)
    if not text:
        return None
    value = types.MarkupContent(types.MarkupKind.Markdown, text)
    return types.Hover(value, project.positions().range(word.start, word.stop))


def definition(project: Project, position: types.Position) -> list[types.Location]:
    """Give the places where the thing at a position is defined."""
    thing = _thing(project, position)
    return [_location(project, each) for each in project.index.definitions(thing)] if thing else []


def references(
    project: Project, position: types.Position, *, with_definitions: bool
) -> list[types.Location]:
    """Give the places where the thing at a position is used."""
    thing = _thing(project, position)
    if thing is None:
        return []
    defining = set() if with_definitions else set(project.index.definitions(thing))
    found = [each for each in project.index.occurrences(thing) if each not in defining]
    return [_location(project, each) for each in found]


def highlights(project: Project, position: types.Position) -> list[types.DocumentHighlight]:
    """Give the places in the same text that speak of the thing at a position."""
    thing = _thing(project, position)
    if thing is None:
        return []
    positions = project.positions()
    return [
        types.DocumentHighlight(
            positions.range(each.occurrence.start, each.occurrence.stop),
            types.DocumentHighlightKind.Write
            if each.occurrence.defines
            else types.DocumentHighlightKind.Read,
        )
        for each in project.index.occurrences(thing)
        if each.path == project.path
    ]


def completion(
    project: Project, position: types.Position, commands: Collection[str]
) -> types.CompletionList:
    """Propose what could be written at a position."""
    found = complete(project.index, project.path, project.offset(position), commands=commands)
    place = project.positions().range(found.start, found.stop)
    items = [
        types.CompletionItem(
            label=proposal.text,
            kind=_COMPLETION_KINDS.get(proposal.role, types.CompletionItemKind.Value),
            detail=proposal.detail or None,
            documentation=_markdown(proposal.documentation),
            sort_text=f"{rank:05}",
            filter_text=proposal.text,
            text_edit=types.TextEdit(place, proposal.text),
        )
        for rank, proposal in enumerate(found.proposals)
    ]
    return types.CompletionList(is_incomplete=False, items=items)


def prepare_rename(project: Project, position: types.Position) -> types.PrepareRenamePlaceholder:
    """Give the name that could be changed, with its place. Raises RenameError."""
    word = project.index.at(project.path, project.offset(position))
    thing = renameable(project.index, project.path, word)
    assert word is not None
    # An attribute's marker is no part of its name and stays what it is.
    start = word.start + (thing.role is Role.ATTRIBUTE)
    return types.PrepareRenamePlaceholder(project.positions().range(start, word.stop), thing.name)


def renaming(project: Project, position: types.Position, name: str) -> types.WorkspaceEdit:
    """Give the edits that change a name everywhere. Raises RenameError."""
    word = project.index.at(project.path, project.offset(position))
    thing = renameable(project.index, project.path, word)
    changes: dict[str, list[types.TextEdit]] = {}
    for located, text in rename(project.index, thing, name):
        edit = types.TextEdit(_location(project, located).range, text)
        changes.setdefault(project.uris[located.path], []).append(edit)
    return types.WorkspaceEdit(changes=changes)


def symbols(project: Project) -> list[types.DocumentSymbol]:
    """Give the table of contents of a text."""
    positions = project.positions()
    words = project.index.words(project.path)
    return [_symbol(entry, positions) for entry in outline(words)]


def workspace_symbols(
    files: Iterable[tuple[File, str]], query: str, encoding: types.PositionEncodingKind | str
) -> list[types.WorkspaceSymbol]:
    """Give what the open texts, and those that they include, define under a name.

    Args:
        files: The texts, each with its URI.
        query: Letters that the name has in this order, whatever their case; all names if empty.
        encoding: What the columns of positions count.
    """
    found = []
    for file, uri in files:
        positions = Positions(file.text, encoding)
        for form in outline(file.words):
            for entry in form.children or (form,):
                if entry.name and _has_letters(entry.name, query):
                    place = types.Location(uri, positions.range(entry.name_start, entry.name_stop))
                    inside = form.name if entry is not form else None
                    kind = _SYMBOL_KINDS[entry.kind]
                    found.append(
                        types.WorkspaceSymbol(
                            location=place, name=entry.name, kind=kind, container_name=inside
                        )
                    )
    return found


def _has_letters(name: str, query: str) -> bool:
    letters = iter(name.casefold())
    return all(letter in letters for letter in query.casefold())


def signature_help(project: Project, position: types.Position) -> types.SignatureHelp | None:
    """Say what the pattern that is being written takes."""
    found = signature(project.index, project.path, project.offset(position))
    if found is None:
        return None
    label = Positions(found.label, types.PositionEncodingKind.Utf16)
    parameters = [
        types.ParameterInformation((label.length(0, start), label.length(0, stop)))
        for start, stop in found.parameters
    ]
    information = types.SignatureInformation(
        found.label, _markdown(found.documentation), parameters, found.active
    )
    return types.SignatureHelp([information], 0, found.active)


def formatting(project: Project) -> list[types.TextEdit]:
    """Give the edit that lays a text out, or none if it is laid out already."""
    from icarus_lite.language.formatting.formatter import format_text  # noqa: PLC0415 - not always needed

    text = project.text
    laid_out = format_text(text)
    if laid_out == text:
        return []
    return [types.TextEdit(project.positions().range(0, len(text)), laid_out)]


def _symbol(entry: Entry, positions: Positions) -> types.DocumentSymbol:
    return types.DocumentSymbol(
        name=entry.name or entry.kind.value,
        kind=_SYMBOL_KINDS[entry.kind],
        range=positions.range(entry.start, entry.stop),
        selection_range=positions.range(entry.name_start, entry.name_stop),
        detail=entry.detail or None,
        children=[_symbol(child, positions) for child in entry.children] or None,
    )


def _thing(project: Project, position: types.Position) -> Thing | None:
    word = project.index.at(project.path, project.offset(position))
    return project.index.thing(project.path, word) if word else None


def _location(project: Project, located: Located) -> types.Location:
    word = located.occurrence
    place = project.positions(located.path).range(word.start, word.stop)
    return types.Location(project.uris[located.path], place)


def _markdown(text: str) -> types.MarkupContent | None:
    return types.MarkupContent(types.MarkupKind.Markdown, text) if text else None
