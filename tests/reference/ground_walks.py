"""A ground task and the engine's own imagination, led through the same situations."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Sequence

from icarus_lite.inference import FactStore, InferenceEngine, Memory, with_values
from icarus_lite.language.syntax import Atom, Condition, Constant, Domain
from icarus_lite.planning import Imagination, PlanStep, Situation, relevance
from icarus_lite.planning.ground_task import GroundOperator, GroundTask, State
from icarus_lite.planning.grounding import PlanningDomain, ground_goals
from icarus_lite.symbols import Belief


def imagined(engine: InferenceEngine, memory: Memory) -> Imagination:
    return Imagination(engine.domain, memory, engine.closure, engine.evaluator)


def changing(domain: Domain) -> tuple[str, ...]:
    """Give all predicates that skills speak of or concepts define."""
    names = {effect.atom.predicate for clause in domain.skills for effect in clause.effects}
    names |= {clause.head.predicate for clause in domain.concepts}
    return (*sorted(names), "attached")


def applicable(task: GroundTask, state: State) -> list[GroundOperator]:
    return [op for op in task.operators if all(state >> atom & 1 for atom in op.conditions)]


def differences(
    task: GroundTask, state: State, facts: FactStore, fluents: frozenset[str]
) -> list[str]:
    """Say in which beliefs a ground state and imagined facts differ."""
    held = {
        (fact.predicate, fact.args): dict(fact.attributes)
        for fact in facts
        if fact.predicate in fluents
    }
    found, seen = [], set()
    for place, atom in enumerate(task.atoms):
        belief = atom.belief
        if " " in belief.predicate:  # made up by grounding
            continue
        key = belief.predicate, belief.args
        seen.add(key)
        holds = key in held and held[key] == dict(belief.attributes)
        if bool(state >> place & 1) is not (holds is not atom.negated):
            found.append(f"{atom} is {bool(state >> place & 1)}, {dict(belief.attributes)}")
    return found + [f"{key} is not known" for key in held if key not in seen]


def walk(
    engine: InferenceEngine,
    memory: Memory,
    rng: random.Random,
    steps: int,
    goals: Sequence[Condition] = (),
) -> int:
    """Walk at random through a domain, both ways, and compare each situation; give how many."""
    domain = engine.domain
    imagination = imagined(engine, memory)
    watched = changing(domain)
    kept = PlanningDomain(domain, engine.evaluator)
    grounding = ground_goals(kept, imagination.beginning, goals, watched=watched)
    task, fluents = grounding.task, grounding.fluents
    wanted = [*goals, *(Condition(Atom(name)) for name in watched)]
    skills = relevance(domain, wanted).skills
    situation, state = imagination.start, task.initial
    always = {
        f"{(fact.predicate, fact.args)} is not known"
        for fact in imagination.facts(situation)
        if fact.predicate in fluents
    }
    keys = {id(op): _key(op.step) for op in task.operators}
    for count in range(steps):
        facts = imagination.facts(situation)
        told = {f"{fact} {dict(fact.attributes)}" for fact in facts}
        assert told == from_scratch(engine, imagination, situation)
        unlike = set(differences(task, state, facts, fluents)) - always
        assert not unlike, unlike
        theirs = {_key(step): step for step in imagination.applicable(skills, facts)}
        ours: dict[object, GroundOperator] = {}
        for operator in applicable(task, state):
            ours.setdefault(keys[id(operator)], operator)
        assert set(ours) == set(theirs), set(ours) ^ set(theirs)
        if goals and not grounding.hopeless:
            assert task.reached(state) is imagination.holds(goals, facts)
        if not theirs:
            return count + 1
        key = rng.choice(sorted(theirs, key=str))
        state = task.after(state, ours[key])
        situation = imagination.after(situation, theirs[key])
    return steps


def _key(step: PlanStep) -> tuple[object, ...]:
    return step.action, step.change, with_values(step.change.added)


def from_scratch(
    engine: InferenceEngine, imagination: Imagination, situation: Situation
) -> set[str]:
    """Give what is believed in a situation, everything derived anew."""
    facts = FactStore(imagination.percepts)
    for belief in sorted(situation.asserted | situation.assumed, key=str):
        facts.add(belief)
    for pair in situation.hierarchy.pairs():
        facts.add(Belief("attached", pair))
    engine.closure.derive(facts, situation.denied)
    return {f"{fact} {dict(fact.attributes)}" for fact in facts}


def breadth_first(
    imagination: Imagination, domain: Domain, goals: Sequence[Condition], most: int
) -> int | None:
    """Give the length of a shortest plan by imagining alone; -1 if there is none.

    None is the answer if that many situations were not enough to tell.
    """
    skills = relevance(domain, goals).skills
    if imagination.holds(goals, imagination.facts(imagination.start)):
        return 0
    waiting = deque([(imagination.start, 0)])
    seen = {imagination.start.key}
    while waiting:
        if len(seen) > most:
            return None
        situation, length = waiting.popleft()
        for step in list(imagination.applicable(skills, imagination.facts(situation))):
            after = imagination.after(situation, step)
            if after.key in seen:
                continue
            seen.add(after.key)
            if imagination.holds(goals, imagination.facts(after)):
                return length + 1
            waiting.append((after, length + 1))
    return -1


def goal_of(belief: Belief, *, negated: bool = False) -> Condition:
    """Give a belief as a goal; its attributes are left out."""
    return Condition(Atom(belief.predicate, tuple(map(Constant, belief.args))), negated)


def random_goals(
    imagination: Imagination, domain: Domain, rng: random.Random, steps: int
) -> list[Condition]:
    """Give goals out of what is believed, or no longer, after a random walk."""
    situation = imagination.start
    before = {fact for fact in imagination.facts(situation) if " " not in fact.predicate}
    for _ in range(steps):
        options = list(imagination.applicable(domain.skills, imagination.facts(situation)))
        if not options:
            break
        situation = imagination.after(situation, rng.choice(options))
    after = set(imagination.facts(situation))
    gained = [goal_of(belief) for belief in sorted(after - before, key=str)]
    lost = [goal_of(belief, negated=True) for belief in sorted(before - after, key=str)]
    goals = gained + lost
    return rng.sample(goals, min(len(goals), rng.randint(1, 3)))
