"""Imagined situations: what would be believed after a skill, by the engine's own semantics."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from icarus_lite.inference import (
    ATTACHED,
    Change,
    Closure,
    Evaluator,
    FactStore,
    Hierarchy,
    Matcher,
    Memory,
    advance,
    change_of,
    ground,
    percept_facts,
)
from icarus_lite.language.syntax import Condition, Domain, SkillClause
from icarus_lite.symbols import Action, Belief, Value


@dataclass(frozen=True, slots=True)
class PlanStep:
    """One skill instance of a plan.

    Args:
        action: The skill with its arguments.
        commands: What the driver is to carry out for it.
        clause: The clause of the skill that was chosen.
        bindings: What the clause's variables are bound to.
        change: What will be believed, or no longer, once it has succeeded.
    """

    action: Action
    commands: tuple[Action, ...]
    clause: SkillClause
    bindings: tuple[tuple[str, Value], ...]
    change: Change


def plan_step(clause: SkillClause, bindings: Mapping[str, Value]) -> PlanStep | None:
    """Give a primitive skill instance as a step; None if an argument of it is still free."""
    head = ground(clause.head, bindings)
    commands = tuple(ground(command, bindings) for command in clause.actions)
    if head is None or None in commands:
        return None
    return PlanStep(
        Action(head.predicate, head.args),
        tuple(Action(c.predicate, c.args) for c in commands if c is not None),
        clause,
        tuple(sorted(bindings.items())),
        change_of(clause.effects, bindings),
    )


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
        return self.asserted, frozenset(self.hierarchy.pairs()), self.assumed, self.denied


class Imagination:
    """Expands imagined situations from the beliefs of one cycle.

    Percepts cannot be predicted, so they stay as they are; where an effect and a concept's
    definition disagree, the effect is taken at its word until percepts come in.
    """

    __slots__ = ("_closure", "_domain", "_matchers", "_percepts", "evaluator", "start")

    def __init__(
        self, domain: Domain, memory: Memory, closure: Closure, evaluator: Evaluator | None = None
    ) -> None:
        state = memory.state
        self.evaluator = evaluator or Evaluator()
        self._domain = domain
        self._closure = closure
        self._percepts = tuple(percept_facts(state.percepts, state.lineages))
        self._matchers: dict[int, Matcher] = {}
        self.start = Situation(frozenset(memory.asserted), state.hierarchy)

    def facts(self, situation: Situation) -> FactStore:
        """Give all that would be believed in a situation, percepts included."""
        store = FactStore(self._percepts)
        for belief in sorted(situation.asserted | situation.assumed, key=str):
            store.add(belief)
        for pair in situation.hierarchy.pairs():
            store.add(Belief(ATTACHED, pair))
        self._closure.derive(store, situation.denied)
        return store

    def holds(self, goals: Sequence[Condition], facts: FactStore) -> bool:
        """Tell whether goals hold among these facts."""
        return holds(goals, facts, evaluator=self.evaluator)

    def applicable(self, clauses: Sequence[SkillClause], facts: FactStore) -> Iterator[PlanStep]:
        """Give the skill instances whose conditions hold, in the order of the domain."""
        seen: set[tuple[Action, Change]] = set()
        for clause in clauses:
            for step in self.instances(clause, facts, {}):
                if (step.action, step.change) not in seen:
                    seen.add((step.action, step.change))
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
        asserted = {b for b in situation.asserted if not change.removes(b)}
        asserted.update(
            b for b in change.added if b.predicate != ATTACHED and b.predicate not in concepts
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
        return replace(
            imagined,
            assumed=imagined.assumed | {b for b in expected if b not in derived},
            denied=imagined.denied
            | {b for b in derived if change.removes(b)} - set(self._percepts),
        )


def holds(
    conditions: Sequence[Condition],
    facts: FactStore,
    bindings: dict[str, Value] | None = None,
    evaluator: Evaluator | None = None,
) -> bool:
    """Tell whether a conjunction holds for some binding of its free variables."""
    bound = tuple(bindings or ())
    found = Matcher(conditions, bound=bound, evaluator=evaluator).matches(facts, bindings)
    return any(True for _ in found)
