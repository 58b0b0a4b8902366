"""The table of contents of a domain file: its forms, and what each of them defines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum
from itertools import islice, pairwise

from icarus_lite.language.editing.occurrences import Occurrence, Role
from icarus_lite.records import dataclass


class EntryKind(StrEnum):
    """What an entry of the outline is."""

    FORM = "form"
    PERCEPT = "percept"
    CONCEPT = "concept"
    SKILL = "skill"
    ATTACHMENT = "attachment"
    CONTRADICTION = "contradiction"
    TASK = "task"
    TEST = "test"
    DOMAIN = "domain"
    GOAL = "goal"


@dataclass(frozen=True, slots=True)
class Entry:
    """A form or a part of one.

    Args:
        kind: What it is.
        name: What it is called.
        detail: The rest of its head, such as its arguments or attributes.
        start: The offset of its opening parenthesis.
        stop: The offset behind its closing one.
        name_start: The offset of its name.
        name_stop: The offset behind its name.
        children: What it defines, in order.
    """

    kind: EntryKind
    name: str
    detail: str
    start: int
    stop: int
    name_start: int
    name_stop: int
    children: tuple[Entry, ...] = ()


_CLAUSES = {
    "percepts": EntryKind.PERCEPT,
    "concepts": EntryKind.CONCEPT,
    "skills": EntryKind.SKILL,
    "attachments": EntryKind.ATTACHMENT,
    "contradictions": EntryKind.CONTRADICTION,
}
_NAMED = {
    "domain": EntryKind.DOMAIN,
    "task": EntryKind.TASK,
    "test": EntryKind.TEST,
    "long-term-goal": EntryKind.GOAL,
}
_HEAD_ROLES = (Role.PREDICATE, Role.SKILL)
_DETAIL_ROLES = (Role.VARIABLE, Role.ATTRIBUTE, Role.SYMBOL, Role.NUMBER, Role.STRING)


def outline(words: Sequence[Occurrence]) -> tuple[Entry, ...]:
    """List the forms of a text with the clauses, percept types, tasks and tests in them."""
    entries = []
    starts = [i for i, word in enumerate(words) if word.role is Role.FORM]
    for first, behind in pairwise([*starts, len(words)]):
        form = words[first]
        inside = [w for w in words[first + 1 : behind] if w.start < form.place.end]
        if form.place.form in _CLAUSES:
            kind = _CLAUSES[form.place.form]
            children = tuple(_clauses(inside, kind))
            entries.append(_entry(EntryKind.FORM, form, form.name, "", children))
        else:
            kind = _NAMED.get(form.place.form, EntryKind.FORM)
            entries.append(_named(form, inside, kind))
    return tuple(entries)


def _named(form: Occurrence, inside: Sequence[Occurrence], kind: EntryKind) -> Entry:
    name = next((word for word in inside if word.role is Role.NAME), None)
    if name is None:
        return _entry(kind, form, form.name, "", ())
    title = next((word.name for word in inside if word.role is Role.STRING), "")
    detail = "" if kind is EntryKind.TEST else title.strip('"')
    return _entry(kind, name, name.name or form.name, detail, ())


def _clauses(inside: Sequence[Occurrence], kind: EntryKind) -> Iterable[Entry]:
    seen: set[int] = set()
    for position, word in enumerate(inside):
        place = word.place
        if word.role not in _HEAD_ROLES or place.field or place.scope in seen:
            continue
        seen.add(place.scope)
        head = []
        for other in islice(inside, position + 1, None):
            if other.start >= place.end:
                break
            if other.role in _DETAIL_ROLES and not other.place.field:
                head.append(other)
        marker = {Role.ATTRIBUTE: "^"}
        detail = " ".join(f"{marker.get(other.role, '')}{other.name}" for other in head)
        yield _entry(kind, word, word.name, detail, ())


def _entry(
    kind: EntryKind, word: Occurrence, name: str, detail: str, children: tuple[Entry, ...]
) -> Entry:
    place = word.place
    return Entry(kind, name, detail, place.scope, place.end, word.start, word.stop, children)
