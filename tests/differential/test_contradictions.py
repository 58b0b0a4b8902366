"""Random contradictions over random domains and histories: the engine agrees with counting.

What is contradicted in a cycle is clingo's word; see `engine_trials.contradicting`.
"""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import replace

import pytest
from engine_trials.contradicting import Counting, Revision, draw_revision, history_of
from engine_trials.histories import Change
from engine_trials.scratch import Row, row
from engine_trials.trial import draw_trial
from engine_trials.vocabulary import Flavour
from engine_trials.writing import history_text

from icarus_lite.inference import Assertion, BeliefState, InferenceEngine, Memory
from icarus_lite.symbols import Action

_PARTS = 4
_TRIALS = int(os.environ.get("ICARUS_FUZZ_CONTRADICTIONS", "32"))
_SCENE_EVERY = 8
_TOLD = Action("told")


def drawn(seed: int, cycles: int = 12) -> Revision:
    flavour = Flavour.PLAIN if seed % 2 else Flavour.USUAL
    if seed % _SCENE_EVERY == _SCENE_EVERY - 1:
        flavour = Flavour.SCENE
    return draw_revision(seed, draw_trial(seed, cycles=cycles, flavour=flavour))


def told(memory: Memory, change: Change) -> Memory:
    """Give a memory in which a change of what is asserted has been noted."""
    asserted = dict(memory.asserted)
    for belief in (*change.withdrawn, *change.asserted):
        asserted.pop(belief, None)
    cause = Assertion(_TOLD, memory.state.cycle + 1)
    return replace(memory, asserted={**asserted, **dict.fromkeys(change.asserted, cause)})


def rows(state: BeliefState) -> frozenset[Row]:
    return frozenset(map(row, state.supports))


def judged(state: BeliefState) -> tuple[object, ...]:
    return rows(state), state.withdrawn, state.doubts


@pytest.mark.parametrize("part", range(_PARTS))
def test_the_engine_withdraws_what_counting_withdraws(part: int) -> None:
    for seed in range(part, _TRIALS, _PARTS):
        revision = drawn(seed)
        domain, counting = revision.domain(), Counting(revision)
        engine, memory, states = InferenceEngine(domain), Memory(), [BeliefState()]
        shown = f"seed {seed}\n{revision.text()}\n{history_text(revision.trial.history)}"
        for cycle, (change, world) in enumerate(history_of(revision.trial)):
            before = told(memory, change)
            memory = engine.step(before, world.percepts)
            state = memory.state
            beliefs, withdrawn = counting.step(cycle, change, world)
            where = f"cycle {cycle} of {shown}"
            assert {each.belief: each.cycles for each in state.withdrawn} == withdrawn, where
            assert rows(state) == beliefs, where
            doubts = {(each.rule, each.belief): each.cycles for each in state.doubts}
            assert doubts == counting.counts, where
            old, new = set(states[-1].beliefs), set(state.beliefs)
            assert tuple(map(set, state.since(states[-1]))) == (new - old, old - new), where
            if cycle % 4 == 3:  # what is compiled for it takes longer than all the rest
                again = InferenceEngine(domain).step(before, world.percepts[::-1]).state
                assert judged(again) == judged(state), where
            states.append(state)
        for cycle, state in enumerate(states[1:]):
            assert rows(engine.look_back(cycle)) == rows(state), f"back to {cycle} of {shown}"


def test_the_trials_have_all_that_makes_contradictions_hard() -> None:
    met: Counter[str] = Counter()
    for seed in range(16):
        revision = drawn(seed)
        rules, counting = revision.contradictions, Counting(revision)
        concepts = {clause.head.predicate for clause in revision.trial.clauses}
        met["reads a concept"] += any(
            element.atom.predicate in concepts for rule in rules for element in rule.elements
        )
        met["negation"] += any(c.negated for rule in rules for c in rule.elements)
        met["tests"] += any(rule.tests for rule in rules)
        met["attributes"] += any(e.atom.attributes for r in rules for e in r.elements)
        met["constants"] += any(len(set(r.head.variables)) < len(r.head.args) for r in rules)
        for cycle, (change, world) in enumerate(history_of(revision.trial)):
            earlier = dict(counting.counts)
            _, withdrawn = counting.step(cycle, change, world)
            met["withdrawn"] += bool(withdrawn)
            met["withdrawn after a while"] += any(count > 1 for count in withdrawn.values())
            met["asserted and withdrawn at once"] += any(b in withdrawn for b in change.asserted)
            met["a doubt that has passed"] += any(
                key not in counting.counts and key[1] in counting.asserted for key in earlier
            )
            met["a count that begins again"] += any(
                key in earlier and earlier[key] > 1 and counting.counts.get(key) == 1
                for key in earlier
            )
            met["several at once"] += len(withdrawn) > 1
    assert min(met.values()) >= 4, met
    assert len(met) == 11, met
