"""A plan carried out in the mind: what would be believed before each step, and whether it works.

A plan is trusted only once it has been executed in the engine's own semantics, step by step, from
the beliefs of now: see `Imagination`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.inference import FactStore, Support, first_obstacle
from icarus_lite.language.syntax import Condition
from icarus_lite.planning.naming import objects_of
from icarus_lite.planning.situation import Imagination, Situation
from icarus_lite.planning.steps import PlanStep
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Belief


@dataclass(frozen=True, slots=True)
class Stage:
    """What would be believed between two steps of a plan.

    Args:
        situation: The state of the world as imagined.
        facts: All that would be believed in it, percepts included.
        supports: Why each derived belief would be.
    """

    situation: Situation
    facts: FactStore
    supports: Mapping[Belief, tuple[Support, ...]]

    @property
    def given(self) -> frozenset[Belief]:
        """What is believed without being derived: effects taken at their word, attachments."""
        attached = (Belief(ATTACHED, pair) for pair in self.situation.hierarchy.pairs())
        return self.situation.asserted | self.situation.assumed | frozenset(attached)

    @property
    def percepts(self) -> Iterator[Belief]:
        """What is perceived, as facts."""
        return (f for f in self.facts if f not in self.supports and f not in self.given)

    @property
    def beliefs(self) -> frozenset[Belief]:
        """All that is believed; percepts are left out."""
        return self.given.union(self.supports)


@dataclass(frozen=True, slots=True)
class Flaw:
    """The first thing about a plan that does not work.

    Args:
        step: The step, from 0, that could not start; None if all can and the goal is not reached.
        reason: What is in the way, as a sentence.
    """

    step: int | None
    reason: str

    def __str__(self) -> str:
        return self.reason


@dataclass(frozen=True, slots=True)
class Projection:
    """A plan as far as it works in the mind.

    Args:
        steps: The steps that could be carried out, bound to the values of now.
        stages: What is believed before each of them, and after the last.
        flaw: What does not work; None for a plan that reaches its goal.
    """

    steps: tuple[PlanStep, ...]
    stages: tuple[Stage, ...]
    flaw: Flaw | None = None

    @property
    def valid(self) -> bool:
        """Whether every step could start and the goal is reached in the end."""
        return self.flaw is None


def project(
    imagination: Imagination, steps: Sequence[PlanStep], goals: Sequence[Condition] = ()
) -> Projection:
    """Carry a plan out in the mind, from the beliefs of now.

    Each step is bound anew: it stays about the same objects, and the values of attributes, such
    as a position, are read as they are now.

    Args:
        imagination: Expands situations from the beliefs of now.
        steps: The plan.
        goals: What is to hold in the end.
    """
    situation = imagination.start
    stages = [Stage(situation, *imagination.inferred(situation))]
    bound: list[PlanStep] = []
    for number, step in enumerate(steps):
        again = rebound(imagination, step, stages[-1].facts)
        if again is None:
            flaw = Flaw(number, _obstacle(imagination, step, stages[-1].facts))
            return Projection(tuple(bound), tuple(stages), flaw)
        bound.append(again)
        situation = imagination.after(situation, again)
        stages.append(Stage(situation, *imagination.inferred(situation)))
    facts = stages[-1].facts
    reached = imagination.holds(goals, facts)
    unreached = None if reached else Flaw(None, _unreached(imagination, goals, facts))
    return Projection(tuple(bound), tuple(stages), unreached)


def validate(
    imagination: Imagination, steps: Sequence[PlanStep], goals: Sequence[Condition]
) -> Flaw | None:
    """Say what does not work about a plan; None for a plan that reaches its goals from now."""
    return project(imagination, steps, goals).flaw


def rebound(imagination: Imagination, step: PlanStep, facts: FactStore) -> PlanStep | None:
    """Bind a step anew; None if it could not start among these facts.

    It is looked for with all objects that it was about, and failing that with those its action
    names: a ball can be picked up in whichever room it is by now.
    """
    bindings, clause = dict(step.bindings), step.clause
    for names in (objects_of(clause), frozenset(clause.head.variables)):
        kept = {name: value for name, value in bindings.items() if name in names}
        for again in imagination.instances(clause, facts, kept):
            if again.action == step.action:
                return again
    return None


def _obstacle(imagination: Imagination, step: PlanStep, facts: FactStore) -> str:
    clause, names = step.clause, objects_of(step.clause)
    kept = {name: value for name, value in step.bindings if name in names}
    obstacle = first_obstacle(clause.elements, clause.tests, facts, kept, imagination.evaluator)
    return f"{step.action} cannot start: {obstacle or 'nothing binds it'}"


def _unreached(imagination: Imagination, goals: Sequence[Condition], facts: FactStore) -> str:
    missing = [str(goal) for goal in goals if not imagination.holds([goal], facts)]
    return f"{' '.join(missing or map(str, goals))} does not hold in the end"
