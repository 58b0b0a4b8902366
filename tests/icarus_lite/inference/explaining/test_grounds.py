"""What can be established without a belief, and never by way of itself."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.inference import Assertion, Derivation
from icarus_lite.inference.explaining.grounds import well_founded
from icarus_lite.language.syntax import Atom, ConceptClause
from icarus_lite.symbols import Action, Belief

NODES = [Belief(name) for name in "abcdef"]
A, B, C, *_ = NODES
CLAUSE = ConceptClause(Atom("p"))
BASE = Belief("percept")


def by(*premises: Belief) -> Derivation:
    return Derivation(CLAUSE, {}, premises, ())


def test_two_that_support_each_other_establish_nothing() -> None:
    assert well_founded([A], {A: (by(B),), B: (by(A),)}) == {}


def test_the_way_that_leaves_the_belief_out_is_found() -> None:
    supports = {A: (by(BASE),), B: (by(A), by(BASE)), C: (by(B),)}
    chosen = well_founded([C], supports, without=A)
    assert chosen == {B: by(BASE), C: by(B)}


def test_an_assertion_needs_nothing() -> None:
    asserted = Assertion(Action("drop"), 3)
    assert well_founded([A], {A: (by(B), asserted), B: (by(A),)})[A] == asserted


@given(
    st.dictionaries(
        st.sampled_from(NODES),
        st.lists(
            st.lists(st.sampled_from([*NODES, BASE]), max_size=3).map(lambda p: by(*p)),
            min_size=1,
            max_size=3,
        ).map(tuple),
    ),
    st.sampled_from([None, *NODES]),
)
def test_it_is_the_least_fixpoint_and_its_choices_lead_down(
    supports: dict[Belief, tuple[Derivation, ...]], without: Belief | None
) -> None:
    chosen = well_founded(NODES, supports, without=without)
    established = {BASE, *(n for n in NODES if n not in supports)} - {without}
    while True:
        more = {
            belief
            for belief, held in supports.items()
            if belief != without and any(established.issuperset(each.matched) for each in held)
        }
        if more <= established:
            break
        established |= more
    assert set(chosen) == established & set(supports)
    depth = dict.fromkeys(established - set(chosen), 0)
    for belief in [*chosen] * len(chosen):  # each premise is established before what rests on it
        support = chosen[belief]
        if isinstance(support, Derivation) and all(p in depth for p in support.matched):
            below = max((depth[p] for p in support.matched), default=0)
            depth.setdefault(belief, below + 1)
    assert set(depth) >= set(chosen)
