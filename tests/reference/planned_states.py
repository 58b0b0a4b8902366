"""States of a domain to plan from, and plans carried out in the engine's own semantics."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from icarus_lite.inference import (
    InferenceEngine,
    Matcher,
    Memory,
    given_memory,
    given_percepts,
)
from icarus_lite.language.syntax import Atom, Call, Condition, Constant, Domain
from icarus_lite.outcomes import Outcome
from icarus_lite.planning import Imagination, Plan, Situation, find_plan
from icarus_lite.symbols import Action, Belief, Value


@dataclass(frozen=True)
class State:
    """A state of a domain, as the exporter asks for it."""

    engine: InferenceEngine
    memory: Memory

    @property
    def facts(self) -> Sequence[Belief]:
        return tuple(self.memory.state.facts())

    def matches(
        self, conditions: Sequence[Condition], tests: Sequence[Call], bindings: Mapping[str, Value]
    ) -> Iterator[Mapping[str, Value]]:
        matcher = Matcher(conditions, tests, tuple(bindings), self.engine.evaluator)
        for found in matcher.matches(self.memory.state.facts(), bindings):
            yield found.bindings

    @property
    def imagination(self) -> Imagination:
        engine = self.engine
        return Imagination(engine.domain, self.memory, engine.closure, engine.evaluator)


def ground(atom: Atom) -> Action:
    return Action(atom.predicate, tuple(t.value for t in atom.args if isinstance(t, Constant)))


def state_of(domain: Domain, facts: Sequence[Atom], actions: Sequence[Atom] = ()) -> State:
    engine = InferenceEngine(domain)
    outcomes = [Outcome(ground(atom)) for atom in actions]
    memory = engine.step(given_memory(domain, facts), given_percepts(domain, facts), outcomes)
    return State(engine, memory)


def reaches(state: State, steps: Sequence[Action], goals: Sequence[Condition]) -> bool:
    """Tell whether steps can be taken, in our own semantics, and lead to the goals."""
    imagination, domain = state.imagination, state.engine.domain
    situations: dict[object, Situation] = {imagination.start.key: imagination.start}
    for action in steps:
        following: dict[object, Situation] = {}
        for situation in situations.values():
            for step in imagination.applicable(domain.skills, imagination.facts(situation)):
                if step.action == action and step.clause.actions:
                    after = imagination.after(situation, step)
                    following[after.key] = after
        situations = following
    return any(
        imagination.holds(goals, imagination.facts(situation)) for situation in situations.values()
    )


def our_length(state: State, goals: Sequence[Condition]) -> int:
    plan = find_plan(state.engine.domain, state.imagination, goals)
    assert isinstance(plan, Plan), plan
    return len(plan.steps)
