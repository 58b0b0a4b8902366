"""Conditions and effects of PDDL: which of them mean something here, and which are refused."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType

from icarus_lite.language.pddl.nodes import Group, Node, Word
from icarus_lite.language.pddl.scope import Scope, typed_list
from icarus_lite.language.pddl.syntax import (
    And,
    Effect,
    Equal,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    Typed,
)

_NUMERIC = "numbers that actions change have no counterpart here; only costs are left out"
_REFUSED: Mapping[str, tuple[str, str]] = MappingProxyType(
    {
        "forall": (
            "a condition over all objects",
            "say it by its opposite: derive what must not be, and negate that",
        ),
        "imply": ("an implication", "write (or (not …) …) instead"),
        "when": ("a conditional effect", "write one action for each case"),
        "preference": ("a preference", "goals here are to be reached, not weighed"),
        "increase": ("a numeric effect", _NUMERIC),
        "decrease": ("a numeric effect", _NUMERIC),
        "assign": ("a numeric effect", _NUMERIC),
        "scale-up": ("a numeric effect", _NUMERIC),
        "scale-down": ("a numeric effect", _NUMERIC),
        "<": ("a numeric condition", _NUMERIC),
        ">": ("a numeric condition", _NUMERIC),
        "<=": ("a numeric condition", _NUMERIC),
        ">=": ("a numeric condition", _NUMERIC),
        "oneof": ("an effect that may differ", "skills have the effects that are expected of them"),
        "probabilistic": (
            "an effect that may differ",
            "skills have the effects that are expected of them",
        ),
    }
)


def formula(node: Node, scope: Scope) -> Formula:  # noqa: PLR0911 - one for each construct
    """Read a condition. Raises RefusedError, with the reason in the report."""
    if isinstance(node, Word):
        scope.refuse(node.span, "PDDL006", f"`{node}` is no condition", f"write ({node} …)")
    if not node.items:
        return And(span=node.span)
    parts = node.items[1:]
    match node.head:
        case "and":
            return And(tuple(formula(part, scope) for part in parts), node.span)
        case "or":
            return Or(tuple(formula(part, scope) for part in parts), node.span)
        case "not":
            return Not(formula(_only(node, scope), scope), node.span)
        case "exists":
            bound, inner = _quantified(node, scope)
            return Exists(bound, formula(inner, scope.within(bound)), node.span)
        case "=":
            return _equal(node, scope)
        case _:
            refuse_construct(node, scope)
            return fact(node, scope)


def effects(node: Node, scope: Scope) -> Iterator[Effect]:
    """Read an effect. Costs are left out, with a note; everything else unknown is refused."""
    if isinstance(node, Word):
        scope.refuse(node.span, "PDDL006", f"`{node}` is no effect", f"write ({node} …)")
    if node.head == "and" or not node.items:
        for part in node.items[1:]:
            yield from effects(part, scope)
    elif node.head == "forall":
        yield from _removals(node, scope)
    elif node.head == "increase" and _is_cost(node):
        note_costs(node, scope)
    elif node.head == "not":
        yield Effect(_changed(_only(node, scope), scope), negated=True)
    else:
        yield Effect(_changed(node, scope))


def fact(node: Group, scope: Scope) -> Fact:
    """Read a predicate with its terms."""
    head = node.items[0] if node.items else None
    if not isinstance(head, Word):
        scope.refuse(node.span, "PDDL006", "a condition begins with a predicate: (on ?x ?y)")
    declared = scope.predicate(head, len(node.items) - 1, node.span)
    terms = [scope.term(item) for item in node.items[1:]]
    for (name, kind), parameter, item in zip(
        terms, declared.parameters, node.items[1:], strict=True
    ):
        if not scope.is_a(kind, parameter.type) and not scope.is_a(parameter.type, kind):
            message = f"`{name}` is a {kind}, but `{head}` takes a {parameter.type} here"
            scope.refuse(item.span, "PDDL010", message)
    return Fact(head.text, tuple(name for name, _ in terms), node.span)


def checked_fact(node: Node, scope: Scope, what: str) -> Fact:
    """Read a fact that is made true: not derived, every argument of the declared type."""
    if isinstance(node, Word):
        scope.refuse(node.span, "PDDL006", f"`{node}` is no fact", f"write ({node} …)")
    refuse_construct(node, scope)
    found = fact(node, scope)
    if found.predicate in scope.derived:
        message = f"`{found.predicate}` is derived, and {what} cannot state it"
        hint = "state what its (:derived …) speaks of"
        scope.refuse(node.span, "PDDL015", message, hint)
    declared = scope.predicates[found.predicate].parameters
    for item, parameter in zip(node.items[1:], declared, strict=True):
        name, kind = scope.term(item)
        if not scope.is_a(kind, parameter.type):
            message = f"`{name}` is a {kind}, but `{found.predicate}` takes a {parameter.type} here"
            hint = f"declare it as {parameter.type}, or the predicate more widely"
            scope.refuse(item.span, "PDDL010", message, hint)
    return found


def refuse_construct(node: Group, scope: Scope) -> None:
    """Refuse the constructs of richer PDDL by their name."""
    if node.head in _REFUSED:
        what, hint = _REFUSED[node.head]
        message = f"`{node.head}` is {what}, which has no counterpart here"
        scope.refuse(node.items[0].span, "PDDL007", message, hint)


def note_costs(node: Group, scope: Scope) -> None:
    """Say, where it first happens, that costs are left out."""
    if not any(found.code == "PDDL013" for found in scope.report.diagnostics):
        message = "action costs are left out: a plan is judged by its number of steps"
        scope.report.note(node.span, "PDDL013", message)


def _changed(node: Node, scope: Scope) -> Fact:
    if isinstance(node, Group) and node.head in ("not", "and", "or", "exists", "="):
        message = f"`{node.head}` cannot stand here: an effect is a predicate or its negation"
        scope.refuse(node.span, "PDDL006", message)
    return checked_fact(node, scope, "an effect")


def _removals(node: Group, scope: Scope) -> Iterator[Effect]:
    """Read `(forall (?z) (not (on ?x ?z)))`: whatever matches is no longer so."""
    bound, inner = _quantified(node, scope)
    within = scope.within(bound)
    parts = inner.items[1:] if isinstance(inner, Group) and inner.head == "and" else (inner,)
    for part in parts:
        if not isinstance(part, Group) or part.head != "not":
            message = "an effect on all objects can only remove: (forall (?z) (not (on ?x ?z)))"
            hint = "write one action for each case"
            scope.refuse(part.span, "PDDL007", message, hint)
        removed = _changed(_only(part, within), within)
        declared = scope.predicates[removed.predicate].parameters
        for variable in bound:
            uses = [
                p.type for a, p in zip(removed.args, declared, strict=True) if a == variable.name
            ]
            if not any(scope.is_a(use, variable.type) for use in uses):
                message = f"this removes only where {variable.name} is a {variable.type}"
                if not uses:
                    message = f"{variable.name} does not occur in ({removed.predicate} …)"
                hint = f"here `not` removes whatever matches: leave the type of {variable.name} out"
                scope.refuse(part.span, "PDDL007", message, hint)
        yield Effect(removed, negated=True, every=bound)


def _equal(node: Group, scope: Scope) -> Equal:
    if len(node.items) != 3:
        scope.refuse(node.span, "PDDL006", "`=` compares two: (= ?x ?y)")
    left, right = node.items[1:]
    for side in (left, right):
        if isinstance(side, Group) or side.text.replace(".", "", 1).isdigit():
            message = "`=` is a numeric condition here, which has no counterpart"
            scope.refuse(node.span, "PDDL007", message, _NUMERIC)
    return Equal(scope.term(left)[0], scope.term(right)[0], node.span)


def _quantified(node: Group, scope: Scope) -> tuple[tuple[Typed, ...], Node]:
    if len(node.items) != 3 or not isinstance(node.items[1], Group):
        message = f"`{node.head}` has a list of variables and one condition"
        scope.refuse(node.span, "PDDL006", message, f"write ({node.head} (?x - block) (…))")
    return typed_list(node.items[1].items, scope, variables=True), node.items[2]


def _only(node: Group, scope: Scope) -> Node:
    if len(node.items) != 2:
        scope.refuse(node.span, "PDDL006", f"`{node.head}` takes exactly one condition")
    return node.items[1]


def _is_cost(node: Group) -> bool:
    target = node.items[1] if len(node.items) > 1 else None
    return isinstance(target, Group) and target.head == "total-cost"
