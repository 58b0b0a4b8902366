from __future__ import annotations

from icarus_lite import Belief
from icarus_lite.execution.experience import MAX_ATTEMPTS, MAX_BEGUN, Experience
from icarus_lite.execution.path import Level
from icarus_lite.execution.repertoire import Repertoire, passed_back, passed_down
from icarus_lite.inference import FactStore
from icarus_lite.language import parse_atom, parse_domain
from icarus_lite.symbols import Action

DOMAIN, PROBLEMS = parse_domain("""
(percepts (robot ^x) (door ^x) (room))
(concepts ((at ?r ?d) :elements ((robot ?r ^x ?x) (door ?d ^x ?y)) :tests ((= ?x ?y))))
(skills
  ((go ?r ?d) :elements ((robot ?r ^x ?from) (door ?d ^x ?to)) :actions ((*go ?r ?to))
              :effects ((at ?r ?d)))
  ((go ?r home) :elements ((robot ?r)) :actions ((*return ?r)) :effects ((home ?r)))
  ((wave ?r) :elements ((robot ?r)) :actions ((*wave ?r)))
  ((greet ?r) :subskills ((greet ?r) (go ?r home))))
""")
assert DOMAIN is not None, PROBLEMS
REPERTOIRE = Repertoire(DOMAIN)
GO, GO_HOME, WAVE, GREET = REPERTOIRE.skills
FACTS = FactStore(
    [
        Belief("robot", ("r1",), {"x": 1.0}),
        Belief("door", ("d1",), {"x": 1.0}),
        Belief("door", ("d2",), {"x": 4.0}),
        Belief("at", ("r1", "d1")),
    ]
)


def test_a_call_binds_the_head_as_far_as_the_caller_knows() -> None:
    call = parse_atom("(go ?me d2)")
    assert passed_down(call, {"?me": "r1"}, GO.clause.head) == {"?r": "r1", "?d": "d2"}
    assert passed_down(call, {}, GO.clause.head) == {"?d": "d2"}
    assert passed_down(call, {}, GO_HOME.clause.head) is None
    assert passed_down(parse_atom("(go ?me home)"), {}, GO_HOME.clause.head) == {}


def test_a_skill_passes_back_what_it_has_bound() -> None:
    call = parse_atom("(go ?me ?where)")
    own = {"?r": "r1", "?d": "d2", "?to": 4.0}
    assert passed_back(call, {}, GO.clause.head, own) == {"?me": "r1", "?where": "d2"}
    assert passed_back(call, {"?where": "d1"}, GO.clause.head, own) is None
    assert passed_back(call, {"?me": "r1"}, GO_HOME.clause.head, {}) == {
        "?me": "r1",
        "?where": "home",
    }


def test_a_skill_is_known_by_its_name_and_number_of_arguments() -> None:
    assert REPERTOIRE.named(parse_atom("(go r1 d1)")) == (GO, GO_HOME)
    assert REPERTOIRE.named(parse_atom("(go r1)")) == ()
    assert REPERTOIRE.of(DOMAIN.skills[2]) is WAVE


def test_bound_anew_an_instance_keeps_its_objects_and_reads_its_measures_again() -> None:
    old = {"?r": "r1", "?d": "d2", "?from": 0.0, "?to": 3.9}
    assert GO.again(FACTS, old) == {"?r": "r1", "?d": "d2", "?from": 1.0, "?to": 4.0}
    gone = {**old, "?d": "d3"}
    assert GO.again(FACTS, gone) is None
    assert str(GO.obstacle(FACTS, gone)) == "nothing matches (door d3 ^x ?to)"
    assert GO.obstacle(FACTS, old) is None


def test_when_a_call_is_met() -> None:
    assert REPERTOIRE.is_met(parse_atom("(go r1 d1)"), FACTS)
    assert not REPERTOIRE.is_met(parse_atom("(go r1 d2)"), FACTS)
    assert not REPERTOIRE.is_met(parse_atom("(wave r1)"), FACTS), "it has no effects"
    assert not REPERTOIRE.is_met(parse_atom("(greet r1)"), FACTS), "it calls itself"
    ways = REPERTOIRE.ways_met(parse_atom("(go ?me ?where)"), {}, FACTS)
    assert list(ways) == [{"?me": "r1", "?where": "d1"}]


def test_what_an_intended_skill_is_for_as_goals() -> None:
    assert [str(aim) for aim in REPERTOIRE.aims_of(parse_atom("(go ?me d2)"))] == ["(at ?r d2)"]
    assert [str(aim) for aim in REPERTOIRE.aims_of(parse_atom("(go r1 home)"))] == ["(at r1 home)"]
    assert REPERTOIRE.aims_of(parse_atom("(wave r1)")) == ()


def test_an_action_is_given_up_after_three_failures_in_a_row() -> None:
    experience, go, wave = Experience(), Action("go", ("r1", "d1")), Action("wave", ("r1",))
    for attempt in range(1, MAX_ATTEMPTS + 1):
        assert experience.given_up == {}
        experience.note_failure(go, f"attempt {attempt}")
    experience.note_failure(wave, "once")
    assert experience.given_up == {go: "attempt 3"}
    experience.note_success(go)
    assert experience.given_up == {}


def test_beginning_the_same_in_the_same_state_is_going_in_a_circle() -> None:
    experience, level = Experience(), Level(WAVE.clause, (("?r", "r1"),))
    for cycle in range(3):
        assert experience.circle(level, "here") == ""
        experience.note_begun([level], "here", cycle)
    assert experience.circle(level, "here") == "it was begun in this same state in cycles 0, 1, 2"
    assert experience.circle(level, "there") == ""
    assert experience.circle(Level(WAVE.clause, (("?r", "r2"),)), "here") == ""
    for cycle in range(3, MAX_BEGUN):
        experience.note_begun([level], cycle, cycle)
    assert experience.circle(level, "there") == f"it was begun {MAX_BEGUN} times already"
    experience.forget_beginnings()
    assert experience.circle(level, "here") == ""
