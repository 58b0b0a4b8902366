"""How far a clause got, and what stopped it."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.inference import Evaluator, FactStore, Matcher
from icarus_lite.inference.near_miss import first_obstacle, near_misses, nearest_beliefs
from icarus_lite.language import parse_atom, parse_conditions, parse_domain
from icarus_lite.language.syntax import Atom, Call, Condition, Constant, Variable
from icarus_lite.symbols import Belief

DOMAIN, PROBLEMS = parse_domain("""
(percepts (block ^size) (hand))
(concepts
  ((pair ?a ?b) :elements ((block ?a ^size ?s) (block ?b ^size ?t)) :tests ((< ?s ?t)))
  ((pair ?a nobody) :elements ((block ?a ^size 9)))
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any)))))
(skills
  ((grasp ?h ?b) :elements ((hand ?h) (block ?b) (not (holding ?h ?any))) :actions ((*grasp ?b))
                 :effects ((holding ?h ?b))))
""")
assert DOMAIN is not None, PROBLEMS


def facts(*beliefs: Belief) -> FactStore:
    return FactStore(beliefs)


def block(name: str, size: int) -> Belief:
    return Belief("block", (name,), {"size": size})


def misses(asked: str, *beliefs: Belief) -> list[str]:
    return [str(m) for m in near_misses(parse_atom(asked), DOMAIN.concepts, facts(*beliefs))]


def test_the_test_that_fails_is_shown_with_its_numbers() -> None:
    first, second = misses("(pair a b)", block("a", 3), block("b", 2))
    assert first == "line 4, (pair ?a ?b): (< 3 2) is not so"
    assert second == "line 5, (pair ?a nobody): its head cannot stand for this"


def test_the_element_that_nothing_matches_is_shown_as_far_as_it_is_bound() -> None:
    first, second = misses("(pair a nobody)", block("a", 3))
    assert first == "line 4, (pair ?a ?b): nothing matches (block nobody ^size ?t)"
    assert second == "line 5, (pair ?a nobody): nothing matches (block a ^size 9)"


def test_the_belief_that_a_not_forbids_is_named() -> None:
    (miss,) = misses("(free h)", Belief("hand", ("h",)), Belief("holding", ("h", "b")))
    assert miss == "line 6, (free ?h): (not (holding h ?any)) fails: (holding h b) is believed"


def test_the_attempt_that_got_furthest_counts() -> None:
    smallest, middle, largest = block("a", 1), block("b", 2), block("c", 3)
    (miss, _) = near_misses(
        parse_atom("(pair ?x a)"), DOMAIN.concepts, facts(smallest, middle, largest)
    )
    assert miss.obstacle is not None
    assert (miss.obstacle.met, str(miss.obstacle)) == (2, "(< 1 1) is not so")


def test_a_clause_that_holds_has_no_obstacle() -> None:
    first, _ = near_misses(
        parse_atom("(pair a b)"), DOMAIN.concepts, facts(block("a", 1), block("b", 2))
    )
    assert first.obstacle is None
    assert str(first) == "line 4, (pair ?a ?b): all its conditions hold"


def test_another_number_of_arguments_does_not_fit() -> None:
    assert [m.fits for m in near_misses(parse_atom("(pair a)"), DOMAIN.concepts, facts())] == [
        False,
        False,
    ]


def test_skills_are_asked_about_in_the_same_way() -> None:
    known = facts(Belief("hand", ("h",)), block("a", 1), Belief("holding", ("h", "b")))
    (miss,) = near_misses(parse_atom("(grasp h a)"), DOMAIN.skills, known)
    assert miss.obstacle is not None
    assert str(miss.obstacle.condition) == "(not (holding ?h ?any))"
    assert miss.obstacle.blocking == Belief("holding", ("h", "b"))


def test_the_nearest_beliefs_agree_in_most_arguments() -> None:
    known = [Belief("on", pair) for pair in (("c", "d"), ("a", "c"), ("b", "b"), ("a", "a"))]
    near = nearest_beliefs(parse_atom("(on a b)"), facts(*known, Belief("clear", ("a",))))
    assert list(map(str, near)) == ["(on a a)", "(on a c)", "(on b b)"]


_NAMES = st.sampled_from(["a", "b"])
_TERMS = st.one_of(
    st.sampled_from([Variable("?x"), Variable("?y"), Variable("?z")]), st.builds(Constant, _NAMES)
)
_ATOMS = st.one_of(
    st.builds(lambda a, b: Atom("p", (a, b)), _TERMS, _TERMS),
    st.builds(lambda a: Atom("q", (a,)), _TERMS),
)
_FACTS = st.lists(
    st.one_of(
        st.builds(lambda a, b: Belief("p", (a, b)), _NAMES, _NAMES),
        st.builds(lambda a: Belief("q", (a,)), _NAMES),
    ),
    max_size=5,
)
_CONJUNCTIONS = st.lists(st.builds(Condition, _ATOMS, st.booleans()), max_size=4)


@given(conditions=_CONJUNCTIONS, differ=st.booleans(), known=_FACTS)
def test_there_is_an_obstacle_just_where_there_is_no_match(
    *, conditions: list[Condition], differ: bool, known: list[Belief]
) -> None:
    bound = {name for c in conditions if not c.negated for name in c.atom.variables}
    tests = [Call("/=", (Variable("?x"), Variable("?y")))] if {"?x", "?y"} <= bound else []
    tests = tests if differ else []
    store = FactStore(known)
    matches = any(True for _ in Matcher(conditions, tests).matches(store))
    obstacle = first_obstacle(conditions, tests, store, {}, Evaluator())
    assert matches == (obstacle is None)
    if obstacle is not None:
        assert 0 <= obstacle.met < len(conditions) + len(tests)


def test_free_variables_read_as_anything() -> None:
    (condition,) = parse_conditions("(holding ?h ?any)")
    obstacle = first_obstacle([condition], [], facts(), {"?h": "h1"}, Evaluator())
    assert str(obstacle) == "nothing matches (holding h1 ?any)"
