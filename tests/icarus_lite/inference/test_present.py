"""Looking facts up one by one gives what taking all of them in gives."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.inference import Context, InferenceEngine, Memory
from icarus_lite.inference.explaining.lookup import matching
from icarus_lite.inference.present import PresentFacts
from icarus_lite.language import parse_atom, parse_domain
from icarus_lite.language.syntax import Atom, Constant, Variable
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Belief, Percept

DOMAIN, PROBLEMS = parse_domain("""
(percepts (object ^x) (part :is object))
(concepts
  ((near ?a ?b) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
                :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 2)))
  ((linked ?a ?b) :elements ((near ?a ?b) (object ?a ^x ?x)) :tests ((> ?x 1)))
  ((linked ?a ?c) :elements ((near ?a ?b) (linked ?b ?c)))
  ((gap ?a ?b ^is ?d) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb)) :binds ((?d (- ?xb ?xa))))
  ((alone ?a) :elements ((object ?a) (not (near ?a ?any))))
  ((attached ?a ?b) :elements ((near ?a ?b) (part ?a)))
  ((quiet) :elements ((not (near ?any ?other)))))
(skills ((glue ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*glue ?a ?b))
                      :effects ((attached ?a ?b) (glued ?a))))
""")
assert DOMAIN is not None, PROBLEMS
ENGINE = InferenceEngine(DOMAIN)
SIGNATURES = {
    "near": 2, "linked": 2, "gap": 2, "alone": 1, "attached": 2, "quiet": 0, "glued": 1,
    "object": 1, "part": 1, "nothing": 1,
}  # fmt: skip
TERMS = st.one_of(
    st.sampled_from([Variable("?u"), Variable("?v")]),
    st.sampled_from([Constant("o0"), Constant("o1"), Constant("o2"), Constant("zzz")]),
)
PATTERNS = st.sampled_from(sorted(SIGNATURES)).flatmap(
    lambda name: st.builds(
        lambda args, gap: Atom(name, tuple(args), (("is", gap),) if name == "gap" else ()),
        st.lists(TERMS, min_size=SIGNATURES[name], max_size=SIGNATURES[name]),
        st.one_of(TERMS, st.builds(Constant, st.integers(-2, 2))),
    )
)


def state_of(places: list[int], *, glued: bool):
    percepts = [
        Percept("part" if n % 2 else "object", f"o{n}", {"x": x}) for n, x in enumerate(places)
    ]
    done = [Outcome(Action("glue", ("o0", "o2")))] if glued else []
    return ENGINE.step(Memory(), percepts, done).state


@settings(max_examples=60, deadline=None)
@given(
    places=st.lists(st.integers(0, 6), max_size=5),
    glued=st.booleans(),
    patterns=st.lists(PATTERNS, min_size=1, max_size=8),
)
def test_it_is_the_same_as_all_facts(
    *, places: list[int], glued: bool, patterns: list[Atom]
) -> None:
    state = state_of(places, glued=glued)
    one_by_one = Context(DOMAIN, state).facts
    everything = state.facts()
    assert isinstance(one_by_one, PresentFacts)
    for pattern in patterns:
        assert matching(pattern, one_by_one) == matching(pattern, everything), str(pattern)
        rows, expected = one_by_one.rows(pattern.predicate), everything.rows(pattern.predicate)
        assert len(rows) == len(expected)
        for fact in matching(pattern, everything):
            found = rows[fact.args][0][1]
            assert (found, dict(found.attributes)) == (fact, dict(fact.attributes))


def test_a_question_about_two_objects_does_not_take_in_the_rest() -> None:
    state = state_of([0, 1, 2, 3, 4], glued=False)
    facts = Context(DOMAIN, state).facts
    assert matching(parse_atom("(near o0 o1)"), facts) == [Belief("near", ("o0", "o1"))]
    assert len(matching(parse_atom("(near o1 ?b)"), facts)) == 2
    assert len(facts.rows("near")) == 8
    assert "near" not in facts._known
    assert sorted(str(fact) for ((_, fact, _),) in facts.rows("linked").values())
    assert "linked" in facts._known


def test_it_answers_for_a_cycle_that_is_over_as_well() -> None:
    percepts = [Percept("object", f"o{n}", {"x": n}) for n in range(3)]
    memory = ENGINE.step(Memory(), percepts)
    before = memory.state
    ENGINE.step(memory, percepts[:1])
    facts = Context(DOMAIN, before).facts
    assert len(matching(parse_atom("(near ?a ?b)"), facts)) == 4
    assert matching(parse_atom("(near o0 ?b)"), facts) == [Belief("near", ("o0", "o1"))]
    assert len(facts.rows("near")) == 4
