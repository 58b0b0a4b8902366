"""Effects that assert anew what is believed already, with other attributes, on random domains.

The engine, its imagination, and a recorded run are held against a dictionary that notes the
values each belief was asserted with last. Ground tasks are held against imagination elsewhere, in
`test_walks`, on domains of the same kind.
"""

from __future__ import annotations

import json
import random
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

import pytest

from icarus_lite import Action, Agent, Outcome
from icarus_lite.inference import FactStore, Memory, match, percept_facts
from icarus_lite.language import diagnose_text
from icarus_lite.planning import PlanStep
from icarus_lite.symbols import Belief, Value
from icarus_lite.trace import Recording, cycle_record, header, resumed_agent
from tests.reference.ground_walks import imagined
from tests.reference.skill_domains import SkillDomain, Start

_SEEDS = 60
_STEPS = 12

Values = dict[str, Mapping[str, Value]]
"""The attributes of each belief, by the belief as it is written."""


@dataclass(frozen=True)
class Turn:
    """A step that was carried out, and what the engine remembers then."""

    step: PlanStep
    memory: Memory


def drawn(seed: int) -> Start:
    return SkillDomain(random.Random(seed), anew=True).draw()


def carried_out(start: Start, rng: random.Random) -> Iterator[Turn]:
    """Carry out steps at random, as long as there are any."""
    engine, memory = start.engine, start.memory
    percepts = memory.state.percepts
    for _ in range(_STEPS):
        imagination = imagined(engine, memory)
        steps = list(imagination.applicable(engine.domain.skills, memory.state.facts()))
        if not steps:
            return
        step = rng.choice(steps)
        memory = engine.step(memory, percepts, [Outcome(step.action)], {0: step.change})
        yield Turn(step, memory)


def asserted_next(known: Values, step: PlanStep, concepts: frozenset[str]) -> Values:
    """Note what a step asserts and ends: of each belief the last values count."""
    change, left = step.change, dict[str, Mapping[str, Value]]()
    for text, attributes in known.items():
        name, *args = text[1:-1].split()
        belief = Belief(name, tuple(args), attributes)
        if not any(match(pattern, belief, {}) is not None for pattern in change.removed):
            left[text] = attributes
    added = dict[str, Mapping[str, Value]]()
    for belief in change.added:
        if belief.predicate not in concepts | {"attached"}:
            added.setdefault(str(belief), dict(belief.attributes))
    return left | added


def values(beliefs: object) -> Values:
    return {str(each): dict(each.attributes) for each in beliefs}  # type: ignore[attr-defined]


def test_what_is_asserted_has_the_values_it_came_with_last() -> None:
    anew = 0
    for seed in range(_SEEDS):
        start = drawn(seed)
        concepts = frozenset(each.head.predicate for each in start.engine.domain.concepts)
        known, before = values(start.memory.asserted), start.memory
        for turn in carried_out(start, random.Random(seed)):
            following = asserted_next(known, turn.step, concepts)
            anew += any(known[b] != following[b] for b in known.keys() & following.keys())
            known = following
            assert values(turn.memory.asserted) == known, f"seed {seed}"
            imagination = imagined(start.engine, before)
            after = imagination.after(imagination.start, turn.step)
            assert values(after.asserted) == known, f"seed {seed}"
            before = turn.memory
    assert anew > 50  # otherwise nothing was asserted anew with other values


def test_what_follows_is_what_follows_from_scratch() -> None:
    compared = 0
    for seed in range(_SEEDS):
        start = drawn(seed)
        for turn in carried_out(start, random.Random(seed)):
            state = turn.memory.state
            scratch = FactStore(percept_facts(state.percepts, state.lineages))
            for belief in turn.memory.asserted:
                scratch.add(belief)
            for pair in state.hierarchy.pairs():
                scratch.add(Belief("attached", pair))
            start.engine.closure.derive(scratch)
            assert values(state.facts()) == values(scratch), f"seed {seed}"
            compared += 1
    assert compared > 200


@pytest.mark.parametrize("part", range(2))
def test_a_recorded_run_is_told_and_taken_up_with_the_same_values(part: int) -> None:
    anew = 0
    for seed in range(part, 4 * _SEEDS, 2):
        start = drawn(seed)
        if diagnose_text(start.text, "domain.icr")[0] is None:
            continue  # what is given at the start alone, a trace's domain would not know
        domain, rng = start.engine.domain, random.Random(seed)
        percepts = start.memory.state.percepts
        agent = Agent(domain, [])
        recording = Recording(json.loads(json.dumps(header(domain, []))))
        told: list[Values] = []
        for _ in range(_STEPS):
            outcomes = [_outcome(start, rng) for _ in range(rng.randint(1, 2))]
            decision = agent.cycle(percepts, outcomes)
            recording.append(json.loads(json.dumps(cycle_record(decision, percepts, outcomes))))
            told.append(values(decision.state.facts()))
        anew += sum(
            any(one[b] != other[b] for b in one.keys() & other.keys())
            for one, other in pairwise(told)
        )
        for cycle, expected in enumerate(told):
            assert values(recording.at(cycle).state.facts()) == expected, f"seed {seed}"
        resumed = resumed_agent(recording).cycle(percepts)
        assert values(resumed.state.facts()) == values(agent.cycle(percepts).state.facts())
    assert anew > 25


def _outcome(start: Start, rng: random.Random) -> Outcome:
    """Give the success of any action: the world need not have asked whether it could start."""
    skill = rng.choice(start.engine.domain.skills)
    things = [each.name for each in start.memory.state.percepts if each.type == "thing"]
    return Outcome(Action(skill.head.predicate, tuple(rng.choice(things) for _ in skill.head.args)))
