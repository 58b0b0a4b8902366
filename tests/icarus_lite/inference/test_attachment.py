from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from icarus_lite import Action
from icarus_lite.inference import Hierarchy, advance
from icarus_lite.language.reading.reader import parse_domain

_DOMAIN, _ = parse_domain("""
(attachments
  ((pick-up ?hand ?obj) :until (place-down ?hand ?obj) :child ?obj :parent ?hand)
  ((insert ?obj ?into)  :until (take-out ?obj ?into)   :child ?obj :parent ?into)
  ((contain ?cone ?obj) :until (pick-place ?cone)      :child ?obj :parent ?cone))
""")
RULES = _DOMAIN.attachments


def run(*actions: tuple[str, ...]) -> tuple[set[tuple], tuple[str, ...]]:
    hierarchy, notes = Hierarchy(), ()
    for cycle, (name, *args) in enumerate(actions):
        hierarchy, refused = advance(hierarchy, RULES, Action(name, tuple(args)), cycle)
        notes += refused
    return set(hierarchy.pairs()), notes


def test_attach_adds_and_detach_removes_the_pair() -> None:
    assert run(("pick-up", "hand", "o")) == ({("o", "hand")}, ())
    assert run(("pick-up", "hand", "o"), ("place-down", "hand", "o")) == (set(), ())


def test_detach_of_another_pair_changes_nothing() -> None:
    assert run(("pick-up", "h1", "o"), ("place-down", "h2", "o"))[0] == {("o", "h1")}


def test_a_new_parent_replaces_the_old_one() -> None:
    assert run(("pick-up", "hand", "plug"), ("insert", "plug", "case"))[0] == {("plug", "case")}


def test_the_hierarchy_of_the_papers_figure() -> None:
    pairs, _ = run(
        ("insert", "hubcover", "case"),
        ("insert", "subassembly", "case"),
        ("insert", "plug", "case"),
        ("pick-up", "hand", "case"),
    )
    assert pairs == {
        ("hubcover", "case"),
        ("subassembly", "case"),
        ("plug", "case"),
        ("case", "hand"),
    }


def test_a_detach_that_leaves_the_child_open_frees_all_children() -> None:
    pairs, _ = run(("contain", "cone", "a"), ("contain", "cone", "b"), ("pick-place", "cone"))
    assert pairs == set()


def test_a_circle_is_refused_and_said() -> None:
    pairs, notes = run(("insert", "plug", "case"), ("insert", "case", "plug"))
    assert pairs == {("plug", "case")}
    assert notes == (
        "refused: (insert case plug) would attach case to plug, but plug already moves with case",
    )


def test_nothing_is_attached_to_itself() -> None:
    assert run(("insert", "a", "a")) == (
        set(),
        ("refused: (insert a a) would attach a to a, but it is the same",),
    )


_NAMES = st.sampled_from("abcde")
_ACTIONS = st.lists(
    st.tuples(st.sampled_from(["pick-up", "place-down", "insert", "take-out"]), _NAMES, _NAMES),
    max_size=25,
)


@given(_ACTIONS)
def test_always_a_forest(actions: list[tuple[str, ...]]) -> None:
    hierarchy = Hierarchy()
    for name, *args in actions:
        hierarchy, _ = advance(hierarchy, RULES, Action(name, tuple(args)), 0)
        children = [child for child, _ in hierarchy.pairs()]
        assert len(children) == len(set(children))
        for child in children:
            assert child not in list(hierarchy.ancestors(child))


@given(_ACTIONS, _NAMES, _NAMES)
def test_attach_then_detach_leaves_no_trace_of_a_free_child(
    actions: list[tuple[str, ...]], child: str, parent: str
) -> None:
    hierarchy = Hierarchy()
    for name, *args in actions:
        hierarchy, _ = advance(hierarchy, RULES, Action(name, tuple(args)), 0)
    if child in dict(hierarchy.pairs()):
        return
    attached, _ = advance(hierarchy, RULES, Action("insert", (child, parent)), 1)
    freed, _ = advance(attached, RULES, Action("take-out", (child, parent)), 2)
    assert dict(freed.pairs()) == dict(hierarchy.pairs())
