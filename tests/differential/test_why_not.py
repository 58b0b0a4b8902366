"""Questions about random domains: every answer is true, and no proof goes round in a circle."""

from __future__ import annotations

import json
import random
from collections.abc import Iterator

import pytest
from engine_trials.histories import worlds
from engine_trials.trial import draw_trial

from icarus_lite.inference import (
    Assertion,
    BeliefState,
    Context,
    Explanation,
    InferenceEngine,
    Memory,
    WhyNot,
    explain,
    match,
    why_not,
)
from icarus_lite.inference.explaining import Blocked, FailedTest, Missing, why_not_document
from icarus_lite.inference.explaining.lookup import matching
from icarus_lite.language.syntax import Atom, Constant, Variable
from icarus_lite.symbols import Action, Belief

GIVEN = Assertion(Action("told"), 0)


def contexts(seed: int, cycles: int) -> Iterator[Context]:
    """Give each cycle of a random domain and history, ready to be asked about."""
    trial = draw_trial(seed, cycles)
    domain = trial.domain()
    engine = InferenceEngine(domain)
    for number, world in enumerate(worlds(trial.history)):
        before = Memory(BeliefState(cycle=number - 1), dict.fromkeys(world.asserted, GIVEN))
        state = engine.step(before, world.percepts).state
        yield Context(domain, state, engine.evaluator)


def questions(context: Context, draw: random.Random) -> Iterator[Atom]:
    """Ask about every predicate there is, with names that occur, others, and variables."""
    state = context.state
    held = list(state.supports)
    names = [percept.name for percept in state.percepts[:5]]
    values = [*names, *(value for belief in held[:6] for value in belief.args), "stranger", 3]
    heads = {(clause.head.predicate, len(clause.head.args)) for clause in context.domain.concepts}
    heads |= {(belief.predicate, len(belief.args)) for belief in held}
    heads |= {(percept.type, 1) for percept in state.percepts}
    for predicate, arity in sorted(heads):
        for _ in range(2):
            terms = (
                Variable(draw.choice(["?u", "?v"]))
                if draw.random() < 0.4
                else Constant(draw.choice(values))
                for _ in range(arity)
            )
            yield Atom(predicate, tuple(terms))


def check(answer: WhyNot, context: Context) -> None:
    """See that every reason is so."""
    facts = context.state.facts()
    for verdict in answer.clauses:
        reason = verdict.reason
        # A clause may hold for attributes that another derivation of the same belief decides.
        assert reason is not None or not verdict.fits or answer.asked.atom.attributes
        if isinstance(reason, Missing):
            assert matching(reason.pattern, facts) == []
        elif isinstance(reason, Blocked):
            assert all(match(reason.pattern, b.belief, {}) is not None for b in reason.blockers)
            assert all(blocker.belief in facts for blocker in reason.blockers)
        elif isinstance(reason, FailedTest) and not reason.error:
            assert not context.evaluator(reason.test, {})
        if verdict.deeper is not None:
            check(verdict.deeper, context)


def is_founded(explanation: Explanation, above: tuple[Belief, ...] = ()) -> bool:
    return explanation.belief not in above and all(
        is_founded(premise, (*above, explanation.belief)) for premise in explanation.premises
    )


@pytest.mark.parametrize("seed", range(12))
def test_every_answer_is_true(seed: int) -> None:
    draw, asked = random.Random(seed), 0
    for context in contexts(seed, cycles=3):
        facts = context.state.facts()
        for atom in questions(context, draw):
            answer = why_not(atom, context)
            asked += 1
            assert answer.holds == bool(matching(atom, facts))
            document = why_not_document(answer)
            assert json.loads(json.dumps(document)) == document
            assert str(answer)
            if not answer.holds:
                check(answer, context)
    assert asked > 10


@pytest.mark.parametrize("seed", range(100, 112))
def test_every_proof_comes_to_an_end_with_what_is_given(seed: int) -> None:
    proofs = 0
    for context in contexts(seed, cycles=3):
        for belief in list(context.state.supports)[:15]:
            found = explain(belief, context.state, alternatives=True)
            for each in (found, *found.alternatives):
                assert is_founded(each)
                proofs += 1
    assert proofs > 0
