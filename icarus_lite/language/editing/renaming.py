"""A new name for a thing, everywhere at once, or the reason why it cannot have it."""

from __future__ import annotations

from icarus_lite.errors import IcarusError
from icarus_lite.language.editing.index import Index, Located, Thing
from icarus_lite.language.editing.lexemes import Kind, word_kind
from icarus_lite.language.editing.occurrences import Occurrence, Role
from icarus_lite.language.keywords import NOT
from icarus_lite.symbols import ATTACHED

_MARKERS = {Role.VARIABLE: "?", Role.ATTRIBUTE: "^"}
_RENAMEABLE = (Role.PREDICATE, Role.SKILL, Role.ATTRIBUTE, Role.VARIABLE, Role.AGENT)
_REASONS = {
    Role.FORM: "`{name}` is a word of the language",
    Role.FIELD: "`{name}` is a word of the language",
    Role.NOT: "`{name}` is a word of the language",
    Role.MOMENT: "`{name}` is a word of the language",
    Role.FUNCTION: "`{name}` is a function of the language",
    Role.COMMAND: "`*{name}` is a command of the driver, which gives it its name",
    Role.SYMBOL: "`{name}` is a value: percepts carry it, so that only its source can rename it",
}


class RenameError(IcarusError, ValueError):
    """A thing cannot be renamed; the message says why."""


def renameable(index: Index, path: str, word: Occurrence | None) -> Thing:
    """Give the thing that a word stands for, if it can be renamed.

    Raises:
        RenameError: It cannot.
    """
    thing = index.thing(path, word) if word else None
    if word is None or thing is None or thing.role not in _RENAMEABLE:
        reason = _REASONS.get(word.role, "") if word else ""
        name = word.name if word else ""
        raise RenameError(reason.format(name=name) or "there is no name here that can be changed")
    if thing == Thing(Role.PREDICATE, ATTACHED):
        raise RenameError(f"`{ATTACHED}` is the language's own predicate of what moves with what")
    return thing


def rename(index: Index, thing: Thing, name: str) -> tuple[tuple[Located, str], ...]:
    """Give the words to replace, each with what to write instead.

    Args:
        index: The domain.
        thing: What is to be renamed.
        name: The new name; the marker of a variable or attribute may be left out.

    Raises:
        RenameError: The name is no legal word, or stands for something else already.
    """
    name = _legal(thing.role, name.strip())
    if name == thing.name:
        return ()
    _require_free(index, thing, name)
    return tuple(
        (located, _replacement(index, located, thing.role, name))
        for located in index.occurrences(thing)
    )


def _legal(role: Role, name: str) -> str:
    """Give the name as the index has it: a variable with its mark, an attribute without."""
    marker = _MARKERS.get(role, "")
    bare = name.removeprefix(marker)
    if word_kind(bare) is not Kind.SYMBOL or bare == "*":
        if word_kind(bare) is Kind.NUMBER:
            raise RenameError(f"`{bare}` is a number, not a name")
        raise RenameError(
            f"`{name}` is not a word of the language: "
            "names hold no blanks, parentheses, quotes, and none of ? : ^ * | #"
        )
    if bare == NOT.name and role is Role.PREDICATE:
        raise RenameError(f"`{bare}` is a word of the language")
    return f"?{bare}" if role is Role.VARIABLE else bare


def _require_free(index: Index, thing: Thing, name: str) -> None:
    other = Thing(thing.role, name, thing.owner, thing.path, thing.scope)
    if thing.role is Role.PREDICATE and name == ATTACHED:
        raise RenameError(f"`{ATTACHED}` is the language's own predicate of what moves with what")
    if thing.role is Role.ATTRIBUTE:
        for owner in (thing.owner, *index.subtypes(thing.owner)):
            if name in index.attributes(owner):
                raise RenameError(f"`{owner}` has an attribute `^{name}` already")
    taken = index.occurrences(other)
    if not taken:
        return
    line = index.text(taken[0].path).count("\n", 0, taken[0].occurrence.start) + 1
    where = f"line {line}" if taken[0].path == thing.path or not thing.path else taken[0].path
    what = {Role.PREDICATE: "predicate", Role.SKILL: "skill"}.get(thing.role, str(thing.role))
    raise RenameError(f"there is a {what} `{name}` already, in {where}")


def _replacement(index: Index, located: Located, role: Role, name: str) -> str:
    """Write the name as it must stand here: an attribute keeps the marker that it has."""
    if role is not Role.ATTRIBUTE:
        return name
    return index.text(located.path)[located.occurrence.start] + name
