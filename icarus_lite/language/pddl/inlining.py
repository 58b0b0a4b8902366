"""Derived predicates put in where they are used, for planners that know none.

Each use becomes the disjunction of the rules' bodies. A predicate that is derived from itself
has no such text, and stands in the way.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from icarus_lite.errors import IcarusError
from icarus_lite.language.pddl.conditions import renamed
from icarus_lite.language.pddl.syntax import (
    And,
    Equal,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    PddlDomain,
    PddlProblem,
    Rule,
    Typed,
    is_a,
    parents,
)
from icarus_lite.records import dataclass, field, replace


class RecursiveRuleError(IcarusError, ValueError):
    """A derived predicate depends on itself, and cannot be put in."""


def inlined(domain: PddlDomain, problem: PddlProblem) -> tuple[PddlDomain, PddlProblem]:
    """Give the same domain and problem without derived predicates.

    Raises:
        RecursiveRuleError: One of them depends on itself; the text names the way round.
    """
    work = _Inlining(domain)
    actions = tuple(
        replace(action, precondition=work.of(action.precondition)) for action in domain.actions
    )
    kept = tuple(each for each in domain.predicates if each.name not in domain.derived)
    return (
        replace(domain, predicates=kept, rules=(), actions=actions),
        replace(problem, goal=work.of(problem.goal)),
    )


@dataclass(slots=True)
class _Inlining:
    domain: PddlDomain
    _count: Iterator[int] = field(default_factory=lambda: itertools.count(1))

    def of(self, formula: Formula, trail: tuple[str, ...] = ()) -> Formula:
        """Give a formula without derived predicates; `trail` are those being put in."""
        match formula:
            case Fact(predicate) if predicate in self.domain.derived:
                if predicate in trail:
                    way = " -> ".join([*trail[trail.index(predicate) :], predicate])
                    raise RecursiveRuleError(
                        f"`{predicate}` is derived from itself ({way}), so its definition cannot "
                        "be put in: leave --inline out, and use a planner for derived predicates"
                    )
                rules = [rule for rule in self.domain.rules if rule.predicate == predicate]
                bodies = [self._body(rule, formula, (*trail, predicate)) for rule in rules]
                return bodies[0] if len(bodies) == 1 else Or(tuple(bodies))
            case Not(part):
                return Not(self.of(part, trail))
            case And(parts):
                return _flat([self.of(part, trail) for part in parts])
            case Or(parts):
                return Or(tuple(self.of(part, trail) for part in parts))
            case Exists(variables, part):
                return Exists(variables, self.of(part, trail))
            case _:
                return formula

    def _body(self, rule: Rule, use: Fact, trail: tuple[str, ...]) -> Formula:
        """Give a rule's body for the terms of one use, its own variables named afresh."""
        body = _fresh(rule.body, self._count)
        terms = {p.name: term for p, term in zip(rule.parameters, use.args, strict=True)}
        body = self.of(renamed(body, lambda name: terms.get(name, name)), trail)
        declared = next(p for p in self.domain.predicates if p.name == rule.predicate).parameters
        for term, ours, theirs in zip(use.args, rule.parameters, declared, strict=True):
            if not is_a(parents(self.domain.types), theirs.type, ours.type):
                # The rule asks for more than the predicate does: say so in the body.
                variable = f"?v{next(self._count)}"
                typed = Exists((Typed(variable, ours.type),), Equal(variable, term))
                body = _flat([typed, body])
        return body


def _fresh(formula: Formula, count: Iterator[int]) -> Formula:
    """Rename the variables that quantifiers bind, so that no two uses share one."""
    match formula:
        case Exists(variables, part):
            names = {v.name: f"{v.name}-{next(count)}" for v in variables}
            bound = tuple(replace(v, name=names[v.name]) for v in variables)
            inner = renamed(part, lambda name: names.get(name, name))
            return Exists(bound, _fresh(inner, count))
        case Not(part):
            return Not(_fresh(part, count))
        case And(parts):
            return And(tuple(_fresh(part, count) for part in parts))
        case Or(parts):
            return Or(tuple(_fresh(part, count) for part in parts))
        case _:
            return formula


def _flat(parts: list[Formula]) -> Formula:
    flat: list[Formula] = []
    for part in parts:
        flat += part.parts if isinstance(part, And) else (part,)
    flat = list(dict.fromkeys(flat))
    return flat[0] if len(flat) == 1 else And(tuple(flat))
