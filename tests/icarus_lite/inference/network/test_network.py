from __future__ import annotations

import math

import pytest

from icarus_lite import Belief, FrameError, Percept
from icarus_lite.errors import InferenceError
from icarus_lite.inference.network import Budget, Changes, Delta, Network, compile_domain
from icarus_lite.language import parse_domain
from icarus_lite.language.fragments import parse_atom

TEXT = """
(percepts (obj ^type ^x) (part :is obj ^grip))
(concepts
  ((near ?a ?b)
   :elements ((obj ?a ^x ?xa) (obj ?b ^x ?xb))
   :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 3)))
  ((free ?a) :elements ((obj ?a) (not (holding ?a))))
  ((reaches ?a ?b) :elements ((near ?a ?b) (free ?a)))
  ((reaches ?a ?c) :elements ((near ?a ?b) (free ?a) (reaches ?b ?c)))
  ((alone ?a) :elements ((obj ?a) (not (near ?a ?_))))
  ((apart ?a ?b ^gap ?gap)
   :elements ((near ?a ?b) (obj ?a ^x ?xa) (obj ?b ^x ?xb))
   :binds ((?gap (- ?xa ?xb)))))
"""


def network(text: str = TEXT, budget: Budget | None = None, **functions: object) -> Network:
    domain, problems = parse_domain(text, "scene.icr")
    assert domain is not None, problems
    return compile_domain(domain, functions or None).network(budget)


def obj(name: str, x: float, type_: str = "peg") -> Percept:
    return Percept("obj", name, {"type": type_, "x": x})


def row(count: int, step: float = 2) -> tuple[Percept, ...]:
    return tuple(obj(f"o{i}", i * step) for i in range(count))


def texts(beliefs: object) -> list[str]:
    return [str(belief) for belief in beliefs]  # type: ignore[attr-defined] # any iterable


def told(changes: Changes) -> tuple[list[str], list[str], list[str]]:
    return texts(changes.added), texts(changes.removed), texts(changes.altered)


def test_an_update_gives_the_net_changes_in_canonical_order() -> None:
    net = network()
    first = net.update(Delta(row(2)))
    assert told(first) == (
        [
            "(apart o0 o1)", "(apart o1 o0)", "(free o0)", "(free o1)", "(near o0 o1)",
            "(near o1 o0)", "(reaches o0 o0)", "(reaches o0 o1)", "(reaches o1 o0)",
            "(reaches o1 o1)",
        ],
        [],
        [],
    )  # fmt: skip
    grasped = net.update(Delta(asserted=(Belief("holding", ("o1",)),)))
    assert told(grasped) == (
        ["(holding o1)"],
        ["(free o1)", "(reaches o0 o0)", "(reaches o1 o0)", "(reaches o1 o1)"],
        [],
    )


def test_what_is_taken_back_within_a_cycle_is_no_change() -> None:
    net = network()
    net.update(Delta(row(3)))
    held = Belief("holding", ("o1",))
    changes = net.update(Delta((obj("o0", 0),), asserted=(held,), withdrawn=(held,)))
    assert told(changes)[0][0] == "(holding o1)"  # both asserted and withdrawn: it stays
    assert told(net.update(Delta((obj("o0", 0),)))) == ([], [], [])


def test_moved_objects_and_whole_pictures_come_to_the_same() -> None:
    moved, seen = network(), network()
    for net in (moved, seen):
        net.update(Delta(row(5)))
    one = moved.move("obj", ["o0", "o3"], {"x": [4, 1.5]}, [Belief("holding", ("o2",))])
    picture = [obj("o0", 4), obj("o1", 2), obj("o2", 4), obj("o3", 1.5), obj("o4", 8)]
    other = seen.update_snapshot(picture, [Belief("holding", ("o2",))])
    assert told(one) == told(other)
    assert told(one)[2] == [] or set(told(one)[2]) <= set(texts(moved.beliefs()))
    assert moved.beliefs() == seen.beliefs()
    assert [b.attributes for b in moved.beliefs()] == [b.attributes for b in seen.beliefs()]


def test_attributes_that_change_alone_are_told_apart() -> None:
    net = network()
    net.update(Delta(row(2)))
    changes = net.move("obj", ["o1"], {"x": [1]})
    assert told(changes) == ([], [], ["(apart o0 o1)", "(apart o1 o0)"])
    assert {str(b): b.attributes["gap"] for b in net.facts("apart")} == {
        "(apart o0 o1)": -1,
        "(apart o1 o0)": 1,
    }


def test_an_object_that_goes_takes_its_rows_along_and_its_place_is_used_again() -> None:
    net = network()
    net.update(Delta(row(3)))
    changes = net.update(Delta((obj("new", 100),), gone=(("obj", "o1"),)))
    assert {"(free o1)", "(near o0 o1)"} <= set(told(changes)[1])
    assert told(changes)[0] == ["(alone new)", "(alone o0)", "(alone o2)", "(free new)"]
    fresh = network()
    fresh.update(Delta((obj("o0", 0), obj("o2", 4), obj("new", 100))))
    assert net.beliefs() == fresh.beliefs()


def test_percepts_of_a_subtype_count_as_those_of_its_supertype() -> None:
    net = network()
    net.update(Delta((Percept("part", "p1", {"x": 1}), obj("o1", 2))))
    assert net.holds(Belief("near", ("p1", "o1")))
    net.move("part", ["p1"], {"x": [50]})
    assert not net.holds(Belief("near", ("p1", "o1")))
    with pytest.raises(FrameError, match="2 percepts of type obj are named p1"):
        net.update(Delta((obj("p1", 0),)))
    assert net.holds(Belief("alone", ("p1",)))


def test_it_can_be_asked() -> None:
    net = network()
    net.update(Delta(row(3), asserted=(Belief("holding", ("o2",)),)))
    assert net.count("near") == 4
    assert sorted(texts(net.facts("free"))) == ["(free o0)", "(free o1)"]
    assert texts(net.facts("holding")) == ["(holding o2)"]
    assert not net.holds(Belief("obj", ("o1",)))  # a percept is no belief
    assert list(net.matches(parse_atom("(obj ?o ^x 2)"))) == [{"?o": "o1"}]
    assert list(net.matches(parse_atom("(near ?a ?b)"), {"?b": "o0"})) == [{"?b": "o0", "?a": "o1"}]
    assert list(net.matches(parse_atom("(near o0 o1)"))) == [{}]
    assert list(net.matches(parse_atom("(nothing ?a)"))) == []


def test_a_copy_goes_its_own_way() -> None:
    net = network()
    net.update(Delta(row(4)))
    net.move("obj", ["o0"], {"x": [90]})
    before, log = net.beliefs(), net.intervals(Belief("near", ("o0", "o1")))
    other = net.copy()
    assert other.beliefs() == before
    other.move("obj", ["o1"], {"x": [89]}, [Belief("holding", ("o3",))])
    assert other.beliefs() != before
    assert net.beliefs() == before
    assert net.intervals(Belief("near", ("o0", "o1"))) == log == [(0, 1)]
    assert other.intervals(Belief("near", ("o0", "o1"))) == [(0, 1), (2, None)]


def test_the_log_tells_when_and_what() -> None:
    net = network()
    near = Belief("near", ("o0", "o1"))
    history = []
    for x in (2, 9, 2, 2, 9):
        net.update_snapshot([obj("o0", 0), obj("o1", x)], [])
        history.append(frozenset(net.beliefs()))
    assert net.intervals(near) == [(0, 1), (2, 4)]
    assert net.intervals(Belief("alone", ("o0",))) == [(1, 2), (4, None)]
    assert net.intervals(Belief("near", ("o0", "o9"))) == []
    assert [net.held_at(cycle) for cycle in range(5)] == history
    gaps = {b: b.attributes["gap"] for b in net.held_at(2) if b.predicate == "apart"}
    assert gaps == {Belief("apart", ("o0", "o1")): -2, Belief("apart", ("o1", "o0")): 2}
    with pytest.raises(ValueError, match="there is no cycle 5; the last one is 4"):
        net.held_at(5)


def test_every_derivation_is_found_and_the_first_never_circles() -> None:
    net = network()
    net.update(Delta(row(4)))
    reaches = Belief("reaches", ("o0", "o0"))
    assert len(net.supports(reaches)) == 1
    seen: list[Belief] = []
    pending = [reaches]
    while pending:
        belief = pending.pop()
        seen.append(belief)
        assert len(seen) < 50, "the proof goes round in a circle"
        found = net.supports(belief)
        if found:
            pending += found[0].matched
    (apart,) = net.supports(Belief("apart", ("o0", "o1")))
    assert apart.bindings == {"?a": "o0", "?b": "o1", "?xa": 0, "?xb": 2, "?gap": -2}
    assert texts(apart.matched) == ["(near o0 o1)", "(obj o0)", "(obj o1)"]
    (free,) = net.supports(Belief("free", ("o0",)))
    assert texts(free.absent) == ["(holding o0)"]
    assert net.supports(Belief("free", ("o9",))) == ()


@pytest.mark.parametrize("value", [math.nan, math.inf, True, None])
def test_what_is_no_value_is_refused_where_it_enters(value: object) -> None:
    net = network()
    net.update(Delta(row(2)))
    before = net.beliefs()
    with pytest.raises(FrameError, match=r"attribute x of o1 is .*, (not finite|neither a number)"):
        net.update(Delta((obj("o0", 1), obj("o1", value))))  # type: ignore[arg-type] # the point
    with pytest.raises(FrameError, match="attribute x of o1 is"):
        net.move("obj", ["o0", "o1"], {"x": [1, value]})  # type: ignore[list-item] # the point
    with pytest.raises(FrameError, match="an argument of holding is"):
        net.update(Delta((obj("o0", 1),), asserted=(Belief("holding", (value,)),)))  # type: ignore[arg-type] # the point
    assert net.beliefs() == before
    assert net.cycle == 0


def test_a_move_must_be_of_objects_that_are_there() -> None:
    net = network()
    net.update(Delta(row(2)))
    with pytest.raises(FrameError, match="no percept of type obj named o7"):
        net.move("obj", ["o0", "o7"], {"x": [1, 2]})
    with pytest.raises(FrameError, match="moved twice"):
        net.move("obj", ["o0", "o0"], {"x": [1, 2]})
    with pytest.raises(FrameError, match="2 objects, but 1 values of x"):
        net.move("obj", ["o0", "o1"], {"x": [1]})
    assert {str(b): b.attributes["gap"] for b in net.facts("apart")}["(apart o1 o0)"] == 2


CROSS = """
(percepts (obj ^x))
(concepts
  ((pair ?a ?b) :elements ((obj ?a) (obj ?b)))
  ((three ?a ?b ?c) :elements ((pair ?a ?b) (obj ?c))))
"""


def test_a_domain_that_explodes_is_stopped_and_names_the_clause() -> None:
    net = network(CROSS, Budget(facts=500))
    net.update(Delta(row(5)))
    before = net.beliefs()
    with pytest.raises(InferenceError, match=r"scene\.icr:5: \(three .* more than 500 beliefs"):
        net.update(Delta(row(12)))
    assert net.beliefs() == before
    assert net.cycle == 0
    net.update(Delta(row(6)))
    fresh = network(CROSS)
    fresh.update(Delta(row(6)))
    assert net.beliefs() == fresh.beliefs()


def test_a_first_cycle_beyond_the_budget_leaves_a_network_that_believes_nothing() -> None:
    net = network(CROSS, Budget(facts=500))
    with pytest.raises(InferenceError, match="the budget"):
        net.update(Delta(row(40)))
    assert net.beliefs() == ()
    net.update(Delta(row(3)))
    assert net.count("three") == 27


def test_a_cycle_that_takes_too_long_is_stopped() -> None:
    net = network(CROSS, Budget(seconds=0.0))
    with pytest.raises(InferenceError, match=r"was being joined when the cycle had taken 0\.0 s"):
        net.update(Delta(row(30)))


def test_a_mistake_in_a_test_leaves_everything_as_it_was() -> None:
    net = network()
    net.update(Delta(row(3)))
    before = net.beliefs()
    with pytest.raises(InferenceError, match=r"scene\.icr:6:.*\?xb is the symbol far"):
        net.update(Delta((obj("o2", "far"),)))  # type: ignore[arg-type] # the point
    assert net.beliefs() == before
    assert told(net.update(Delta((obj("o2", 4),)))) == ([], [], [])


def test_a_test_is_not_asked_of_a_state_that_never_was() -> None:
    # Told one after the other, the rules see (in ...) of now with (level ...) of before.
    text = """
    (percepts (tank ^level ^kind))
    (concepts
      ((level ?t ?v) :elements ((tank ?t ^level ?v)))
      ((measured ?t) :elements ((tank ?t ^kind gauge)))
      ((low ?t) :elements ((measured ?t) (level ?t ?v)) :tests ((< ?v 5))))
    """
    net = network(text)
    net.update(Delta((Percept("tank", "t", {"level": "unknown", "kind": "none"}),)))
    changes = net.update(Delta((Percept("tank", "t", {"level": 3, "kind": "gauge"}),)))
    assert told(changes) == (["(level t 3)", "(low t)", "(measured t)"], ["(level t unknown)"], [])
    net.update(Delta((Percept("tank", "t", {"level": "unknown", "kind": "none"}),)))
    assert texts(net.beliefs()) == ["(level t unknown)"]
    with pytest.raises(InferenceError, match=r"\?v is the symbol unknown"):
        net.update(Delta((Percept("tank", "t", {"level": "unknown", "kind": "gauge"}),)))


def test_a_python_function_that_fails_is_named_with_its_clause() -> None:
    text = """
    (percepts (obj ^x))
    (concepts ((odd ?a) :elements ((obj ?a ^x ?x)) :tests ((fits ?x))))
    """

    def fits(x: float) -> bool:
        return 10 / x > 1

    net = network(text, fits=fits)
    net.update(Delta((obj("o1", 2),)))
    assert texts(net.beliefs()) == ["(odd o1)"]
    with pytest.raises(InferenceError, match=r"scene\.icr:3:.*\(fits 0\) failed: ZeroDivision"):
        net.move("obj", ["o1"], {"x": [0]})
    assert texts(net.beliefs()) == ["(odd o1)"]


def test_a_concept_may_be_asserted_as_well() -> None:
    net = network()
    net.update(Delta(row(2)))
    given = Belief("near", ("o0", "o9"))
    assert told(net.update(Delta(asserted=(given,))))[0] == ["(near o0 o9)", "(reaches o0 o9)",
                                                            "(reaches o1 o9)"]  # fmt: skip
    net.update(Delta(asserted=(Belief("near", ("o0", "o1")),)))
    changes = net.move("obj", ["o1"], {"x": [50]})
    assert net.holds(Belief("near", ("o0", "o1")))
    assert "(near o1 o0)" in told(changes)[1]
    net.update(Delta(withdrawn=(given, Belief("near", ("o0", "o1")))))
    assert not net.holds(Belief("near", ("o0", "o1")))


def test_what_is_given_decides_on_attributes_then_the_first_clause_then_the_least_values() -> None:
    text = """
    (percepts (a ^v) (b ^v))
    (concepts
      ((size ^v ?v) :elements ((a ?x ^v ?v)))
      ((size ^v ?v) :elements ((b ?x ^v ?v)))
      ((big) :elements ((size ^v ?v)) :tests ((> ?v 5))))
    """
    net = network(text)

    def see(*percepts: tuple[str, str, float], given: float | None = None) -> object:
        asserted = [] if given is None else [Belief("size", (), {"v": given})]
        net.update_snapshot([Percept(t, n, {"v": v}) for t, n, v in percepts], asserted)
        return next((belief.attributes["v"] for belief in net.facts("size")), None)

    assert see(("b", "b1", 1)) == 1
    assert see(("b", "b1", 1), ("a", "a1", 9)) == 9
    assert net.holds(Belief("big"))
    assert see(("b", "b1", 1), ("a", "a1", 9), ("a", "a2", 3)) == 3
    assert not net.holds(Belief("big"))
    assert see(("b", "b1", 1), ("a", "a1", 9), given=7) == 7
    assert see(("a", "a1", 9)) == 9
    assert see() is None


def test_the_generated_source_can_be_read_and_shows_in_tracebacks() -> None:
    domain, _ = parse_domain(TEXT, "scene.icr")
    assert domain is not None
    compiled = compile_domain(domain)
    assert "# scene.icr:7\n# ((free ?a)\n#  :elements ((obj ?a) (not (holding ?a)))" in (
        compiled.source
    )
    net = compiled.network(Budget(facts=3))
    with pytest.raises(InferenceError) as caught:
        net.update(Delta(row(5)))
    lines = [str(each.statement).strip() for each in caught.traceback]
    assert any("too_many" in line for line in lines)


def test_the_plans_say_how_each_clause_is_joined() -> None:
    domain, _ = parse_domain(TEXT, "scene.icr")
    assert domain is not None
    near, free, reaches, again, alone, apart = compile_domain(domain).plans
    assert near.steps[0].kernel is not None
    assert (near.place, near.clause.head.predicate) == ("scene.icr:4", "near")
    assert [(step.kind, step.access) for step in free.steps] == [
        ("find", "scan"),
        ("absent", "member"),
    ]
    assert again.keeping == reaches.keeping == "recursive"
    assert alone.keeping == "unique"
    assert {update.lead for update in alone.updates} == {"(obj ?a)", "not (near ?a ?_)"}
    assert apart.keeping == "attributed"


def test_words_that_mean_something_to_python_are_words_like_any_other() -> None:
    text = """
    (percepts (class ^len ^None))
    (concepts
      ((load ?class) :elements ((class ?class ^len ?len)))
      ((near-by ?key) :elements ((load ?key) (class ?key ^None ?row)) :tests ((< ?row 3)))
      ((near_by ?by) :elements ((near-by ?by) (not (show_load ?by))))
      ((near-by-1 ?by) :elements ((near_by ?by)))
      ((show_load ?near_by) :elements ((near-by ?near_by) (load ?near_by) (changes))))
    """
    net = network(text)
    net.update(Delta((Percept("class", "a", {"len": 1, "None": 2}),)))
    assert texts(net.beliefs()) == ["(load a)", "(near-by a)", "(near-by-1 a)", "(near_by a)"]
    net.update(Delta(asserted=(Belief("changes"), Belief("near-by", ("z",)))))
    assert texts(net.beliefs()) == [
        "(changes)", "(load a)", "(near-by a)", "(near-by z)", "(near-by-1 z)", "(near_by z)",
        "(show_load a)",
    ]  # fmt: skip
    (why,) = net.supports(Belief("show_load", ("a",)))
    assert texts(why.matched) == ["(near-by a)", "(load a)", "(changes)"]


def test_attributes_in_recursion_do_not_depend_on_history() -> None:
    text = """
    (percepts (link ^to))
    (concepts
      ((above ?a ?b ^height ?one) :elements ((link ?a ^to ?b)) :binds ((?one 1)))
      ((above ?a ?c ^height ?sum)
       :elements ((link ?a ^to ?b) (above ?b ?c ^height ?h)) :binds ((?sum (+ ?h 1))))
      ((far ?a ?c) :elements ((above ?a ?c ^height ?h)) :tests ((> ?h 2))))
    """
    chain = [("a", "b"), ("b", "c"), ("c", "d"), ("d", "e")]

    def see(net: Network, *links: tuple[str, str]) -> dict[str, object]:
        net.update_snapshot([Percept("link", a, {"to": b}) for a, b in links], [])
        return {str(b): b.attributes["height"] for b in net.facts("above")}

    net = network(text)
    assert see(net, *chain)["(above a e)"] == 4
    shorter = see(net, ("a", "c"), *chain[1:])
    assert shorter["(above a e)"] == 3
    assert shorter == see(network(text), ("a", "c"), *chain[1:])
    assert sorted(texts(net.facts("far"))) == ["(far a e)", "(far b e)"]
    circle = see(net, *chain[:3], ("d", "a"))
    assert circle == see(network(text), *chain[:3], ("d", "a"))
    assert circle["(above a a)"] == 4
    assert len(net.supports(Belief("above", ("a", "a")))) == 1
    assert see(net) == {}


@pytest.mark.parametrize("movers", [("c",), ("b", "c"), ("b", "c", "d", "e")])
def test_objects_of_two_types_with_one_name_are_the_same_object(movers: tuple[str, ...]) -> None:
    net = network("""
        (percepts (lamp ^x) (spot ^x))
        (concepts
          ((lit-by ?a ?b)
           :elements ((spot ?a ^x ?xa) (lamp ?b ^x ?xb))
           :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 2))))""")
    spots = [Percept("spot", name, {"x": 5}) for name in "bcde"]
    net.update(Delta((*spots, Percept("lamp", "c", {"x": 0}))))
    assert texts(net.beliefs()) == []
    net.move("spot", movers, {"x": [1] * len(movers)})
    assert texts(net.beliefs()) == [f"(lit-by {name} c)" for name in movers if name != "c"]
