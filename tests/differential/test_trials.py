"""Random domains and random histories: network, clingo, CLIPS and inference from scratch agree.

`make test` tries a few hundred seeds, `make fuzz-engine` ten thousand.
"""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import replace

import pytest
from engine_trials import trial as trials
from engine_trials.clips_oracle import clips_failure
from engine_trials.histories import Change, World, worlds
from engine_trials.proofs import circle, faults
from engine_trials.scratch import Scratch
from engine_trials.shrinking import shrunk
from engine_trials.trial import PLAIN_EVERY, Trial, draw_trial, failure_of, report
from engine_trials.vocabulary import Flavour

from icarus_lite import Belief, Percept
from icarus_lite.inference import Closure, Derivation, FactStore, percept_facts
from icarus_lite.inference.network import Network
from icarus_lite.language import parse_domain
from icarus_lite.language.checking.stratification import recursive_concepts
from icarus_lite.language.syntax import Atom, Call, ConceptClause, Domain

_PARTS = 8
_TRIALS = int(os.environ.get("ICARUS_FUZZ_PROGRAMS", "104"))


def told(trial: Trial, judge=failure_of) -> str | None:
    """Give what is wrong, of the smallest trial that shows it."""
    failure = judge(trial)
    return None if failure is None else report(*shrunk(trial, failure, judge, most=300))


@pytest.mark.parametrize("part", range(_PARTS))
def test_all_agree_in_every_cycle(part: int) -> None:
    for seed in range(part, _TRIALS, _PARTS):
        assert (wrong := told(draw_trial(seed, cycles=10))) is None, wrong


@pytest.mark.parametrize("seed", range(8))
def test_all_agree_on_a_mass_of_objects(seed: int) -> None:
    trial = draw_trial(seed, cycles=5, flavour=Flavour.MASS)
    assert len(trial.history[0].percepts) > 60
    assert (wrong := told(trial)) is None, wrong


@pytest.mark.parametrize("seed", range(8))
def test_all_agree_on_a_scene(seed: int) -> None:
    assert (wrong := told(draw_trial(seed, cycles=6, flavour=Flavour.SCENE))) is None, wrong


def objects(there: Change | World) -> set[str]:
    return {each.name for each in there.percepts if each.type == "obj"}


def test_scenes_have_what_they_are_for() -> None:
    met: Counter[str] = Counter()
    sizes = []
    for seed in range(40):
        trial = draw_trial(seed, cycles=12, flavour=Flavour.SCENE)
        sizes.append(len(trial.vocabulary.symbols))
        heads = {clause.head.predicate for clause in trial.clauses}
        columns = [
            tuple(atom.atom.attributes for atom in clause.elements[:2])
            for clause in trial.clauses
            if len(clause.head.args) == 2 and clause.elements[0].atom.attributes and clause.tests
        ]
        met["relations that share their columns"] += len(set(columns)) < len(columns) > 1
        met["relations over some columns"] += len(columns) > 1
        met["chains of relations and flags"] += any(
            {len(c.atom.args) for c in clause.elements if c.atom.predicate in heads} == {1, 2}
            for clause in trial.clauses
        )
        met["chains that rest on a not"] += any(
            c.negated and c.atom.predicate in heads
            for clause in trial.clauses
            for c in clause.elements
        )
        met["closures"] += bool(recursive_concepts(trial.clauses))
        met["all of them moving"] += any(
            not change.gone and len(change.percepts) > 4 and objects(change) == objects(world)
            for change, world in zip(trial.history[1:], worlds(trial.history), strict=False)
        )
    assert min(sizes) == 2
    assert max(sizes) > 50
    assert len(met) == 6
    assert min(met.values()) >= 5, met


def test_clips_agrees() -> None:
    for seed in range(0, 16 * PLAIN_EVERY, PLAIN_EVERY):
        assert (wrong := told(draw_trial(seed, cycles=10), clips_failure)) is None, wrong


def test_a_seed_makes_the_same_trial_twice() -> None:
    for seed in (0, 7, trials.CROWDED_EVERY - 1):
        one, other = draw_trial(seed), draw_trial(seed)
        assert (one.text(), one.history) == (other.text(), other.history)


def test_the_trials_have_all_that_makes_inference_hard() -> None:
    met: Counter[str] = Counter()
    for seed in range(60):
        trial = draw_trial(seed, cycles=6)
        domain = trial.domain()
        clauses = domain.concepts
        met["recursion"] += bool(recursive_concepts(clauses))
        met["binds"] += any(clause.binds for clause in clauses)
        met["computed argument"] += any(
            {bind.variable for bind in clause.binds} & set(clause.head.args) for clause in clauses
        )
        met["no body"] += any(not clause.elements for clause in clauses)
        met["negation"] += any(c.negated for clause in clauses for c in clause.elements)
        met["local variable"] += any(
            c.negated
            and set(c.atom.variables)
            - {v for e in clause.elements if not e.negated for v in e.atom.variables}
            for clause in clauses
            for c in clause.elements
        )
        met["repeated variable"] += any(
            len(set(c.atom.variables)) < len(c.atom.variables)
            for clause in clauses
            for c in clause.elements
        )
        met["nested test"] += any(
            isinstance(arg, Call) and test.function in ("and", "or", "not")
            for clause in clauses
            for test in clause.tests
            for arg in test.args
        )
        met["pair of percepts"] += any(
            [c.atom.predicate for c in clause.elements][:2]
            in [[a, b] for a in ("obj", "part", "spot") for b in ("obj", "part", "spot")]
            and clause.tests
            for clause in clauses
        )
        met["given and derived"] += any(
            belief.predicate in {clause.head.predicate for clause in clauses}
            for change in trial.history
            for belief in change.asserted
        )
        beliefs = [Scratch(domain).beliefs(world) for world in worlds(trial.history)]
        met["beliefs change"] += len(set(beliefs)) > len(beliefs) // 2
    assert len(met) == 11
    assert min(met.values()) >= 6, met


def test_a_network_with_a_fault_is_caught_and_the_trial_made_small(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    update = Network.update
    monkeypatch.setattr(
        Network,
        "update",
        lambda self, delta, review=None: update(self, replace(delta, withdrawn=()), review),
    )
    trials_ = (draw_trial(seed, cycles=6) for seed in range(100))
    found = ((trial, failure_of(trial)) for trial in trials_)
    trial, failure = next((t, f) for t, f in found if f is not None and "network" in f.kind)
    small, failure = shrunk(trial, failure)
    assert "network" in failure.kind
    assert len(small.clauses) == 1
    assert len(small.history) <= 3
    assert sum(len(change.asserted) for change in small.history) <= 2
    text = report(small, failure)
    assert small.text() in text
    assert "withdrawn" in text


def above() -> tuple[Domain, FactStore, dict[Belief, tuple[Derivation, ...]]]:
    """Give a small recursive domain with its facts and derivations."""
    domain, problems = parse_domain("""
        (percepts (block ^on))
        (concepts
          ((above ?a ?b) :elements ((block ?a ^on ?b) (block ?b)) :tests ((/= ?a ?b)))
          ((above ?a ?c) :elements ((above ?a ?b) (above ?b ?c) (not (cut ?a ?c))))
          ((cut ?a ?c) :elements ((block ?a ^on nothing) (block ?c))))""")
    assert domain is not None, problems
    percepts = [Percept("block", a, {"on": b}) for a, b in ("ab", "bc", "cd")]
    store = FactStore(percept_facts([*percepts, Percept("block", "d", {"on": "nothing"})], {}))
    return domain, store, Closure(domain.concepts).derive(store)


def test_right_reasons_have_no_faults() -> None:
    domain, store, derived = above()
    assert len(derived) == 6 + 4
    for belief, reasons in derived.items():
        for reason in reasons:
            assert list(faults(domain, store, belief, reason)) == []


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda r: replace(r, matched=r.matched[::-1]), "does not meet"),
        (lambda r: replace(r, matched=r.matched[:1]), "1 facts meet 2 conditions"),
        (lambda r: replace(r, matched=(Belief("above", ("d", "a")), *r.matched[1:])), "not hold"),
        (lambda r: replace(r, bindings={**r.bindings, "?c": "b"}), "does not meet"),
        (lambda r: replace(r, clause=replace(r.clause, elements=())), "none of the domain's"),
    ],
)
def test_a_wrong_reason_is_caught(change, said: str) -> None:
    domain, store, derived = above()
    belief = Belief("above", ("a", "c"))
    (reason,) = derived[belief]
    assert said in " ".join(faults(domain, store, belief, change(reason)))


def test_a_reason_that_something_blocks_is_caught() -> None:
    domain, store, derived = above()
    belief = Belief("above", ("a", "c"))
    store.add(Belief("cut", ("a", "c")))
    (fault,) = faults(domain, store, belief, derived[belief][0])
    assert fault == "(not (cut ?a ?c)) is blocked by (cut a c)"


def test_a_reason_whose_test_fails_is_caught() -> None:
    domain, store, derived = above()
    belief = Belief("above", ("a", "b"))
    (reason,) = derived[belief]
    store.add(Belief("block", ("e",), {"on": "e"}))
    looped = replace(
        reason,
        bindings={"?a": "e", "?b": "e"},
        matched=(Belief("block", ("e",)), Belief("block", ("e",))),
    )
    assert "the test (/= ?a ?b)" in " ".join(
        faults(domain, store, Belief("above", ("e", "e")), looped)
    )


def test_a_proof_in_a_circle_is_caught() -> None:
    p, q, r = (Belief(name) for name in "pqr")
    clause = ConceptClause(Atom("p"))

    def because(*facts: Belief) -> tuple[Derivation, ...]:
        return (Derivation(clause, {}, facts, ()),)

    def judged(reasons: dict[Belief, tuple[Derivation, ...]]) -> str | None:
        return circle(p, lambda each: reasons.get(each, ()), {r}.__contains__)

    assert judged({p: because(q, r), q: because(r)}) is None
    assert judged({p: because(q, q), q: because(r, r)}) is None
    assert judged({p: because(q), q: because(p)}) is not None
    assert judged({p: because(r, q), q: because(q)}) is not None
    assert judged({p: because(q)}) == "the proof of (p) ends at (q), for which there is no reason"
