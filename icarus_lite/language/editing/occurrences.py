"""What each word of a domain file stands for, in sound files and in broken ones.

Every form is read by itself and nothing has to be complete, so an editor can colour, find and
rename in a text that the parser would refuse. What the parser accepts, this reads the same way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum

from icarus_lite.language.editing.lexemes import Kind, Lexeme, lexemes
from icarus_lite.language.editing.nesting import Group, Node, nest
from icarus_lite.language.keywords import FIELDS, FORMS, MOMENTS, NOT, Content, field_named
from icarus_lite.records import dataclass, replace


class Role(StrEnum):
    """What a word stands for."""

    FORM = "form"
    FIELD = "field"
    NOT = "not"
    PREDICATE = "predicate"
    SKILL = "skill"
    COMMAND = "command"
    FUNCTION = "function"
    ATTRIBUTE = "attribute"
    VARIABLE = "variable"
    SYMBOL = "symbol"
    NUMBER = "number"
    STRING = "string"
    NAME = "name"
    MOMENT = "moment"
    AGENT = "agent"
    COMMENT = "comment"
    PARENTHESIS = "parenthesis"
    ILLEGAL = "illegal"


@dataclass(frozen=True, slots=True)
class Place:
    """Where in the file a word stands.

    Args:
        form: The modern name of its top-level form; empty in a fragment.
        field: The modern name of its field; empty in a head, or in a form without fields.
        clause: What the clause, task or test is called.
        scope: The offset at which the clause, or the form without clauses, begins.
        end: The offset behind it.
        negated: Whether it stands inside `not`.
    """

    form: str = ""
    field: str = ""
    clause: str = ""
    scope: int = 0
    end: int = 0
    negated: bool = False


@dataclass(frozen=True, slots=True)
class Occurrence:
    """A word, what it stands for, and where.

    Args:
        role: What it stands for.
        name: Without the marker of an attribute or command; a variable's has its question mark.
        start: The offset of its first character.
        stop: The offset behind its last one.
        place: Where it stands.
        owner: For an attribute, an attribute's value or an argument, the name of the pattern.
        attribute: For the value of an attribute, the attribute.
        defines: Whether this is where the thing is defined.
    """

    role: Role
    name: str
    start: int
    stop: int
    place: Place
    owner: str = ""
    attribute: str = ""
    defines: bool = False


_PLAIN = {
    Kind.NUMBER: Role.NUMBER,
    Kind.STRING: Role.STRING,
    Kind.VARIABLE: Role.VARIABLE,
    Kind.SYMBOL: Role.SYMBOL,
    Kind.HAT: Role.ATTRIBUTE,
    Kind.STAR: Role.ATTRIBUTE,
    Kind.FIELD: Role.FIELD,
}
_MARKED = (Kind.HAT, Kind.STAR)
_HEADS = {"concepts": Role.PREDICATE, "skills": Role.SKILL, "attachments": Role.SKILL}
_NAMED = ("domain", "task", "test", "long-term-goal")
_NAMELIKE = (Kind.SYMBOL, Kind.NUMBER, Kind.STRING)


def occurrences(text: str) -> tuple[Occurrence, ...]:
    """Say of every word, comment and parenthesis of a text what it stands for, in order."""
    words = lexemes(text)
    known = {found.start: found for found in _forms(nest(text, words))}
    return tuple(known.get(word.start) or _unplaced(word) for word in words)


def _unplaced(word: Lexeme) -> Occurrence:
    if word.kind is Kind.COMMENT:
        role = Role.COMMENT
    elif word.kind in (Kind.OPEN, Kind.CLOSE):
        role = Role.PARENTHESIS
    else:
        role = _PLAIN.get(word.kind, Role.ILLEGAL)
    return Occurrence(role, word.text, word.start, word.stop, Place())


def _forms(forest: Sequence[Node]) -> Iterator[Occurrence]:
    for node in forest:
        if isinstance(node, Group):
            yield from _form(node)


def _form(group: Group) -> Iterator[Occurrence]:
    first = group.first
    if first is not None and first.text in FORMS:
        keyword = FORMS[first.text]
        name = keyword.modern or keyword.name
        place = Place(form=name, scope=group.start, end=group.stop)
        yield Occurrence(Role.FORM, first.text, first.start, first.stop, place)
        yield from _content(group.items[1:], place, keyword.content)
    elif first is not None:  # a pattern, quoted by itself; or a form with a wrong name
        yield from _condition(group, Place(scope=group.start, end=group.stop), Role.PREDICATE)
    elif group.items:  # a clause, quoted without its form
        yield from _clause(group, "")


def _content(items: Sequence[Node], place: Place, content: Content) -> Iterator[Occurrence]:
    groups = [item for item in items if isinstance(item, Group)]
    match content:
        case Content.TYPES:
            for group in groups:
                yield from _percept_type(group, place.form)
        case Content.CLAUSES:
            for group in groups:
                yield from _clause(group, place.form)
        case Content.CONDITIONS | Content.AGENTS:
            yield from _entries(items, place, content)
        case _:
            yield from _named(items, place)


def _named(items: Sequence[Node], place: Place) -> Iterator[Occurrence]:
    """Read a form that has a name of its own, and perhaps a title and fields."""
    word = items[0] if items else None
    if place.form in _NAMED and isinstance(word, Lexeme) and word.kind in _NAMELIKE:
        place = replace(place, clause=word.text.strip('"'))
        yield Occurrence(Role.NAME, place.clause, word.start, word.stop, place, defines=True)
        items = items[1:]
    yield from _fields(items, place)


def _percept_type(group: Group, form: str) -> Iterator[Occurrence]:
    first = group.first
    if first is None:
        return
    place = Place(form=form, clause=first.text, scope=group.start, end=group.stop)
    if first.kind is Kind.SYMBOL:
        yield _word(first, Role.PREDICATE, place, defines=True)
    field = ""
    for item in group.items[1:]:
        if isinstance(item, Group):
            continue
        if item.kind in _MARKED:
            yield _word(item, Role.ATTRIBUTE, place, owner=first.text, defines=True)
        elif item.kind is Kind.FIELD:
            field = item.text
            yield _word(item, Role.FIELD, place)
        elif item.kind is Kind.SYMBOL and field in FIELDS:
            yield _word(item, Role.PREDICATE, replace(place, field=field))


def _clause(group: Group, form: str) -> Iterator[Occurrence]:
    head = group.items[0] if group.items else None
    if not isinstance(head, Group):
        return
    called = head.first.text if head.first else ""
    place = Place(form=form, clause=called, scope=group.start, end=group.stop)
    role = _HEADS.get(form, Role.PREDICATE)
    yield from _atom(head, place, role, defines=form in ("concepts", "skills"))
    yield from _fields(group.items[1:], place)


def _fields(items: Sequence[Node], place: Place) -> Iterator[Occurrence]:
    """Read `:field value …` again and again; what stands before the first is read as terms."""
    content, values = Content.TERMS, list[Node]()
    for item in items:
        if isinstance(item, Lexeme) and item.kind is Kind.FIELD:
            yield from _entries(values, place, content)
            known = field_named(item.text, place.form)
            modern = (known.modern or known.name) if known else item.text
            place = replace(place, field=modern)
            yield _word(item, Role.FIELD, place)
            content, values = (known.content if known else Content.CONDITIONS), []
        else:
            values.append(item)
    yield from _entries(values, place, content)


def _entries(values: Sequence[Node], place: Place, content: Content) -> Iterator[Occurrence]:
    """Read the values of a field: entries one after another, or a list of them."""
    for value in values:
        if content in (Content.MOMENTS, Content.AGENTS):
            read = _moment if content is Content.MOMENTS else _agent
            for word in value.items if isinstance(value, Group) else (value,):
                yield from read(word, place)
        elif isinstance(value, Lexeme):
            yield from _term(value, place)
        elif isinstance(value.items[0] if value.items else None, Group):
            for entry in value.items:
                if isinstance(entry, Lexeme):
                    yield from _term(entry, place)
                else:
                    yield from _entry(entry, place, content)
        else:
            yield from _entry(value, place, content)


def _entry(group: Group, place: Place, content: Content) -> Iterator[Occurrence]:
    match content:
        case Content.CALLS:
            yield from _call(group, place)
        case Content.BINDS:
            for item in group.items:
                yield from (_term(item, place) if isinstance(item, Lexeme) else _call(item, place))
        case Content.COMMANDS:
            yield from _atom(group, place, Role.COMMAND)
        case Content.SKILLS:
            yield from _atom(group, place, Role.SKILL)
        case Content.CYCLES:
            yield from _fields(group.items, place)
        case Content.TERMS:
            for item in group.items:
                yield from (_term(item, place) if isinstance(item, Lexeme) else ())
        case _:
            yield from _condition(group, place, Role.PREDICATE)


def _condition(group: Group, place: Place, role: Role) -> Iterator[Occurrence]:
    if group.first is None or group.first.text != NOT.name:
        defines = place.form == "skills" and place.field == ":effects" and not place.negated
        yield from _atom(group, place, role, defines=defines)
        return
    yield _word(group.first, Role.NOT, place)
    within = replace(place, negated=True)
    for item in group.items[1:]:
        if isinstance(item, Group):
            yield from _condition(item, within, role)
        else:
            yield from _term(item, within)


def _atom(group: Group, place: Place, role: Role, *, defines: bool = False) -> Iterator[Occurrence]:
    """Read a pattern: its name, arguments, and attributes with their values."""
    first = group.first
    owner = ""
    if first is not None:
        is_name = first.kind is Kind.SYMBOL or (first.kind is Kind.STAR and role is Role.COMMAND)
        owner = first.text.lstrip("*")
        if is_name:
            yield _word(first, role, place, defines=defines)
        else:
            yield from _term(first, place)
    attribute = ""
    for item in group.items[1:] if first else group.items:
        if isinstance(item, Group):
            yield from _condition(item, place, role)
            attribute = ""
        elif item.kind in _MARKED:
            attribute = item.text[1:]
            yield _word(item, Role.ATTRIBUTE, place, owner=owner, defines=defines)
        else:
            yield from _term(item, place, owner, attribute)
            attribute = ""


def _call(group: Group, place: Place) -> Iterator[Occurrence]:
    """Read an expression, its arguments included."""
    for position, item in enumerate(group.items):
        if isinstance(item, Group):
            yield from _call(item, place)
        elif position == 0 and (item.kind is Kind.SYMBOL or item.text == "*"):
            yield _word(item, Role.FUNCTION, place)
        else:
            yield from _term(item, place)


def _term(word: Lexeme, place: Place, owner: str = "", attribute: str = "") -> Iterator[Occurrence]:
    role = _PLAIN.get(word.kind)
    if role is not None:
        name = word.text[1:] if role is Role.ATTRIBUTE else word.text
        yield Occurrence(role, name, word.start, word.stop, place, owner, attribute)


def _moment(word: Node, place: Place) -> Iterator[Occurrence]:
    if not isinstance(word, Lexeme):
        return
    if word.text in MOMENTS.get(place.form, ()):
        yield Occurrence(Role.MOMENT, word.text, word.start, word.stop, place)
    else:
        yield from _term(word, place)


def _agent(word: Node, place: Place) -> Iterator[Occurrence]:
    if isinstance(word, Lexeme) and word.kind is Kind.SYMBOL:
        yield _word(word, Role.AGENT, place, defines=place.form == "agents")
    elif isinstance(word, Lexeme):
        yield from _term(word, place)


def _word(
    word: Lexeme, role: Role, place: Place, *, owner: str = "", defines: bool = False
) -> Occurrence:
    is_marked = role in (Role.ATTRIBUTE, Role.COMMAND) and word.kind in _MARKED
    name = word.text[1:] if is_marked else word.text
    return Occurrence(role, name, word.start, word.stop, place, owner, "", defines)
