"""What is written reads back as the same tree."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.language.pddl import (
    read_pddl_domain,
    read_pddl_problem,
    write_domain,
    write_problem,
)
from icarus_lite.language.pddl.syntax import (
    And,
    Effect,
    Equal,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    PddlAction,
    PddlDomain,
    PddlProblem,
    Predicate,
    Rule,
    Typed,
)
from icarus_lite.language.pddl.writer import requirements
from icarus_lite.language.syntax import Source

PROBLEMS = Path(__file__).parent / "problems"
PAIRS = [
    ("blocks", "blocks-sussman"),
    ("gripper", "gripper-3"),
    ("parcels", "parcels-1"),
    ("lift", "lift-2"),
    ("shelves", "shelves-3"),
]
X, Y = Typed("?x", "t"), Typed("?y", "u")


def atoms(names: list[str]) -> st.SearchStrategy[Formula]:
    term = st.sampled_from(names)
    return st.one_of(
        st.builds(lambda a, b: Fact("on", (a, b)), term, term),
        st.builds(lambda a: Fact("lit", (a,)), term),
        st.just(Fact("go")),
        st.builds(Equal, term, term),
    )


def formulas(names: list[str]) -> st.SearchStrategy[Formula]:
    return st.recursive(
        atoms(names),
        lambda inner: st.one_of(
            st.builds(Not, inner),
            st.lists(inner, max_size=3).map(lambda parts: And(tuple(parts))),
            st.lists(inner, max_size=3).map(lambda parts: Or(tuple(parts))),
            st.builds(lambda part: Exists((Typed("?z", "u"), Typed("?w")), part), inner),
        ),
        max_leaves=6,
    )


PARAMETERS = (Typed("?x", "t"), Typed("?y", "u"))
NAMES = ["?x", "?y", "k"]
DOMAINS = st.builds(
    lambda condition, body, literals: PddlDomain(
        "d",
        (Typed("t", "u"), Typed("u")),
        (Typed("k", "t"), Typed("m")),
        (
            Predicate("on", (Typed("?a"), Typed("?b"))),
            Predicate("lit", (Typed("?a"),)),
            Predicate("go"),
            Predicate("far", PARAMETERS),
        ),
        (Rule("far", PARAMETERS, body),),
        (
            PddlAction(
                "move",
                PARAMETERS,
                condition,
                (
                    *(Effect(Fact("on", args), negated) for args, negated in literals),
                    Effect(Fact("on", ("?x", "?v")), negated=True, every=(Typed("?v"),)),
                ),
                comment="a comment (with parentheses",
            ),
            PddlAction("wait"),
        ),
    ),
    formulas(NAMES),
    formulas(NAMES),
    st.lists(
        st.tuples(st.tuples(st.sampled_from(NAMES), st.sampled_from(NAMES)), st.booleans()),
        max_size=3,
    ),
)


@settings(max_examples=60)
@given(DOMAINS, formulas(["k", "a"]))
def test_what_is_written_reads_back(domain: PddlDomain, goal: Formula) -> None:
    read, found = read_pddl_domain(Source("d.pddl", write_domain(domain, ["a remark"])))
    assert found == ()
    assert read == domain
    problem = PddlProblem("p", "d", (Typed("a", "t"), Typed("b")), (Fact("on", ("a", "k")),), goal)
    again, found = read_pddl_problem(Source("p.pddl", write_problem(problem)), domain)
    assert found == ()
    assert again == problem


@pytest.mark.parametrize(("name", "problem"), PAIRS)
def test_the_benchmarks_read_back(name: str, problem: str) -> None:
    domain, _ = read_pddl_domain(Source("", (PROBLEMS / f"{name}.pddl").read_text()))
    assert domain is not None
    assert read_pddl_domain(Source("", write_domain(domain)))[0] == domain
    task, _ = read_pddl_problem(Source("", (PROBLEMS / f"{problem}.pddl").read_text()), domain)
    assert task is not None
    assert read_pddl_problem(Source("", write_problem(task)), domain)[0] == task


def test_lines_are_not_longer_than_a_hundred_characters_where_they_can_be_broken() -> None:
    for name, _ in PAIRS:
        domain, _ = read_pddl_domain(Source("", (PROBLEMS / f"{name}.pddl").read_text()))
        assert domain is not None
        assert all(len(line) <= 100 for line in write_domain(domain).split("\n"))


def test_requirements_say_what_the_text_needs_and_no_more() -> None:
    plain = PddlAction("a", (X,), And((Fact("p", ("?x",)),)), (Effect(Fact("q")),))
    assert requirements(PddlDomain("d", actions=(plain,))) == (":strips", ":typing")
    rich = PddlAction(
        "b",
        (X, Y),
        Or((Not(Equal("?x", "?y")), Exists((Typed("?z"),), Fact("p", ("?z",))))),
        (Effect(Fact("q"), negated=True, every=(Typed("?z"),)),),
    )
    rule = Rule("p", (X,), Fact("q"))
    assert requirements(PddlDomain("d", rules=(rule,), actions=(rich,))) == (
        ":strips",
        ":typing",
        ":negative-preconditions",
        ":disjunctive-preconditions",
        ":existential-preconditions",
        ":equality",
        ":conditional-effects",
        ":derived-predicates",
    )
