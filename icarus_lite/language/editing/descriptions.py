"""What a word of a domain file means, in a few lines of Markdown."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Collection, Mapping, Sequence

from icarus_lite.language.checking.vocabulary import Origin
from icarus_lite.language.editing.index import Index, Located, Thing
from icarus_lite.language.editing.occurrences import Occurrence, Role
from icarus_lite.language.functions import FUNCTIONS, Function
from icarus_lite.language.keywords import FORMS, MOMENTS, NOT, Keyword, field_named
from icarus_lite.language.wording import listing
from icarus_lite.symbols import ATTACHED

_MOST_CLAUSES = 4
_MOST_USERS = 12
_KINDS = {
    Origin.PERCEPT: "percept type",
    Origin.CONCEPT: "concept",
    Origin.EFFECT: "asserted by effects",
    Origin.GIVEN: "given by tasks",
    Origin.ATTACHMENT: "attachment hierarchy",
}
_ATTACHED = (
    "`(attached child parent)` is believed from the action that attaches on until the one "
    "that detaches. A child has one parent: a new one replaces the old."
)
_COMMENT_LINES = re.compile(r"(?:^[ \t]*;[^\n]*\n)+[ \t(]*\Z", re.MULTILINE)


def describe(
    index: Index,
    path: str,
    word: Occurrence,
    *,
    commands: Collection[str] = (),
    functions: Mapping[str, Function] = FUNCTIONS,
) -> str:
    """Say what a word means: its kind, where it comes from, who uses it.

    Args:
        index: The domain.
        path: The file in which the word stands.
        word: The word.
        commands: The commands that drivers are known to offer, without the star.
        functions: What tests may call.

    Returns:
        Markdown, or an empty text if there is nothing to say.
    """
    match word.role:
        case Role.FORM | Role.FIELD | Role.NOT | Role.MOMENT:
            return _keyword(word)
        case Role.FUNCTION:
            return _function(functions.get(word.name))
        case Role.COMMAND:
            offered = " that the arm's driver offers" if word.name in commands else ""
            return f"**`*{word.name}`** · command for the driver{offered}"
    thing = index.thing(path, word)
    return _thing(index, thing, word) if thing else ""


def _thing(index: Index, thing: Thing, word: Occurrence) -> str:
    match word.role:
        case Role.PREDICATE | Role.SKILL:
            return _defined(index, thing)
        case Role.ATTRIBUTE:
            return _attribute(index, thing)
        case Role.VARIABLE:
            return _variable(index, thing)
        case Role.AGENT:
            users = _users(index, thing, index.definitions(thing))
            return f"**`{thing.name}`** · another agent\n\n{users}"
    of = f"value of `^{word.attribute}` of `{word.owner}`" if word.attribute else "symbol"
    return f"**`{word.name}`** · {of}"


def kinds_of(index: Index, thing: Thing) -> str:
    """Say what kind of predicate or skill this is, in a few words."""
    if thing.role is Role.SKILL:
        return "skill" if index.definitions(thing) else "action that no skill of the domain is for"
    kinds = [_KINDS[origin] for origin in index.origins(thing.name)]
    return listing(kinds) or "nothing defines it"


def _keyword(word: Occurrence) -> str:
    keyword: Keyword | None
    match word.role:
        case Role.NOT:
            keyword, kind = NOT, "negation"
        case Role.FORM:
            keyword, kind = FORMS.get(word.name), "form"
        case Role.MOMENT:
            keyword, kind = MOMENTS[word.place.form].get(word.name), "moment to stop at"
        case _:
            keyword, kind = field_named(word.name, word.place.form), "field"
    return f"**`{word.name}`** · {kind}\n\n{keyword.documentation}" if keyword else ""


def _function(function: Function | None) -> str:
    if function is None:
        return ""
    text = f"**`{function.name}`** · function of {function.arity}, gives a {function.gives}"
    return f"{text}\n\n{function.documentation}"


def _defined(index: Index, thing: Thing) -> str:
    """Describe a predicate or skill."""
    definitions = index.definitions(thing)
    parts = [f"**`{thing.name}`** · {kinds_of(index, thing)}"]
    if thing.name == ATTACHED and thing.role is Role.PREDICATE:
        parts.append(_ATTACHED)
    if definitions:
        # The comment above a skill speaks of the skill, not of what its effects assert.
        is_own = definitions[0].occurrence.place.clause == thing.name
        comment = _comment_above(index, definitions[0]) if is_own else ""
        parts += [comment] if comment else []
        parts.append(_code(index, definitions))
    parts.append(_users(index, thing, definitions))
    return "\n\n".join(parts)


def _attribute(index: Index, thing: Thing) -> str:
    parts = [f"**`^{thing.name}`** · attribute of `{thing.owner}`"]
    values = index.values(thing)
    if values:
        parts.append(f"Values that occur: {listing(f'`{value}`' for value in values)}.")
    parts.append(_users(index, thing, index.definitions(thing)))
    return "\n\n".join(parts)


def _variable(index: Index, thing: Thing) -> str:
    found = [located.occurrence for located in index.occurrences(thing)]
    clause = found[0].place.clause
    title = f"**`{thing.name}`** · variable" + (f" of `{clause}`" if clause else "")
    conditions = [word for word in found if word.place.field not in ("", ":tests", ":binds")]
    positive = [word for word in conditions if not word.place.negated]
    if conditions and not positive and all(word.place.field for word in found):
        return f"{title}\n\nIt occurs only inside `not`, which reads: there is none."
    stands = dict.fromkeys(
        f"the `^{word.attribute}` of `{word.owner}`" if word.attribute else f"`{word.owner}`"
        for word in positive
        if word.owner and word.place.field == ":elements"
    )
    return f"{title}\n\nBound by {listing(stands)}." if stands else title


def _code(index: Index, definitions: Sequence[Located]) -> str:
    """Quote the clauses that define something."""
    clauses = list(dict.fromkeys(_dedented(index, located) for located in definitions))
    text = "\n".join(clauses[:_MOST_CLAUSES])
    more = len(clauses) - _MOST_CLAUSES
    return f"```icarus\n{text}\n```" + (f"\n\n… and {more} more" if more > 0 else "")


def _dedented(index: Index, located: Located) -> str:
    """Give a clause as if it stood at the margin."""
    text = index.text(located.path)
    start = located.occurrence.place.scope
    margin = start - (text.rfind("\n", 0, start) + 1)
    return textwrap.dedent(" " * margin + index.clause(located))


def _comment_above(index: Index, located: Located) -> str:
    """Give the comment that stands right above a definition, as prose."""
    before = index.text(located.path)[: located.occurrence.place.scope]
    tail = before[before.rfind("\n\n") + 1 :]
    match = _COMMENT_LINES.search(tail)
    if match is None:
        return ""
    lines = [line.strip().lstrip(";").strip() for line in match[0].splitlines()]
    return " ".join(line for line in lines if line.strip("("))


def _users(index: Index, thing: Thing, definitions: Sequence[Located]) -> str:
    """Say which clauses, tasks and tests use something."""
    defining = {(located.path, located.occurrence.start) for located in definitions}
    users: dict[str, None] = {}
    for located in index.occurrences(thing):
        if (located.path, located.occurrence.start) not in defining:
            users[_user(located.occurrence)] = None
    if not users:
        return "Nothing uses it."
    named = list(users)
    more = len(named) - _MOST_USERS
    shown = named[:_MOST_USERS] + ([f"{more} more"] if more > 0 else [])
    return f"Used by {listing(shown)}."


def _user(word: Occurrence) -> str:
    place = word.place
    match place.form:
        case "concepts" | "skills" | "percepts":
            return f"`{place.clause}`"
        case "attachments":
            return f"the attachment by `{place.clause}`"
        case "contradictions":
            return f"the contradiction of `{place.clause}`"
        case "task" | "long-term-goal":
            return f"{place.form.replace('-', ' ')} `{place.clause}`"
        case "test":
            return f"test “{place.clause}”"
    return f"`{place.form}`" if place.form else "a pattern"
