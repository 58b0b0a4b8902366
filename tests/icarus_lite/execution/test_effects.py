from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite import Belief
from icarus_lite.execution.effects import (
    are_believed,
    effects_of,
    missing_effect,
    ways_believed,
)
from icarus_lite.inference import FactStore, change_of
from icarus_lite.language import parse_conditions, parse_domain

DOMAIN, PROBLEMS = parse_domain("""
(percepts (hand) (object ^type))
(skills
  ((pick-up ?hand ?obj) :elements ((hand ?hand) (object ?obj)) :actions ((*grasp ?hand ?obj))
                        :effects ((holding ?hand ?obj)))
  ((put-down ?h ?o) :elements ((holding ?h ?o)) :actions ((*open ?h))
                    :effects ((not (holding ?h ?o))))
  ((insert ?o plug-hole) :elements ((holding ?h ?o)) :actions ((*insert ?h ?o)))
  ((insert ?o socket) :elements ((holding ?h ?o)) :actions ((*plug-in ?h ?o)))
  ((shake ?h) :elements ((hand ?h)) :actions ((*shake ?h)))
  ((fetch ?h ?o) :subskills ((pick-up ?h ?o)) :effects ((holding ?h ?o))))
(attachments
  ((pick-up ?a ?b) :until (put-down ?a ?b) :child ?b :parent ?a)
  ((insert ?o plug-hole) :until (shake ?x) :child ?o :parent plug-hole)
  ((insert ?same ?same) :until (put-down ?same ?same) :child ?same :parent wall))
""")
assert DOMAIN is not None, PROBLEMS


def effects(name: str, which: int = 0) -> list[str]:
    clause = [c for c in DOMAIN.skills if c.head.predicate == name][which]
    return [str(effect) for effect in effects_of(clause, DOMAIN.attachments)]


def test_a_skill_attaches_and_detaches_in_its_own_variables() -> None:
    assert effects("pick-up") == ["(holding ?hand ?obj)", "(attached ?obj ?hand)"]
    assert effects("put-down") == ["(not (holding ?h ?o))", "(not (attached ?o ?h))"]
    assert effects("insert") == ["(attached ?o plug-hole)"]
    assert effects("insert", 1) == [], "the table speaks of another hole"


def test_what_a_detach_leaves_open_stands_for_all() -> None:
    (effect,) = effects("shake")
    assert effect.startswith("(not (attached ?")


def test_it_is_the_primitive_that_attaches_and_not_the_macro_above_it() -> None:
    assert effects("fetch") == ["(holding ?h ?o)"]


def store(*beliefs: str) -> FactStore:
    return FactStore(Belief(b.split()[0], tuple(b.split()[1:])) for b in beliefs)


@pytest.mark.parametrize(
    ("wanted", "believed", "holds"),
    [
        ("(in b hall)", ["in b hall"], True),
        ("(in b hall)", ["in c hall"], False),
        ("(in b ?room)", ["in b hall"], True),
        ("((in b hall) (not (in b ?elsewhere)))", ["in b hall"], True),
        ("((in b hall) (not (in b ?elsewhere)))", ["in b hall", "in b cellar"], False),
        ("(not (in b ?anywhere))", ["in c hall"], True),
        ("(not (in b ?anywhere))", ["in b hall"], False),
        ("((on a ?x) (on ?x c))", ["on a b", "on b c"], True),
        ("((on a ?x) (on ?x c))", ["on a b", "on d c"], False),
    ],
)
def test_when_effects_are_believed(wanted: str, believed: list[str], holds: bool) -> None:  # noqa: FBT001
    conditions = parse_conditions(wanted)
    facts = store(*believed)
    assert are_believed(conditions, {}, facts) is holds
    if len(conditions) == 1:
        assert (missing_effect(conditions, {}, facts) is None) is holds


def test_no_effects_are_never_believed() -> None:
    assert not are_believed((), {}, store("on a b"))


def test_each_way_binds_what_was_free() -> None:
    facts = store("in b hall", "in b cellar")
    ways = list(ways_believed(parse_conditions("(in b ?room)"), {"?k": "v"}, facts))
    assert ways == [{"?k": "v", "?room": "hall"}, {"?k": "v", "?room": "cellar"}]


names = st.sampled_from(["a", "b", "c"])
literals = st.lists(
    st.tuples(
        st.booleans(), st.sampled_from(["on", "at"]), names, st.sampled_from(["a", "b", "?x"])
    ),
    min_size=1,
    max_size=4,
)


@given(literals, st.lists(st.tuples(st.sampled_from(["on", "at"]), names, names), max_size=8))
def test_effects_are_believed_once_they_have_been_made_true(
    wanted: list[tuple[bool, str, str, str]], before: list[tuple[str, str, str]]
) -> None:
    """Add what they add to any beliefs, take away what they remove: then they are believed."""
    texts = [
        f"(not ({p} {a} {b}))" if negated else f"({p} {a} {'a' if b == '?x' else b})"
        for negated, p, a, b in wanted
    ]
    conditions = parse_conditions(f"({' '.join(texts)})")
    change = change_of(conditions, {})
    old = [Belief(p, args) for p, *args_ in before for args in [tuple(args_)]]
    after = FactStore([*(b for b in old if not change.removes(b)), *change.added])
    assert are_believed(conditions, {}, after)
    assert missing_effect(conditions, {}, after) is None
    for lost in change.added:
        without = FactStore(fact for fact in after if fact != lost)
        assert not are_believed(conditions, {}, without)
