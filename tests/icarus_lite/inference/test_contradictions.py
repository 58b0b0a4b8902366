"""What contradicts a belief long enough ends it: the moment, the count, the reason."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from icarus_lite import Agent
from icarus_lite.errors import InferenceError
from icarus_lite.inference import (
    Assertion,
    BeliefState,
    Doubt,
    InferenceEngine,
    Judgement,
    Memory,
    Withdrawal,
    carried_over,
    given_memory,
)
from icarus_lite.language import check_domain, has_errors, parse_atom, parse_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Belief, Percept

HEAD = """
(percepts (object ^x ^seen) (hand ^gripping))
(concepts
  ((apart ?a ?b) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb)) :tests ((> (- ?xb ?xa) 1)))
  ((fitted ?o) :elements ((attached ?o ?into) (object ?into)))
  ((loose ?o) :elements ((object ?o) (not (attached ?o ?_any)))))
(skills
  ((grasp ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o))
                 :effects ((holding ?h ?o) (grip ?h ^of ?o)))
  ((insert ?o ?into) :elements ((object ?o) (object ?into)) :actions ((*insert ?o ?into))))
(attachments ((insert ?o ?into) :child ?o :parent ?into))
"""
PLUG = Belief("attached", ("plug", "case"))
HELD = Belief("holding", ("h", "plug"))
INSERTED = Outcome(Action("insert", ("plug", "case")))
GRASPED = Outcome(Action("grasp", ("h", "plug")))


def domain(contradictions: str) -> Domain:
    read, problems = parse_domain(f"{HEAD}\n(contradictions {contradictions})", "d.icr")
    assert read is not None, problems
    assert not has_errors(check_domain(read))
    return read


def scene(plug: float = 0, case: float = 0, gripping: str = "yes", **more: float) -> list[Percept]:
    places = {"plug": plug, "case": case, **more}
    objects = [Percept("object", name, {"x": x, "seen": "yes"}) for name, x in places.items()]
    return [*objects, Percept("hand", "h", {"gripping": gripping})]


def run(
    rules: str, cycles: Sequence[tuple[list[Percept], Sequence[Outcome]]]
) -> tuple[InferenceEngine, list[Memory]]:
    engine, memories = InferenceEngine(domain(rules)), [Memory()]
    for percepts, outcomes in cycles:
        memories.append(engine.step(memories[-1], percepts, outcomes))
    return engine, memories[1:]


def states(
    rules: str, cycles: Sequence[tuple[list[Percept], Sequence[Outcome]]]
) -> list[BeliefState]:
    return [memory.state for memory in run(rules, cycles)[1]]


APART = "((attached ?o ?into) :elements ((apart ?o ?into)) :cycles 2)"


def test_what_is_withdrawn_goes_in_the_same_cycle_with_all_that_rests_on_it():
    first, second, third = states(
        APART, [(scene(), [INSERTED]), (scene(case=2), []), (scene(case=2), [])]
    )
    assert PLUG in first
    assert Belief("fitted", ("plug",)) in first
    assert PLUG in second
    assert second.doubts == (Doubt(0, PLUG, 1, 2),)
    assert str(second.doubts[0]) == "what contradicts it has held for 1 of 2 cycles"
    assert third.withdrawn == (Withdrawal(PLUG, ("(apart plug case)",), 2),)
    assert [str(belief) for belief in third.beliefs] == [
        "(apart plug case)",
        "(loose case)",
        "(loose plug)",
    ]
    assert list(third.hierarchy.pairs()) == []
    assert third.doubts == ()
    added, removed = third.since(second)
    assert list(map(str, added)) == ["(loose plug)"]
    assert list(map(str, removed)) == ["(attached plug case)", "(fitted plug)"]
    assert third.notes == (
        "(attached plug case) was withdrawn: (apart plug case) held for 2 cycles",
    )


def test_it_stays_withdrawn_until_an_action_asserts_it_again():
    found = states(
        APART,
        [
            (scene(), [INSERTED]),
            (scene(case=2), []),
            (scene(case=2), []),
            (scene(), []),
            (scene(), [INSERTED]),
        ],
    )
    assert [PLUG in each for each in found] == [True, True, False, False, True]


def test_a_single_cycle_without_it_sets_the_count_back():
    cycles = [(scene(), [INSERTED]), *((scene(case=x), ()) for x in (2, 0, 2, 0, 2, 2))]
    found = states(APART, cycles)
    assert [len(each.doubts) for each in found] == [0, 1, 0, 1, 0, 1, 0]
    assert [len(each.withdrawn) for each in found] == [0, 0, 0, 0, 0, 0, 1]


def test_a_new_success_lets_the_count_begin_again():
    far = scene(case=2)
    found = states(APART, [(far, [INSERTED]), (far, [INSERTED]), (far, [INSERTED]), (far, [])])
    assert [each.doubts[0].cycles for each in found[:3]] == [1, 1, 1]
    assert [each.belief for each in found[3].withdrawn] == [PLUG]


def test_a_failed_or_running_action_is_no_new_evidence():
    far = scene(case=2)
    again = [Outcome(INSERTED.action, status) for status in ("running", "failed")]
    (_, second) = states(APART, [(far, [INSERTED]), (far, again)])
    assert [each.belief for each in second.withdrawn] == [PLUG]


def test_with_one_cycle_what_is_contradicted_at_once_is_never_believed():
    rules = "((holding ?h ?o) :elements ((hand ?h ^gripping no)))"
    (state,) = states(rules, [(scene(gripping="no"), [GRASPED])])
    assert HELD not in state
    assert state.withdrawn == (Withdrawal(HELD, ("(hand h ^gripping no)",), 1),)
    assert state.withdrawn[0].reason == "(hand h ^gripping no) held"
    assert Belief("grip", ("h",)) in state


def test_the_conditions_may_hold_in_another_way_each_cycle():
    rules = "((holding ?h ?o) :elements ((hand ?h) (apart ?o ?other)) :cycles 2)"
    first, second = states(rules, [(scene(case=2, lid=0), [GRASPED]), (scene(case=0, lid=2), [])])
    assert first.doubts == (Doubt(0, HELD, 1, 2),)
    assert second.withdrawn[0].because == ("(hand h)", "(apart plug lid)")


def test_the_reason_told_is_the_way_with_the_least_values_whatever_the_order():
    rules = """((holding ?h ?o)
      :elements ((object ?other ^x ?x) (not (attached ?other ?_)) (object ?o ^x ?own))
      :tests ((> (- ?x ?own) 1)))"""
    percepts = scene(case=9, anvil=7, lid=7)
    for order in (percepts, percepts[::-1]):
        (state,) = states(rules, [(order, [GRASPED])])
        assert state.withdrawn[0].because == (
            "(object anvil ^x 7)",
            "(not (attached anvil ?_))",
            "(object plug ^x 0)",
            "(> (- 7 0) 1)",
        )


def test_contradictions_are_judged_all_at_once():
    rules = """((holding ?h ?o) :elements ((hand ?h ^gripping no)))
               ((attached ?o ?into) :elements ((not (holding ?_h ?o)) (object ?into)))"""
    closed, open_ = scene(), scene(gripping="no")
    found = states(rules, [(closed, [GRASPED, INSERTED]), (open_, []), (open_, [])])
    assert [each.belief for each in found[1].withdrawn] == [HELD]
    assert PLUG in found[1]
    assert [each.belief for each in found[2].withdrawn] == [PLUG]


def test_the_contradiction_that_is_written_first_gives_the_reason():
    rules = """((holding ?h ?o) :elements ((hand ?h ^gripping no)))
               ((holding ?h ?o) :elements ((object ?o ^x 0)))
               ((holding ?h ?o) :elements ((object ?o)) :cycles 9)"""
    (state,) = states(rules, [(scene(gripping="no"), [GRASPED])])
    assert [each.because for each in state.withdrawn] == [("(hand h ^gripping no)",)]
    assert state.doubts == ()  # what is gone is not in doubt


def test_a_head_matches_by_constants_repeats_and_attributes():
    rules = """((grip ?h ^of case) :elements ((hand ?h)))
               ((attached case ?into) :elements ((object ?into)))"""
    (state,) = states(
        rules,
        [(scene(), [GRASPED, INSERTED, Outcome(Action("insert", ("case", "box")))])],
    )
    assert Belief("grip", ("h",)) in state  # of the plug
    assert PLUG in state
    (other,) = states(rules, [(scene(), [Outcome(Action("grasp", ("h", "case")))])])
    assert [str(each.belief) for each in other.withdrawn] == ["(grip h)"]


def test_what_is_gone_with_its_object_is_no_longer_in_doubt():
    alone = [each for each in scene() if each.name != "plug"]
    found = states(APART, [(scene(case=2), [INSERTED]), (alone, []), (scene(case=2), [])])
    assert [len(each.doubts) for each in found] == [1, 0, 0]
    assert not any(each.withdrawn for each in found)


def test_what_was_given_from_the_start_can_be_withdrawn():
    read = domain("((holding ?h ?o) :elements ((hand ?h ^gripping no)) :cycles 2)")
    engine, memory = InferenceEngine(read), given_memory(read, [parse_atom("(holding h plug)")])
    for _ in range(2):
        assert HELD in memory.asserted
        memory = engine.step(memory, scene(gripping="no"))
    assert HELD not in memory.asserted
    assert [each.belief for each in memory.state.withdrawn] == [HELD]


def test_look_back_knows_the_beliefs_before_and_after():
    cycles = [(scene(), [INSERTED]), (scene(case=2), []), (scene(case=2), []), (scene(), [])]
    engine, memories = run(APART, cycles)
    for cycle, memory in enumerate(memories):
        then = engine.look_back(cycle)
        assert then.beliefs == memory.state.beliefs
        assert list(then.hierarchy.pairs()) == list(memory.state.hierarchy.pairs())


def test_another_engine_goes_on_from_the_same_memory():
    cycles = [(scene(), [INSERTED]), (scene(case=2), []), (scene(case=2), [])]
    _, memories = run(APART, cycles)
    fresh = InferenceEngine(domain(APART))
    state = fresh.step(memories[1], scene(case=2)).state
    assert state.withdrawn == memories[2].state.withdrawn
    assert state.beliefs == memories[2].state.beliefs


def test_a_recalled_cycle_is_not_judged_again_but_counted_on_from():
    cycles = [(scene(), [INSERTED]), (scene(case=2), [])]
    engine, (_, second) = run(APART, cycles)
    doubts = Judgement(second.state.doubts)
    hierarchy = second.state.hierarchy
    recalled = engine.recall(1, scene(case=2), {}, hierarchy, second.known, (), doubts)
    assert PLUG in recalled.state
    assert recalled.state.doubts == second.state.doubts
    assert [w.belief for w in engine.step(recalled, scene(case=2)).state.withdrawn] == [PLUG]
    forgotten = engine.recall(1, scene(case=2), {}, hierarchy, second.known)
    assert engine.step(forgotten, scene(case=2)).state.doubts == (Doubt(0, PLUG, 1, 2),)


def test_a_test_that_cannot_be_asked_leaves_everything_as_it_was():
    rules = "((holding ?h ?o) :elements ((hand ?h ^gripping ?g)) :tests ((< ?g 2)) :cycles 2)"
    engine = InferenceEngine(domain(rules))
    first = engine.step(Memory(), scene(gripping=1), [GRASPED])
    with pytest.raises(InferenceError, match=r"\?g is the symbol no, but `<` takes numbers"):
        engine.step(first, scene(plug=5, gripping="no"))
    second = engine.step(first, scene(gripping=1))
    assert [each.belief for each in second.state.withdrawn] == [HELD]
    assert engine.look_back(0).beliefs == first.state.beliefs
    added, removed = second.state.since(first.state)
    assert list(map(str, removed)) == ["(holding h plug)"]
    assert added == ()


def test_nothing_is_judged_where_nothing_persists():
    rules = "((holding ?h ?o) :elements ((hand ?h ^gripping ?g)) :tests ((< ?g 2)))"
    (state,) = states(rules, [(scene(gripping="no"), [])])  # the test could not be asked
    assert state.withdrawn == ()


def test_python_functions_may_be_called_in_its_tests():
    text = (
        f"{HEAD}(contradictions ((holding ?h ?o) :elements ((object ?o ^x ?x)) :tests ((odd ?x))))"
    )
    read, _ = parse_domain(text)
    assert read is not None
    engine = InferenceEngine(read, {"odd": lambda x: x % 2 == 1})
    assert HELD in engine.step(Memory(), scene(plug=2), [GRASPED]).state
    assert HELD not in engine.step(Memory(), scene(plug=3), [GRASPED]).state


def test_what_asserted_it_is_known_as_long_as_it_is_held():
    _, memories = run(APART, [(scene(), [INSERTED]), (scene(case=2), [])])
    (support, *_) = memories[1].state.supports[PLUG]
    assert support == Assertion(INSERTED.action, 0)


def test_an_edited_domain_goes_on_with_the_doubts_of_contradictions_that_it_still_has():
    held = "((holding ?h ?o) :elements ((hand ?h ^gripping no)) :cycles 3)"
    old = domain(f"{APART} {held}").contradictions
    doubts = (Doubt(0, PLUG, 1, 2), Doubt(1, HELD, 2, 3))
    new = domain(f"{held} ((holding ?h ?o) :elements ((object ?o ^x 3)))").contradictions
    assert carried_over(doubts, old, new) == (Doubt(0, HELD, 2, 3),)
    assert carried_over(doubts, old, old) == doubts
    assert carried_over((Doubt(1, HELD, 1, 3),), (*old, *old), old) == (Doubt(1, HELD, 1, 3),)
    assert carried_over(doubts, old, ()) == ()


def test_an_agent_whose_domain_is_edited_goes_on_counting():
    agent = Agent(domain(APART))
    agent.cycle(scene(), [INSERTED])
    agent.cycle(scene(case=2))
    agent.reload(domain(f"((holding ?h ?o) :elements ((hand ?h ^gripping no))) {APART}"))
    assert [each.belief for each in agent.cycle(scene(case=2)).withdrawn] == [PLUG]
