"""Why a goal can never be true: the condition at which the most promising way to it ends.

What is looked at is everything that could come to hold if nothing were ever undone. A goal beyond
even that is out of reach for good, and so, going back from it, is some condition of each skill or
concept that could lead to it. Of all the ways the one is told that gets furthest: it is the one a
person would have expected to work.
"""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.inference import Evaluator, FactStore, first_obstacle, unify
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Domain,
    SkillClause,
    Term,
    Variable,
)
from icarus_lite.planning.grounding import Grounding
from icarus_lite.planning.relevance import can_change, relevance
from icarus_lite.planning.situation import Imagination
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Value

_DEEPEST = 4
"""How far back from the goal the answer goes."""


def why_hopeless(
    domain: Domain, imagination: Imagination, grounding: Grounding, goal: Condition
) -> str:
    """Say that a goal can never be true, and at which condition the best way to it ends.

    Args:
        domain: Skills, concepts and attachments.
        imagination: The beliefs of now.
        grounding: Has found the goal to be out of reach.
        goal: The goal.
    """
    never = f"no skill can ever make {goal} true"
    if goal.negated or not can_change(domain, goal):
        return never
    facts = FactStore(imagination.facts(imagination.start))
    for belief in grounding.could_hold():
        facts.add(belief)
    ways = _Ways(domain, facts, grounding.fluents, imagination.evaluator)
    best = ways.best(goal.atom, frozenset())
    return never if best is None else f"{never}: {'; '.join(best.steps)}"


@dataclass(frozen=True, slots=True)
class _Way:
    """A way to what is wanted, up to where it ends.

    Args:
        steps: What it needs, one after the other, and at last cannot have.
        reach: How far it gets: the share of conditions that are met, summed over its clauses.
    """

    steps: tuple[str, ...]
    reach: float


class _Ways:
    """The ways to what is wanted, and where they end."""

    def __init__(
        self, domain: Domain, facts: FactStore, fluents: frozenset[str], evaluator: Evaluator
    ) -> None:
        self._domain, self._facts = domain, facts
        self._fluents, self._evaluator = fluents, evaluator

    def best(self, wanted: Atom, asked: frozenset[str]) -> _Way | None:
        """Give the way that gets furthest, the first of several; None if there is none to tell."""
        if len(asked) >= _DEEPEST or str(wanted) in asked:
            return None
        found: _Way | None = None
        for clause, bindings in self._leading_to(wanted):
            way = self._way(clause, bindings, asked | {str(wanted)})
            if way is not None and (found is None or way.reach > found.reach):
                found = way
        return found

    def _way(
        self,
        clause: SkillClause | ConceptClause,
        bindings: dict[str, Value],
        asked: frozenset[str],
    ) -> _Way | None:
        """Say what a clause needs and cannot have, and why that cannot be had."""
        # What may change may also cease to hold: a `not` on it is no obstacle for good.
        conditions = [
            c for c in clause.elements if not (c.negated and c.atom.predicate in self._fluents)
        ]
        obstacle = first_obstacle(conditions, clause.tests, self._facts, bindings, self._evaluator)
        if obstacle is None:
            return None
        reach = obstacle.met / (len(conditions) + len(clause.tests))
        bound = obstacle.bound
        if isinstance(bound, Call) or obstacle.blocking is not None or obstacle.error:
            return _Way((f"for {clause.head}, {obstacle}",), reach)
        need = f"{clause.head} needs {bound}"
        deeper = None if bound.negated else self.best(bound.atom, asked)
        if deeper is None:
            return _Way((need,), reach)
        return _Way((need, *deeper.steps), reach + deeper.reach)

    def _leading_to(
        self, wanted: Atom
    ) -> Iterator[tuple[SkillClause | ConceptClause, dict[str, Value]]]:
        """Give the clauses that conclude or bring about what is wanted, their heads bound."""
        for concept in self._domain.concepts:
            bindings = _meeting(concept.head, wanted)
            if bindings is not None:
                yield concept, bindings
        for skill in relevance(self._domain, [Condition(wanted)]).skills:
            for effect in self._effects(skill):
                bindings = _meeting(effect, wanted)
                if bindings is not None:
                    yield skill, bindings

    def _effects(self, skill: SkillClause) -> Iterator[Atom]:
        for effect in skill.effects:
            if not effect.negated:
                yield effect.atom
        for rule in self._domain.attachments:
            attach, head = rule.attach, skill.head
            if attach.predicate != head.predicate or len(attach.args) != len(head.args):
                continue
            terms: dict[str, Term] = {
                wanted.name: given
                for wanted, given in zip(attach.args, head.args, strict=True)
                if isinstance(wanted, Variable)
            }
            pair = [
                terms.get(each.name, each) if isinstance(each, Variable) else each
                for each in (rule.child, rule.parent)
            ]
            yield Atom(ATTACHED, tuple(pair))


def _meeting(made: Atom, wanted: Atom) -> dict[str, Value] | None:
    """Bind what is made so that it is what is wanted; None if it cannot be."""
    if made.predicate != wanted.predicate or len(made.args) != len(wanted.args):
        return None
    known = [
        (term, asked.value)
        for term, asked in zip(made.args, wanted.args, strict=True)
        if isinstance(asked, Constant)
    ]
    return unify(known)
