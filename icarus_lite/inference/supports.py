"""Why a belief is held: a derivation from other beliefs, or an action that asserted it."""

from __future__ import annotations

from collections.abc import Mapping

from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Expression,
    Term,
    Variable,
)
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action, Belief, Value


@dataclass(frozen=True, slots=True)
class Derivation:
    """A concept clause that holds.

    Args:
        clause: The clause, with its place in the domain file.
        bindings: What its variables are bound to.
        matched: The percepts and beliefs that met its positive conditions.
        absent: The patterns of its negated conditions, bound as far as they are.
    """

    clause: ConceptClause
    bindings: Mapping[str, Value]
    matched: tuple[Belief, ...]
    absent: tuple[Atom, ...]


@dataclass(frozen=True, slots=True)
class Assertion:
    """An action that succeeded and has this effect.

    Args:
        action: The action.
        cycle: The cycle in which its success was reported.
    """

    action: Action
    cycle: int


Support = Derivation | Assertion

Literal = Condition | Call
"""One condition or test of a conjunction."""


def bind_pattern(atom: Atom, bindings: Mapping[str, Value]) -> Atom:
    """Give a pattern with its bound variables replaced; free ones stay, to be read as "any"."""

    def bound(term: Term) -> Term:
        if isinstance(term, Variable) and term.name in bindings:
            return Constant(bindings[term.name], term.span)
        return term

    args = tuple(bound(term) for term in atom.args)
    return Atom(
        atom.predicate, args, tuple((name, bound(t)) for name, t in atom.attributes), atom.span
    )


def bind_literal(literal: Literal, bindings: Mapping[str, Value]) -> Literal:
    """Fill values into a condition or test; free variables stay."""
    if isinstance(literal, Call):
        return _bind_call(literal, bindings)
    return Condition(bind_pattern(literal.atom, bindings), literal.negated, literal.span)


def _bind_call(call: Call, bindings: Mapping[str, Value]) -> Call:
    return Call(call.function, tuple(_bind(each, bindings) for each in call.args), call.span)


def _bind(expression: Expression, bindings: Mapping[str, Value]) -> Expression:
    if isinstance(expression, Call):
        return _bind_call(expression, bindings)
    if isinstance(expression, Variable) and expression.name in bindings:
        return Constant(bindings[expression.name], expression.span)
    return expression
