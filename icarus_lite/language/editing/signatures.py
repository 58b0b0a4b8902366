"""What the pattern that is being written takes, and which of its arguments comes next."""

from __future__ import annotations

from collections.abc import Mapping

from icarus_lite.language.editing.index import Index
from icarus_lite.language.editing.lexemes import Kind, Lexeme, lexemes
from icarus_lite.language.editing.nesting import innermost, nest
from icarus_lite.language.editing.occurrences import Role
from icarus_lite.language.functions import FUNCTIONS, Function
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Signature:
    """The head of a pattern's definition.

    Args:
        label: The head, on one line: `(near ?a ?b)`.
        parameters: The stretch of the label that each argument takes.
        active: Which argument comes next, counted from 0; as many as there are behind the last.
        documentation: A sentence about it; may be empty.
    """

    label: str
    parameters: tuple[tuple[int, int], ...]
    active: int
    documentation: str = ""


def signature(
    index: Index, path: str, offset: int, *, functions: Mapping[str, Function] = FUNCTIONS
) -> Signature | None:
    """Say what the pattern or call around an offset takes, or None if that is not known.

    Args:
        index: The domain.
        path: The file, which must be in the index.
        offset: The place of the cursor.
        functions: What tests may call.
    """
    text = index.text(path)
    before = [word for word in lexemes(text) if word.stop <= offset and word.start < offset]
    group = innermost(nest(text, before))
    first = group.first if group else None
    if group is None or first is None or first.stop >= offset:
        return None
    word = index.at(path, first.start)
    # The word that is being written is the next argument until a blank ends it.
    given = [item for item in group.items[1:] if item.stop < offset]
    active = len(given)
    if word is None:
        return None
    if word.role is Role.FUNCTION:
        return _of_function(functions.get(word.name), active)
    thing = index.thing(path, word)
    if word.role not in (Role.PREDICATE, Role.SKILL) or thing is None:
        return None
    definitions = index.definitions(thing)
    if not definitions or any(
        (each.path, each.occurrence.start) == (path, word.start) for each in definitions
    ):
        return None
    if any(isinstance(item, Lexeme) and item.kind in (Kind.HAT, Kind.STAR) for item in given):
        active = len(text)  # attributes come after all arguments
    return _of_head(index.head(definitions[0]), active)


def _of_function(function: Function | None, active: int) -> Signature | None:
    if function is None:
        return None
    label = f"({function.name} …)"
    parameters = ((len(function.name) + 2, len(label) - 1),)
    return Signature(
        label, parameters, min(active, 0), f"{function.arity}. {function.documentation}"
    )


def _of_head(head: str, active: int) -> Signature:
    parameters = []
    for word in lexemes(head)[2:]:
        if word.kind is Kind.HAT:
            break
        if word.kind is not Kind.CLOSE:
            parameters.append((word.start, word.stop))
    return Signature(head, tuple(parameters), min(active, len(parameters)))
