"""Conditions of PDDL as what clauses are made of: alternatives, each a list of literals.

A clause holds when all its literals do, and several clauses with one head are alternatives: that
is the disjunctive normal form of a condition. `(not (exists …))` over one predicate is what `not`
with a local variable says; over more than one it would need a name of its own, and is refused.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence

from icarus_lite.language.pddl.scope import Scope
from icarus_lite.language.pddl.syntax import (
    And,
    Equal,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    Typed,
    variables_of,
)
from icarus_lite.records import dataclass, field, replace

MAX_ALTERNATIVES = 64
"""More clauses than this for one condition are refused: nobody could read them."""


@dataclass(frozen=True, slots=True)
class Literal:
    """A predicate or an equation, or its negation; variables of `absent` are local to it."""

    formula: Fact | Equal
    negated: bool = False
    absent: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Alternative:
    """One way for a condition to hold: all literals do, for some value of the variables."""

    literals: tuple[Literal, ...] = ()
    variables: tuple[Typed, ...] = ()


@dataclass(slots=True)
class Alternatives:
    """Splits the conditions of one clause.

    Args:
        scope: Knows predicates and types; findings go to its report.
        taken: Names of variables that a quantifier must not use again.
    """

    scope: Scope
    taken: set[str] = field(default_factory=set)
    _mentioned: set[str] = field(default_factory=set)

    def of(self, formula: Formula) -> list[Alternative]:
        """Give every way for a condition to hold. Raises RefusedError, with a reason reported."""
        self._mentioned.update(_all_variables(formula))
        return self._split(formula, negated=False)

    def _split(self, formula: Formula, *, negated: bool) -> list[Alternative]:
        match formula:
            case Fact() | Equal():
                return [Alternative((Literal(formula, negated),))]
            case Not(part):
                return self._split(part, negated=not negated)
            case And(parts) | Or(parts):
                found = [self._split(part, negated=negated) for part in parts]
                if isinstance(formula, And) is negated:
                    return [each for alternatives in found for each in alternatives]
                return self._combined(found, formula)
            case Exists() if negated:
                literals = tuple(self._absences(formula))
                return [Alternative(literals)]
            case Exists():
                fresh, part = self._renamed(formula)
                return [
                    replace(each, variables=(*fresh, *each.variables))
                    for each in self._split(part, negated=False)
                ]

    def _combined(self, found: list[list[Alternative]], formula: And | Or) -> list[Alternative]:
        count = math.prod(map(len, found))
        if count > MAX_ALTERNATIVES:
            message = f"this condition has more than {MAX_ALTERNATIVES} alternatives"
            hint = "give its parts names: derived predicates"
            self.scope.refuse(formula.span, "PDDL014", message, hint)
        return [_together(chosen) for chosen in itertools.product(*found)]

    def _absences(self, formula: Exists) -> Iterator[Literal]:
        """Give the literals of `(not (exists …))`."""
        bound, part = self._renamed(formula)
        parts = part.parts if isinstance(part, Or) else (part,)
        for each in parts:
            while isinstance(each, And) and len(each.parts) == 1:
                each = each.parts[0]  # noqa: PLW2901 - unwrapping it
            if not isinstance(each, Fact):
                message = "`not exists` over more than one predicate has no counterpart here"
                hint = "derive a predicate from the inner condition, and negate that"
                self.scope.refuse(formula.span, "PDDL007", message, hint)
            used = [variable for variable in bound if variable.name in variables_of(each)]
            for variable in used:
                if not implies_type(self.scope, each, variable):
                    message = f"`not` here is about whatever matches, not only a {variable.type}"
                    hint = f"derive a predicate that says ({variable.type} {variable.name}) as well"
                    self.scope.refuse(variable.span, "PDDL007", message, hint)
            yield Literal(each, negated=True, absent=tuple(variable.name for variable in used))

    def _renamed(self, formula: Exists) -> tuple[tuple[Typed, ...], Formula]:
        """Give the variables of a quantifier names that nothing else in the clause has."""
        names: dict[str, str] = {}
        for variable in formula.variables:
            name, number = variable.name, 2
            while name in self.taken or (number > 2 and name in self._mentioned):
                name, number = f"{variable.name}-{number}", number + 1
            self.taken.add(name)
            names[variable.name] = name
        fresh = tuple(replace(each, name=names[each.name]) for each in formula.variables)
        return fresh, renamed(formula.part, lambda name: names.get(name, name))


def _together(alternatives: Sequence[Alternative]) -> Alternative:
    """Give the alternative in which all of these hold."""
    literals = dict.fromkeys(literal for each in alternatives for literal in each.literals)
    variables = tuple(variable for each in alternatives for variable in each.variables)
    return Alternative(tuple(literals), variables)


def _all_variables(formula: Formula) -> Iterator[str]:
    """Give the variables of a formula, those that its quantifiers bind included."""
    match formula:
        case Exists(variables, part):
            yield from (variable.name for variable in variables)
            yield from _all_variables(part)
        case Not(part):
            yield from _all_variables(part)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _all_variables(part)
        case _:
            yield from variables_of(formula)


def renamed(formula: Formula, name: Callable[[str], str]) -> Formula:
    """Give a formula with its free terms renamed."""
    match formula:
        case Fact(predicate, args, span):
            return Fact(predicate, tuple(map(name, args)), span)
        case Equal(left, right, span):
            return Equal(name(left), name(right), span)
        case Not(part, span):
            return Not(renamed(part, name), span)
        case And(parts, span):
            return And(tuple(renamed(part, name) for part in parts), span)
        case Or(parts, span):
            return Or(tuple(renamed(part, name) for part in parts), span)
        case Exists(variables, part, span):
            bound = {variable.name for variable in variables}
            inner = renamed(part, lambda each: each if each in bound else name(each))
            return Exists(variables, inner, span)


def implies_type(scope: Scope, fact: Fact, variable: Typed) -> bool:
    """Tell whether a fact that holds says by itself that a variable is of its type."""
    declared = scope.predicates[fact.predicate].parameters
    return any(
        argument == variable.name and scope.is_a(parameter.type, variable.type)
        for argument, parameter in zip(fact.args, declared, strict=True)
    )


def is_implied(scope: Scope, literals: Iterable[Literal], variable: Typed) -> bool:
    """Tell whether the positive literals say by themselves that a variable is of its type."""
    return any(
        not literal.negated
        and isinstance(literal.formula, Fact)
        and implies_type(scope, literal.formula, variable)
        for literal in literals
    )
