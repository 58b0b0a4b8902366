"""Proofs: every derivation of a belief, found when somebody asks.

Nothing is kept for them. The body of each clause is joined again with its head bound, which is
cheap because little is left to look up.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from icarus_lite.inference.canonical import canonical
from icarus_lite.inference.network.bodies import Body
from icarus_lite.inference.network.design import Head, Keeping
from icarus_lite.inference.network.history import Kind, key_of
from icarus_lite.inference.network.running import Running
from icarus_lite.inference.supports import Derivation, bind_pattern
from icarus_lite.language.functions import as_value
from icarus_lite.language.syntax import Atom, ConceptClause, Variable
from icarus_lite.symbols import Belief, Value

_Args: TypeAlias = tuple[tuple[str | None, Value], ...]
"""For each argument the variable that it is, or None and the constant."""


@dataclass(frozen=True, slots=True)
class _Premise:
    """A positive condition: how the fact that met it is found again, and what it binds."""

    predicate: str
    args: _Args
    attributes: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, atom: Atom) -> _Premise:
        return cls(
            atom.predicate,
            tuple(
                (term.name, "") if isinstance(term, Variable) else (None, term.value)
                for term in atom.args
            ),
            tuple((name, t.name) for name, t in atom.attributes if isinstance(t, Variable)),
        )


@dataclass(frozen=True, slots=True)
class _Clause:
    """A clause with the search for its derivations."""

    clause: ConceptClause
    prove: Callable[..., Iterator[tuple[Value, ...]]]
    variables: tuple[str, ...]
    premises: tuple[_Premise, ...]
    absent: tuple[Atom, ...]


class Prover:
    """Finds the derivations of beliefs in the present of a network.

    Args:
        running: The network at work.
    """

    __slots__ = ("_clauses", "running")

    def __init__(self, running: Running) -> None:
        self.running = running
        self._clauses: dict[Kind, tuple[_Clause, ...]] = {}

    def derivations(self, belief: Belief) -> tuple[Derivation, ...]:
        """Give every derivation: clauses as written, of each first the least values.

        Where a concept is recursive, the first of all is one that does not rest on the belief
        itself: each belief it rests on was proved before.
        """
        kind = belief.predicate, len(belief.args)
        if not self.running.holds(kind, key_of(belief.args)):
            return ()
        clauses = self._clauses.get(kind)
        if clauses is None:
            clauses = self._clauses[kind] = self._clauses_of(self.running.heads[kind])
        found: list[Derivation] = []
        for clause in clauses:
            own = [self._derivation(clause, row) for row in clause.prove(*belief.args)]
            if len(own) > 1:
                own.sort(key=lambda derivation: canonical(derivation.bindings.values()))
            found += own
        if len(found) > 1:
            head = self.running.heads[kind]
            if head.keeping in (Keeping.RECURSIVE, Keeping.RECOMPUTED):
                self._put_founded_first(head, belief, found)
        return tuple(found)

    def _clauses_of(self, head: Head) -> tuple[_Clause, ...]:
        bodies = sorted(head.bodies, key=lambda body: body.number)
        return tuple(self._clause(head, body) for body in bodies)

    def _clause(self, head: Head, body: Body) -> _Clause:
        running, clause = self.running, body.clause
        return _Clause(
            clause,
            running.functions[f"prove_{head.facts.name}_{body.number + 1}"],
            running.compiled.module.wiring.proofs[body.number],
            tuple(_Premise.of(c.atom) for c in clause.elements if not c.negated),
            tuple(c.atom for c in clause.elements if c.negated),
        )

    def _derivation(self, clause: _Clause, row: tuple[Value, ...]) -> Derivation:
        known = dict(zip(clause.variables, row, strict=True))
        bound: dict[str, Value] = {}
        matched = []
        for premise in clause.premises:
            args = []
            for name, value in premise.args:
                if name is None:
                    args.append(value)
                else:
                    args.append(known[name])
                    bound.setdefault(name, known[name])
            fact = self.running.fact(premise.predicate, tuple(args))
            assert fact is not None  # the row was just joined
            matched.append(fact)
            for attribute, name in premise.attributes:
                bound.setdefault(name, fact.attributes[attribute])
        if clause.clause.binds:
            self._compute(clause.clause, bound)
        absent = tuple([bind_pattern(atom, bound) for atom in clause.absent])
        return Derivation(clause.clause, bound, tuple(matched), absent)

    def _compute(self, clause: ConceptClause, bound: dict[str, Value]) -> None:
        evaluator = self.running.compiled.design.vocabulary.evaluator
        for bind in clause.binds:
            bound[bind.variable.name] = as_value(
                evaluator(bind.expression, bound), bind.expression, evaluator.path
            )

    def _put_founded_first(self, head: Head, belief: Belief, found: list[Derivation]) -> None:
        """Put the first derivation that rests on beliefs of lower stages only before the rest."""
        running = self.running
        own: dict[Kind, Mapping[object, int]] = {
            kind: running.parts.rows[other.facts.name]
            for kind, other in running.heads.items()
            if other.component == head.component
        }
        stage = running.parts.rows[head.facts.name][key_of(belief.args)]
        for place, derivation in enumerate(found):
            stages = (
                own[p.predicate, len(p.args)].get(key_of(p.args), stage)
                for p in derivation.matched
                if (p.predicate, len(p.args)) in own
            )
            if all(each < stage for each in stages):
                found.insert(0, found.pop(place))
                return
