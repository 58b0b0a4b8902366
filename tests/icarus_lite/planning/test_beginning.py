"""What planning begins with is what an engine would believe in its first cycle."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from icarus_lite.inference import InferenceEngine, given_memory, given_percepts
from icarus_lite.language import load_domain, parse_domain
from icarus_lite.language.syntax import Atom, Domain
from icarus_lite.planning import Beginning, Imagination, given_beginning

DOMAINS = Path(__file__).parents[3] / "domains"

MIXED, _ = parse_domain("""
(percepts (object ^at) (part :is object ^grip))
(concepts
  ((near ?a ?b) :elements ((object ?a ^at ?x) (object ?b ^at ?x)) :tests ((/= ?a ?b)))
  ((moved ?o) :elements ((attached ?o ?_p)))
  ((loose ?o) :elements ((part ?o) (not (moved ?o)) (not (fixed ?o)))))
(skills ((fix ?o) :elements ((part ?o)) :actions ((*fix ?o)) :effects ((fixed ?o))))
(task mixed "All kinds of facts"
  :init ((part a ^at 1 ^grip 2) (object b ^at 1) (part c ^at 2) (fixed c) (attached a b) (said a c))
  :goal ((fixed a)))
""")


def of_an_engine(domain: Domain, init: tuple[Atom, ...]) -> Beginning:
    engine = InferenceEngine(domain)
    memory = engine.step_once(given_memory(domain, init), given_percepts(domain, init))
    return Imagination(domain, memory, engine.closure, engine.evaluator).beginning


def shown(beginning: Beginning) -> tuple[object, ...]:
    return (
        sorted((str(each), str(dict(each.attributes))) for each in beginning.percepts),
        sorted(map(str, beginning.asserted)),
        sorted(beginning.hierarchy.pairs()),
        sorted((str(each), str(dict(each.attributes))) for each in beginning.facts),
    )


@pytest.mark.parametrize("name", ["blocks.icr", "gripper.icr", "hanoi.icr"])
def test_the_scenes_of_a_domain_s_tests_begin_as_for_an_engine(name: str) -> None:
    domain = load_domain(DOMAINS / name)
    scenes = [(*each.percepts, *each.init) for each in domain.tests]
    assert len(scenes) > 1
    for init in scenes:
        assert shown(given_beginning(domain, init)) == shown(of_an_engine(domain, init))


def test_percepts_attachments_and_what_follows_are_all_there() -> None:
    assert MIXED is not None
    begun = given_beginning(MIXED, MIXED.tasks[0].init)
    assert shown(begun) == shown(of_an_engine(MIXED, MIXED.tasks[0].init))
    believed = {str(each) for each in begun.facts}
    assert {"(near a b)", "(near b a)", "(moved a)", "(said a c)"} <= believed
    assert not believed & {"(loose a)", "(loose c)", "(near a c)"}
    assert list(begun.hierarchy.pairs()) == [("a", "b")]
    assert begun.holds(MIXED.skills[0].elements)
    assert not begun.holds(MIXED.tasks[0].goals)


def test_facts_in_any_order_are_the_same_beginning() -> None:
    assert MIXED is not None
    init = [*MIXED.tasks[0].init]
    expected = shown(given_beginning(MIXED, init))
    for seed in range(5):
        random.Random(seed).shuffle(init)
        assert shown(given_beginning(MIXED, init)) == expected


def test_what_only_an_engine_can_weigh_is_refused() -> None:
    domain, _ = parse_domain("""
(percepts (object ^at))
(skills ((put ?o) :elements ((object ?o)) :actions ((*put ?o)) :effects ((there ?o))))
(contradictions ((there ?o) :elements ((object ?o ^at away)) :cycles 3))
""")
    assert domain is not None
    with pytest.raises(ValueError, match="contradictions"):
        given_beginning(domain, ())
