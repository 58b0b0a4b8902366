"""Imagined situations: what would be believed after a skill, by the engine's own semantics."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from typing import TypeAlias

from icarus_lite.inference import (
    Change,
    Closure,
    Evaluator,
    FactStore,
    Hierarchy,
    Matcher,
    Memory,
    Support,
    advance,
    percept_facts,
    with_values,
)
from icarus_lite.language.syntax import Condition, Domain, SkillClause
from icarus_lite.planning.beginning import Beginning, holds
from icarus_lite.planning.layers import LayeredFacts, fluents_of
from icarus_lite.planning.steps import PlanStep, plan_step
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import ATTACHED, Action, Belief, Value


@dataclass(frozen=True, slots=True)
class Situation:
    """A state of the world as imagined.

    Args:
        asserted: Persisting effects.
        hierarchy: Who moves with whom.
        assumed: Effects on defined concepts that the concepts do not (yet) derive.
        denied: Beliefs that an effect has ended although the percepts of now still derive them.
    """

    asserted: frozenset[Belief]
    hierarchy: Hierarchy
    assumed: frozenset[Belief] = frozenset()
    denied: frozenset[Belief] = frozenset()

    @property
    def key(self) -> Hashable:
        """What makes two situations the same."""
        pairs = frozenset(self.hierarchy.pairs())
        return with_values(self.asserted), pairs, with_values(self.assumed), self.denied


Inferred: TypeAlias = tuple[FactStore, Mapping[Belief, tuple[Support, ...]]]
"""All that would be believed in a situation, and each derived belief's supports."""

_Fixed: TypeAlias = tuple[FactStore, Mapping[Belief, tuple[Support, ...]], frozenset[str]]
"""The facts of now, the supports of those that stay as they are, and the predicates that do not."""


class Imagination:
    """Expands imagined situations from the beliefs of one cycle.

    Percepts cannot be predicted, so they stay as they are; where an effect and a concept's
    definition disagree, the effect is taken at its word until percepts come in.
    """

    __slots__ = (
        "_at_start",
        "_closure",
        "_domain",
        "_fixed",
        "_latest",
        "_matchers",
        "_percepts",
        "_state",
        "evaluator",
        "start",
    )

    def __init__(
        self, domain: Domain, memory: Memory, closure: Closure, evaluator: Evaluator | None = None
    ) -> None:
        state = memory.state
        self.evaluator = evaluator or Evaluator()
        self._state = state
        self._domain = domain
        self._closure = closure
        self._percepts = tuple(percept_facts(state.percepts, state.lineages))
        self._matchers: dict[int, Matcher] = {}
        self.start = Situation(frozenset(memory.asserted), state.hierarchy)
        self._at_start: Inferred | None = None
        self._fixed: _Fixed | None = None
        self._latest: tuple[Situation, Inferred] | None = None

    @property
    def percepts(self) -> tuple[Belief, ...]:
        """What is perceived, as facts; it stays as it is, whatever is imagined."""
        return self._percepts

    @property
    def now(self) -> FactStore:
        """What is believed now, taken in as it is asked for: the same as the facts of `start`."""
        return self._state.facts()

    @property
    def beginning(self) -> Beginning:
        """The same, as grounding needs it."""
        asserted, hierarchy = self.start.asserted, self.start.hierarchy
        return Beginning(self._percepts, asserted, hierarchy, self.now, self.evaluator)

    def facts(self, situation: Situation) -> FactStore:
        """Give all that would be believed in a situation, percepts included."""
        return self.inferred(situation)[0]

    def inferred(self, situation: Situation) -> Inferred:
        """Give all that would be believed in a situation, and each derived belief's supports.

        Only what skills can change is derived anew. What was asked last, and the start, are
        remembered: nothing may be added to these facts.
        """
        if self._latest is not None and situation is self._latest[0]:
            return self._latest[1]
        below, supports, fluents = self._fixed or self._fix()
        if situation is self.start and self._at_start is not None:
            return self._at_start
        store = LayeredFacts(below, fluents)
        for fact in self._percepts:
            if fact.predicate in fluents:
                store.add(fact)
        for belief in sorted(situation.asserted | situation.assumed, key=str):
            if belief.predicate in fluents:
                store.add(belief)
        for pair in situation.hierarchy.pairs():
            store.add(Belief(ATTACHED, pair))
        derived = self._closure.derive(store, situation.denied, fluents)
        self._latest = situation, (store, {**supports, **derived} if supports else derived)
        return self._latest[1]

    def _fix(self) -> _Fixed:
        """Derive all that is believed now, and set apart what stays as it is."""
        store = FactStore(self._percepts)
        for belief in sorted(self.start.asserted, key=str):
            store.add(belief)
        for pair in self.start.hierarchy.pairs():
            store.add(Belief(ATTACHED, pair))
        supports = self._closure.derive(store)
        self._at_start = store, supports
        fluents = fluents_of(self._domain)
        lasting = {b: found for b, found in supports.items() if b.predicate not in fluents}
        self._fixed = store, lasting, fluents
        return self._fixed

    def holds(self, goals: Sequence[Condition], facts: FactStore) -> bool:
        """Tell whether goals hold among these facts."""
        return holds(goals, facts, evaluator=self.evaluator)

    def applicable(self, clauses: Sequence[SkillClause], facts: FactStore) -> Iterator[PlanStep]:
        """Give the skill instances whose conditions hold, in the order of the domain."""
        seen: set[tuple[Action, Change, Hashable]] = set()
        for clause in clauses:
            for step in self.instances(clause, facts, {}):
                key = step.action, step.change, with_values(step.change.added)
                if key not in seen:
                    seen.add(key)
                    yield step

    def instances(
        self, clause: SkillClause, facts: FactStore, bindings: dict[str, Value]
    ) -> Iterator[PlanStep]:
        """Give the instances of one clause that hold, bindings given beforehand respected."""
        matcher = self._matchers.get(id(clause))
        if matcher is None:
            matcher = Matcher(clause.elements, clause.tests, evaluator=self.evaluator)
            self._matchers[id(clause)] = matcher
        for found in matcher.matches(facts, bindings):
            step = plan_step(clause, found.bindings)
            if step is not None:  # otherwise the checker has warned: nothing binds an argument
                yield step

    def after(self, situation: Situation, step: PlanStep) -> Situation:
        """Give the situation after a step, as the engine would believe it on success."""
        change, concepts = step.change, self._closure.concepts
        ended = {pattern.predicate for pattern in change.removed}
        asserted = {  # first what is new: it is there with the attributes it comes with now
            b for b in change.added if b.predicate != ATTACHED and b.predicate not in concepts
        }
        asserted.update(
            b for b in situation.asserted if b.predicate not in ended or not change.removes(b)
        )
        hierarchy, _ = situation.hierarchy.with_change(change, step.action, 0)
        hierarchy, _ = advance(hierarchy, self._domain.attachments, step.action, 0)
        expected = frozenset(b for b in change.added if b.predicate in concepts)
        imagined = Situation(
            frozenset(asserted),
            hierarchy,
            frozenset(b for b in situation.assumed if not change.removes(b)),
            situation.denied - expected,
        )
        if not expected and not any(a.predicate in concepts for a in change.removed):
            return imagined
        derived = self.facts(imagined)
        assumed = {b for b in expected if b not in derived}
        denied = {
            belief
            for predicate in ended
            for ((_, belief, _),) in derived.rows(predicate).values()
            if change.removes(belief)
        }
        denied.difference_update(self._percepts)
        if not assumed and not denied:
            return imagined
        return replace(
            imagined, assumed=imagined.assumed | assumed, denied=imagined.denied | denied
        )
