"""PDDL files into their syntax tree, or into a list of everything that keeps them from one."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType

from icarus_lite.language.checking.report import Report
from icarus_lite.language.pddl.formulas import checked_fact, effects, formula, note_costs
from icarus_lite.language.pddl.nodes import Group, Node, Word, read_nodes
from icarus_lite.language.pddl.scope import RefusedError, Scope, pairs, typed_list
from icarus_lite.language.pddl.syntax import (
    OBJECT,
    And,
    Fact,
    PddlAction,
    PddlDomain,
    PddlProblem,
    Predicate,
    Rule,
    Typed,
)
from icarus_lite.language.syntax import NOWHERE, Source, Span
from icarus_lite.language.wording import closest

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.language.diagnostics import Diagnostic

_DOMAIN_SECTIONS = (
    ":requirements",
    ":types",
    ":constants",
    ":predicates",
    ":functions",
    ":derived",
    ":action",
)
_PROBLEM_SECTIONS = (":domain", ":requirements", ":objects", ":init", ":goal", ":metric")
_REPEATED = (":action", ":derived")
_REFUSED: Mapping[str, str] = MappingProxyType(
    {
        ":durative-action": "an action that takes time",
        ":process": "a continuous process",
        ":event": "an event of its own",
        ":constraints": "a constraint on the way to the goal",
        ":task": "a task of a hierarchy",
        ":method": "a method of a hierarchy",
        ":htn": "a network of tasks",
    }
)


def read_pddl_domain(source: Source) -> tuple[PddlDomain | None, tuple[Diagnostic, ...]]:
    """Read a PDDL domain.

    Returns:
        The domain, or None if there is an error among the diagnostics; and the diagnostics in
        the order of the text.
    """
    report = Report(source)
    try:
        domain: PddlDomain | None = _domain(Scope(report))
    except RefusedError:
        domain = None  # the reason is in the report
    return (None if report.has_errors else domain), report.findings()


def read_pddl_problem(
    source: Source, domain: PddlDomain
) -> tuple[PddlProblem | None, tuple[Diagnostic, ...]]:
    """Read a PDDL problem for a domain, as `read_pddl_domain` does."""
    report = Report(source)
    scope = Scope(
        report,
        {each.name: each.type for each in domain.types},
        {each.name: each.type for each in domain.constants},
        {each.name: each for each in domain.predicates},
        set(domain.derived),
    )
    try:
        problem: PddlProblem | None = _problem(scope, domain)
    except RefusedError:
        problem = None  # the reason is in the report
    return (None if report.has_errors else problem), report.findings()


def _domain(scope: Scope) -> PddlDomain:
    name, sections = _define("domain", _DOMAIN_SECTIONS, scope)
    kept = [section for section in sections if _accepted(section, _DOMAIN_SECTIONS, scope)]
    by_name = {section.head: section for section in kept if section.head not in _REPEATED}
    _types(by_name.get(":types"), scope)
    constants = _declared(by_name.get(":constants"), scope)
    scope.objects.update({each.name: each.type for each in constants})
    _predicates(by_name.get(":predicates"), scope)
    for section in kept:
        if section.head == ":derived" and len(section.items) > 1:
            head = section.items[1]
            scope.derived.update([head.head] if isinstance(head, Group) else [])
    if ":functions" in by_name:
        note_costs(by_name[":functions"], scope)
    rules: list[Rule] = []
    actions: dict[str, PddlAction] = {}
    for section in kept:
        try:
            if section.head == ":derived":
                rules.append(_rule(section, scope))
            elif section.head == ":action":
                action = _action(section, scope)
                if action.name in actions:
                    message = f"there are two actions `{action.name}`"
                    scope.refuse(section.span, "PDDL011", message, "give each its own name")
                actions[action.name] = action
        except RefusedError:
            continue  # so that the mistakes in other sections are found as well
    types = tuple(Typed(name, above) for name, above in scope.types.items())
    predicates = tuple(scope.predicates.values())
    return PddlDomain(name, types, constants, predicates, tuple(rules), tuple(actions.values()))


def _problem(scope: Scope, domain: PddlDomain) -> PddlProblem:
    name, sections = _define("problem", _PROBLEM_SECTIONS, scope)
    kept = [section for section in sections if _accepted(section, _PROBLEM_SECTIONS, scope)]
    by_name = {section.head: section for section in kept}
    _check_domain_name(by_name.get(":domain"), domain.name, scope)
    objects = _declared(by_name.get(":objects"), scope)
    for each in objects:
        if scope.objects.get(each.name, each.type) != each.type:
            message = f"`{each.name}` is a constant of the domain with another type"
            scope.report.error(each.span, "PDDL011", message, "remove it here")
    scope.objects.update({each.name: each.type for each in objects})
    init: dict[Fact, None] = {}
    for item in by_name[":init"].items[1:] if ":init" in by_name else ():
        try:
            fact = _initial(item, scope)
        except RefusedError:
            continue  # so that the mistakes in other facts are found as well
        if fact is not None:
            init[fact] = None
    if ":metric" in by_name:
        note_costs(by_name[":metric"], scope)
    goal = by_name.get(":goal")
    if goal is None:
        scope.refuse(_end(scope), "PDDL011", "the problem has no goal", "add (:goal (…))")
    if len(goal.items) != 2:
        scope.refuse(goal.span, "PDDL006", "a goal is one condition", "write (:goal (and …))")
    reached = formula(goal.items[1], scope)
    known = {each.name for each in domain.constants}
    others = tuple(each for each in objects if each.name not in known)
    return PddlProblem(name, domain.name, others, tuple(init), reached)


def _define(kind: str, sections: Collection[str], scope: Scope) -> tuple[str, list[Group]]:
    """Give the name and the sections of `(define (domain NAME) …)`."""
    top = read_nodes(scope.report)
    if top is None:
        raise RefusedError
    if not top:
        hint = f"a {kind} file is one (define ({kind} NAME) …)"
        scope.refuse(NOWHERE, "PDDL005", "there is nothing to read", hint)
    form = top[0]
    title = form.items[1] if len(form.items) > 1 else None
    if form.head != "define" or not isinstance(title, Group) or len(title.items) != 2:
        message = f"this is no PDDL {kind}"
        scope.refuse(form.span, "PDDL005", message, f"it begins (define ({kind} NAME) …)")
    name = title.items[1]
    if title.head != kind or not isinstance(name, Word):
        message = f"this is a {title.head or 'strange thing'}, where a {kind} is expected"
        scope.refuse(title.span, "PDDL005", message, "the domain comes first, then the problem")
    for extra in top[1:]:
        message = "a file holds one (define …)"
        scope.report.error(extra.span, "PDDL006", message, "put this into a file of its own")
    found = []
    for item in form.items[2:]:
        if isinstance(item, Group):
            found.append(item)
        else:
            hint = f"a section is a list: ({next(iter(sections))} …)"
            scope.report.error(item.span, "PDDL006", f"`{item}` is no section", hint)
    seen: set[str] = set()
    for section in found:
        if section.head in seen and section.head not in _REPEATED:
            message = f"there are two sections `{section.head}`"
            scope.report.error(section.span, "PDDL011", message, "put both into one")
        seen.add(section.head)
    return name.text, found


def _accepted(section: Group, known: Collection[str], scope: Scope) -> bool:
    """Tell whether a section is one to read; say why if it is not."""
    if section.head in known:
        return True
    if section.head in _REFUSED:
        message = f"`{section.head}` is {_REFUSED[section.head]}, which has no counterpart here"
        hint = "typed STRIPS with negative preconditions and derived predicates can be translated"
        scope.report.error(section.items[0].span, "PDDL007", message, hint)
        return False
    meant = closest(section.head, known)
    hint = f"did you mean `{meant}`?" if meant else f"sections are {' '.join(known)}"
    scope.report.error(section.span, "PDDL006", f"there is no section `{section.head}`", hint)
    return False


def _types(section: Group | None, scope: Scope) -> None:
    """Take in the hierarchy of types; a type that only stands above others counts as declared."""
    found = [each for each in _type_pairs(section, scope) if each[0].text != OBJECT]
    for word, above in found:
        if scope.types.get(word.text, above) != above:
            message = f"the type `{word}` is declared twice"
            scope.report.error(word.span, "PDDL011", message, "a type has one type above it")
            continue
        scope.types[word.text] = above
    for _, above in found:
        if above != OBJECT:
            scope.types.setdefault(above, OBJECT)
    for word, _ in found:
        name, seen = scope.types[word.text], {word.text}
        while name != OBJECT and name not in seen:
            seen.add(name)
            name = scope.types[name]
        if name == word.text:
            scope.types[word.text] = OBJECT
            message = f"the type `{word}` is above itself"
            scope.report.error(word.span, "PDDL012", message, "break the circle")


def _type_pairs(section: Group | None, scope: Scope) -> list[tuple[Word, str]]:
    given = pairs(section.items[1:] if section else (), scope)
    return [(word, OBJECT if above is None else above.text) for word, above in given]


def _declared(section: Group | None, scope: Scope) -> tuple[Typed, ...]:
    if section is None:
        return ()
    return typed_list(section.items[1:], scope, variables=False)


def _predicates(section: Group | None, scope: Scope) -> None:
    for item in section.items[1:] if section else ():
        name, parameters = _pattern(item, scope, widened=True)
        if name.text in scope.predicates:
            message = f"the predicate `{name}` is declared twice"
            scope.report.error(name.span, "PDDL011", message, "remove one of them")
            continue
        scope.predicates[name.text] = Predicate(name.text, parameters, item.span)


def _pattern(item: Node, scope: Scope, *, widened: bool = False) -> tuple[Word, tuple[Typed, ...]]:
    """Read `(on ?x ?y - block)`."""
    if isinstance(item, Word) or not item.items or not isinstance(item.items[0], Word):
        message = "a predicate is declared with its variables: (on ?x ?y - block)"
        scope.refuse(item.span, "PDDL006", message)
    parameters = typed_list(item.items[1:], scope, variables=True, widened=widened)
    return item.items[0], parameters


def _rule(section: Group, scope: Scope) -> Rule:
    if len(section.items) != 3:
        message = "a derived predicate has a head and one condition"
        scope.refuse(section.span, "PDDL006", message, "write (:derived (above ?x ?y) (…))")
    name, parameters = _pattern(section.items[1], scope)
    declared = scope.predicate(name, len(parameters), section.items[1].span).parameters
    narrowed = tuple(
        _narrower(ours, theirs, scope) for ours, theirs in zip(parameters, declared, strict=True)
    )
    body = formula(section.items[2], scope.within(narrowed))
    return Rule(name.text, narrowed, body, section.span)


def _narrower(ours: Typed, theirs: Typed, scope: Scope) -> Typed:
    """Give a rule's variable with the narrower of its own type and the declared one."""
    if scope.is_a(ours.type, theirs.type):
        return ours
    if not scope.is_a(theirs.type, ours.type):
        message = f"{ours.name} is a {ours.type} here, but a {theirs.type} in (:predicates …)"
        scope.refuse(ours.span, "PDDL010", message)
    return Typed(ours.name, theirs.type, ours.span)


def _action(section: Group, scope: Scope) -> PddlAction:
    name = section.items[1] if len(section.items) > 1 else None
    if not isinstance(name, Word):
        message = "an action begins with its name: (:action move :parameters …)"
        scope.refuse(section.span, "PDDL006", message)
    fields: dict[str, Node] = {}
    entries = iter(section.items[2:])
    for keyword in entries:
        value = next(entries, None)
        legal = (":parameters", ":precondition", ":effect")
        if not isinstance(keyword, Word) or keyword.text not in legal or value is None:
            shown = keyword.text if isinstance(keyword, Word) else f"({keyword.head} …)"
            message = f"`{shown}` is no field of an action, or has no value"
            scope.refuse(keyword.span, "PDDL006", message, f"fields are {' '.join(legal)}")
        if keyword.text in fields:
            scope.refuse(keyword.span, "PDDL011", f"`{keyword}` is given twice")
        fields[keyword.text] = value
    given = fields.get(":parameters", Group((), section.span))
    if isinstance(given, Word):
        scope.refuse(given.span, "PDDL006", "parameters are a list: (?x ?y - block)")
    parameters = typed_list(given.items, scope, variables=True)
    inner = scope.within(parameters)
    condition = fields.get(":precondition")
    return PddlAction(
        name.text,
        parameters,
        And() if condition is None else formula(condition, inner),
        tuple(effects(fields[":effect"], inner)) if ":effect" in fields else (),
        span=section.span,
    )


def _initial(item: Node, scope: Scope) -> Fact | None:
    """Read a fact of `:init`; None for what is false anyway, and for costs."""
    if isinstance(item, Group) and item.head == "=" and len(item.items) == 3:
        note_costs(item, scope)
        return None
    if isinstance(item, Group) and item.head == "not" and len(item.items) == 2:
        checked_fact(item.items[1], scope, "an initial state")
        return None
    is_timed = (
        isinstance(item, Group)
        and item.head == "at"
        and len(item.items) == 3
        and isinstance(item.items[2], Group)
    )
    if is_timed:
        message = "a fact that comes true at a later time has no counterpart here"
        scope.refuse(item.span, "PDDL007", message)
    return checked_fact(item, scope, "an initial state")


def _check_domain_name(section: Group | None, name: str, scope: Scope) -> None:
    given = section.items[1] if section is not None and len(section.items) == 2 else None
    if section is None or not isinstance(given, Word):
        span = _end(scope) if section is None else section.span
        message = "the problem does not say which domain it is for"
        scope.report.error(span, "PDDL011", message, f"add (:domain {name})")
    elif given.text != name:
        message = f"the problem is for the domain `{given}`, not for `{name}`"
        scope.report.error(
            given.span, "PDDL005", message, "give the two files that belong together"
        )


def _end(scope: Scope) -> Span:
    """Give the place of the last character of the text."""
    lines = scope.report.source.text.rstrip().split("\n")
    column = max(len(lines[-1]), 1)
    return Span(len(lines), column, len(lines), column + 1)
