"""The rows of each step: counted as the plan joins them, and true to what is believed."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.inference import FactStore, InferenceEngine, Matcher, Memory
from icarus_lite.inference.network import compile_domain
from icarus_lite.inference.profiling import DomainProfiler, Profiler, rule_plans
from icarus_lite.language import parse_domain
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Belief, Percept

TEXT = """(percepts (object ^type ^x ^y) (hand))
(concepts
  ((near ?a ?b) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
                :tests ((/= ?a ?b) (< (abs (- ?xa ?xb)) 2)))
  ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((chain ?a ?b) :elements ((near ?a ?b)))
  ((chain ?a ?c) :elements ((near ?a ?b) (chain ?b ?c)))
  ((wanted ?a ?b) :elements ((near ?a ?b) (object ?b ^type plug ^y ?y) (not (holding ?_h ?b)))
                  :tests ((> ?y 3) (/= ?a ?b)))
  ((always)))
(skills ((pick-up ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o))
                         :effects ((holding ?h ?o))))
"""
DOMAIN, PROBLEMS = parse_domain(TEXT, "cell.icr")
assert DOMAIN is not None, PROBLEMS
COMPILED = compile_domain(DOMAIN)
HAND = Percept("hand", "h")


def thing(name: str, x: int, y: int = 5, kind: str = "plug") -> Percept:
    return Percept("object", name, {"type": kind, "x": x, "y": y})


SCENE = (HAND, thing("a", 0), thing("b", 1), thing("c", 9), thing("d", 2, 1))


def test_rows_in_and_out_of_each_step() -> None:
    profiler = DomainProfiler(COMPILED)
    profiler.cycle(SCENE)
    profile = profiler.result()
    by_head = {str(each.plan.clause.head): each for each in profile.clauses}
    (pairs,) = by_head["(near ?a ?b)"].steps
    assert (pairs.rows_in, pairs.rows_out) == (1, 4)
    free = by_head["(free ?h)"]
    assert [(each.rows_in, each.rows_out) for each in free.steps] == [(1, 1), (1, 1)]
    assert by_head["(wanted ?a ?b)"].rows == 3  # a-b, b-a, d-b: d itself is too low
    assert by_head["(always)"].rows == 1


def test_cycles_add_up() -> None:
    profiler = DomainProfiler(COMPILED)
    profiler.cycle(SCENE)
    profiler.cycle(SCENE, [Outcome(Action("pick-up", ("h", "a")))])
    profile = profiler.result()
    free = profile.clauses[1]
    assert (profile.cycles, free.cycles) == (2, 2)
    assert [(each.rows_in, each.rows_out) for each in free.steps] == [(2, 2), (2, 1)]


def test_the_slowest_clause_is_the_one_with_the_most_work() -> None:
    text = """(percepts (o ^x ^y))
    (concepts ((cheap ?a) :elements ((o ?a ^x 1)))
              ((dear ?a ?b ?c) :elements ((o ?a ^x ?x) (o ?b ^y ?y) (o ?c ^x ?z))
                               :tests ((= ?x ?z) (= ?y ?z))))"""
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    profiler = DomainProfiler(compile_domain(domain))
    profiler.cycle([Percept("o", f"o{n}", {"x": n, "y": n}) for n in range(40)])
    profile = profiler.result()
    assert profile.slowest is not None
    assert profile.slowest.plan.clause.head.predicate == "dear"
    assert profile.slowest.seconds > 0
    widest = profile.slowest.widest
    assert widest is not None
    assert widest.rows_out > profile.slowest.rows == 40


def test_too_many_rows_are_left_out_and_it_is_said() -> None:
    plans = rule_plans(COMPILED)
    profiler = Profiler(plans, most_rows=3)
    engine = InferenceEngine(DOMAIN)
    profiler.observe(engine.step(Memory(), SCENE).state.facts())
    near = profiler.profiles()[0].steps[0]
    assert (near.rows_out, near.cut) == (3, True)
    assert not profiler.profiles()[1].steps[0].cut


def test_nothing_observed_is_nothing_to_tell() -> None:
    profile = DomainProfiler(COMPILED).result()
    assert (profile.cycles, profile.slowest) == (0, None)


@settings(max_examples=30, deadline=None)
@given(
    objects=st.lists(
        st.tuples(st.integers(0, 6), st.integers(0, 6), st.sampled_from(["plug", "case"])),
        max_size=6,
    ),
    holds=st.booleans(),
)
def test_as_many_rows_come_through_as_there_are_derivations(
    objects: list[tuple[int, int, str]], *, holds: bool
) -> None:
    percepts = [thing(f"o{n}", *each) for n, each in enumerate(objects)]
    held = [Outcome(Action("pick-up", ("h", "o0")))] if holds and objects else []
    engine = InferenceEngine(DOMAIN)
    state = engine.step(Memory(), [HAND, *percepts], held).state
    profiler = Profiler(rule_plans(COMPILED))
    profiler.observe(state.facts())
    for profile in profiler.profiles():
        clause = profile.plan.clause
        matches = list(Matcher(clause.elements, clause.tests).matches(state.facts()))
        assert profile.rows == len(matches)
        for before, after in zip(profile.steps, profile.steps[1:], strict=False):
            assert after.rows_in == before.rows_out


def test_a_test_without_a_value_lets_nothing_through() -> None:
    plans = rule_plans(COMPILED)
    profiler = Profiler(plans[:1])
    facts = [Belief("object", (n,), {"x": v}) for n, v in (("a", 1), ("b", "left"), ("c", 1))]
    profiler.observe(FactStore(facts))
    assert profiler.profiles()[0].rows == 2
