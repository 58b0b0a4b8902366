from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.inference import FactStore, match
from icarus_lite.inference.explaining.lookup import Pattern, matching
from icarus_lite.language import parse_atom
from icarus_lite.language.syntax import Atom, Constant, Variable
from icarus_lite.symbols import Belief

SLOTS = {"?x": 0, "?y": 1, "?z": 2}
NAMES = st.sampled_from(["a", "b", 1])
TERMS = st.one_of(st.sampled_from([Variable(name) for name in SLOTS]), st.builds(Constant, NAMES))
FACTS = st.lists(
    st.builds(
        lambda args, attributes: Belief("p", tuple(args), attributes),
        st.lists(NAMES, max_size=3),
        st.dictionaries(st.sampled_from(["s", "t"]), NAMES),
    ),
    max_size=8,
    unique=True,
)
ATOMS = st.builds(
    lambda args, attributes: Atom("p", tuple(args), tuple(attributes.items())),
    st.lists(TERMS, max_size=3),
    st.dictionaries(st.sampled_from(["s", "t"]), TERMS),
)


@given(atom=ATOMS, facts=FACTS, bound=st.dictionaries(st.sampled_from([*SLOTS]), NAMES))
def test_it_finds_what_matches_whatever_is_known(
    atom: Atom, facts: list[Belief], bound: dict[str, str | int]
) -> None:
    row = [bound.get(name) for name in SLOTS]
    entries, free = Pattern(atom, SLOTS, FactStore(facts)).find(row)
    expected = [(match(atom, fact, bound), fact) for fact in facts]
    assert [fact for _, fact, _ in entries] == [
        fact for found, fact in expected if found is not None
    ]
    names = list(SLOTS)
    for values, fact, _ in entries:
        extended = bound | {names[slot]: v for slot, v in zip(free, values, strict=True)}
        assert extended == match(atom, fact, bound)


def test_a_namesake_has_the_same_arguments_and_any_attributes() -> None:
    fact = Belief("object", ("a",), {"size": 3})
    pattern = Pattern(parse_atom("(object ?x ^size 4 ^color ?y)"), SLOTS, FactStore([fact]))
    assert pattern.namesake(["a", None, None]) is fact
    assert pattern.namesake([None, None, None]) is None
    assert pattern.namesake(["b", None, None]) is None


def test_what_is_free_of_the_attributes_is_bound_to_those_of_the_namesake() -> None:
    fact = Belief("object", ("a",), {"size": 3})
    pattern = Pattern(parse_atom("(object ?x ^size ?z ^color ?y)"), SLOTS, FactStore([fact]))
    row: list[str | int | float | None] = ["a", None, None]
    assert pattern.bind_attributes(fact, row) == [2]
    assert row == ["a", None, 3]


def test_matching_gives_facts_in_their_order() -> None:
    facts = [Belief("p", ("b", "b")), Belief("p", ("a", "b")), Belief("p", ("a", "a"))]
    assert matching(parse_atom("(p ?x ?x)"), FactStore(facts)) == [facts[0], facts[2]]
