"""Semantic tokens: what each word stands for, for editors that colour by meaning."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from lsprotocol import types

from icarus_lite.language.checking.vocabulary import Origin
from icarus_lite.language.editing import Occurrence, Role
from icarus_lite.language.functions import FUNCTIONS
from icarus_lite.language.keywords import FORMS, field_named
from runtime.lsp.documents import Project

_TYPES: Mapping[Role, types.SemanticTokenTypes] = MappingProxyType(
    {
        Role.FORM: types.SemanticTokenTypes.Keyword,
        Role.FIELD: types.SemanticTokenTypes.Keyword,
        Role.NOT: types.SemanticTokenTypes.Keyword,
        Role.MOMENT: types.SemanticTokenTypes.Keyword,
        Role.PREDICATE: types.SemanticTokenTypes.Class,
        Role.SKILL: types.SemanticTokenTypes.Method,
        Role.COMMAND: types.SemanticTokenTypes.Macro,
        Role.FUNCTION: types.SemanticTokenTypes.Function,
        Role.ATTRIBUTE: types.SemanticTokenTypes.Property,
        Role.VARIABLE: types.SemanticTokenTypes.Variable,
        Role.SYMBOL: types.SemanticTokenTypes.EnumMember,
        Role.NUMBER: types.SemanticTokenTypes.Number,
        Role.STRING: types.SemanticTokenTypes.String,
        Role.NAME: types.SemanticTokenTypes.Namespace,
        Role.AGENT: types.SemanticTokenTypes.Namespace,
        Role.COMMENT: types.SemanticTokenTypes.Comment,
    }
)
_PERCEPT = types.SemanticTokenTypes.Type
_MODIFIERS = (
    types.SemanticTokenModifiers.Definition,
    types.SemanticTokenModifiers.Deprecated,
    types.SemanticTokenModifiers.DefaultLibrary,
)
_TYPE_ORDER = tuple(dict.fromkeys([*_TYPES.values(), _PERCEPT]))

LEGEND = types.SemanticTokensLegend(
    token_types=[each.value for each in _TYPE_ORDER],
    token_modifiers=[each.value for each in _MODIFIERS],
)
"""The names of the types and modifiers that `semantic_tokens` gives by number."""


def semantic_tokens(project: Project) -> types.SemanticTokens:
    """Give the tokens of a text, each by its distance from the one before it."""
    positions = project.positions()
    data: list[int] = []
    line = column = 0
    for word in project.index.words(project.path):
        kind = _kind(project, word)
        if kind is None:
            continue
        modifiers = sum(1 << _MODIFIERS.index(each) for each in _modifiers(word))
        # A token must not run over the end of a line.
        for start, stop in positions.lines(word.start, word.stop):
            place = positions.position(start)
            same = place.line == line
            data += [
                place.line - line,
                place.character - column if same else place.character,
                positions.length(start, stop),
                _TYPE_ORDER.index(kind),
                modifiers,
            ]
            line, column = place.line, place.character
    return types.SemanticTokens(data=data)


def _kind(project: Project, word: Occurrence) -> types.SemanticTokenTypes | None:
    if word.role is Role.PREDICATE and Origin.PERCEPT in project.index.origins(word.name):
        return _PERCEPT
    return _TYPES.get(word.role)


def _modifiers(word: Occurrence) -> Iterator[types.SemanticTokenModifiers]:
    if word.defines:
        yield types.SemanticTokenModifiers.Definition
    if word.role is Role.FUNCTION and word.name in FUNCTIONS:
        yield types.SemanticTokenModifiers.DefaultLibrary
    keyword = None
    if word.role is Role.FORM:
        keyword = FORMS.get(word.name)
    elif word.role is Role.FIELD:
        keyword = field_named(word.name, word.place.form)
    if keyword is not None and keyword.modern:
        yield types.SemanticTokenModifiers.Deprecated
