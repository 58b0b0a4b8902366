"""A look at what has been inferred, before the cycle is over: what it takes back never was."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.inference.network import Budget, Delta, Network, compile_domain
from icarus_lite.inference.network.events import together
from icarus_lite.inference.network.watch import BudgetError
from icarus_lite.language import parse_domain
from icarus_lite.symbols import Belief, Percept

DOMAIN, _ = parse_domain("""
(percepts (object ^x))
(concepts
  ((held ?o) :elements ((holding ?_h ?o)))
  ((free ?o) :elements ((object ?o) (not (held ?o))))
  ((pair ?a ?b) :elements ((free ?a) (free ?b)))
  ((reach ?o ^by ?h) :elements ((holding ?h ?o)))
  ((reach ?o ^by nobody) :elements ((object ?o))))
(skills ((take ?h ?o) :elements ((object ?o) (object ?h)) :actions ((*take ?h ?o))
                      :effects ((holding ?h ?o))))
""")
assert DOMAIN is not None
COMPILED = compile_domain(DOMAIN)
HELD = Belief("holding", ("h", "a"))
OBJECTS = (Percept("object", "a"), Percept("object", "b"))


def network(budget: Budget | None = None) -> Network:
    made = COMPILED.network(budget)
    made.update(Delta(percepts=OBJECTS))
    return made


def test_the_review_sees_what_would_be_believed_and_what_it_names_goes():
    made, seen = network(), []

    def review():
        seen.extend(map(str, made.beliefs()))
        return [HELD]

    changes = made.update(Delta(asserted=(HELD,)), review)
    assert "(held a)" in seen
    assert "(free a)" not in seen
    assert (changes.added, changes.removed, changes.altered) == ((), (), ())
    assert made.cycle == 1
    assert Belief("free", ("a",)) in made.beliefs()
    assert made.asserted() == ()


def test_the_log_has_one_cycle_with_the_net_changes():
    made = network()
    made.update(Delta(asserted=(HELD,)))
    box = Percept("object", "box")
    changes = made.update(Delta(percepts=(box,)), lambda: [HELD])
    assert [str(each) for each in changes.removed] == ["(held a)", "(holding h a)"]
    assert "(free a)" in map(str, changes.added)
    assert [str(each) for each in changes.altered] == ["(reach a)"]
    assert made.intervals(Belief("held", ("a",))) == [(1, 2)]
    assert made.intervals(Belief("free", ("a",))) == [(0, 1), (2, None)]
    assert HELD in made.held_at(1)
    assert HELD not in made.held_at(2)
    assert made.recall(1).holds(HELD)
    assert not made.recall(2).holds(HELD)


def test_what_the_first_cycle_takes_back_leaves_no_trace():
    made = COMPILED.network()
    made.update_snapshot(OBJECTS, [HELD], lambda: [HELD])
    assert made.cycle == 0
    assert made.intervals(Belief("held", ("a",))) == []
    assert made.intervals(Belief("free", ("a",))) == [(0, None)]
    assert HELD not in made.held_at(0)


@pytest.mark.parametrize("cycle", [0, 1, 2])
def test_a_review_that_fails_leaves_everything_as_it_was(cycle):
    made = COMPILED.network()
    for _ in range(cycle):
        made.update(Delta(percepts=OBJECTS))
    before = made.beliefs()

    def review():
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        made.update(Delta(percepts=(Percept("object", "c"),), asserted=(HELD,)), review)
    assert made.beliefs() == before
    assert made.cycle == cycle - 1
    made.update(Delta(percepts=OBJECTS))
    assert len([each for each in made.beliefs() if each.predicate == "free"]) == 2


def test_a_budget_that_is_spent_by_what_is_taken_back_is_an_error_as_well():
    made = network(Budget(facts=5))
    things = tuple(Percept("object", name) for name in ("c", "d"))
    grips = tuple(Belief("holding", ("h", name)) for name in ("c", "d"))
    made.update(Delta(percepts=things, asserted=grips))  # pairs of a and b only
    before = made.beliefs()
    with pytest.raises(BudgetError):
        made.update(Delta(), lambda: grips)  # four free objects make sixteen pairs
    assert made.beliefs() == before
    made.update(Delta())
    assert made.beliefs() == before


KINDS = [("p", 1), ("q", 2)]
ATTRIBUTES = st.one_of(st.none(), st.sampled_from([{}, {"x": 1}, {"x": 2}]))
WORLDS = st.dictionaries(st.tuples(st.sampled_from(KINDS), st.sampled_from("abc")), ATTRIBUTES)


def events(before, after):
    """Give the events between two worlds as the network has them."""
    found = []
    for kind in KINDS:
        gained, lost, altered = [], [], []
        for key in "abc":
            old, new = before.get((kind, key)), after.get((kind, key))
            if old is None and new is not None:
                gained.append(key)
            if old is not None and new is None:
                lost.append(key)
            if old != new and (old or new):
                altered.append((key, old, new))
        if gained or lost or altered:
            found.append((kind, gained, lost, altered))
    return found


def as_sets(found):
    return {
        kind: (set(gained), set(lost), sorted(altered, key=str))
        for kind, gained, lost, altered in found
    }


@given(WORLDS, WORLDS, WORLDS)
def test_two_stretches_come_to_the_difference_of_what_was_and_is(first, second, third):
    both = together(events(first, second), events(second, third))
    assert as_sets(both) == as_sets(events(first, third))


def test_what_was_come_to_step_by_step_can_be_gone_back_to_within_the_same_budget():
    made = network(Budget(facts=5))
    things = tuple(Percept("object", name) for name in ("c", "d"))
    grips = tuple(Belief("holding", ("h", name)) for name in ("c", "d"))
    made.update(Delta(percepts=things, asserted=grips))
    assert made.recall(1).beliefs() == made.copy().beliefs() == made.beliefs()


def test_what_is_not_given_cannot_be_taken_back_and_changes_nothing():
    made = network()
    changes = made.update(Delta(asserted=(HELD,)), lambda: [Belief("holding", ("h", "b"))])
    assert list(map(str, changes.added)) == ["(held a)", "(holding h a)"]
    assert made.intervals(HELD) == [(1, None)]
