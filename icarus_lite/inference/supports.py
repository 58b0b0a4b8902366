"""Why a belief is held: a derivation from other beliefs, or an action that asserted it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from icarus_lite.language.syntax import Atom, ConceptClause, Constant, Term, Variable
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


Support: TypeAlias = Derivation | Assertion


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
