"""Tasks written as PDDL: the same plans, judged by both sides."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from icarus_lite.language import DomainError, load_domain, parse_domain
from icarus_lite.language.pddl import (
    Exported,
    RecursiveRuleError,
    export_task,
    import_sources,
    inlined,
    read_pddl_domain,
    read_pddl_problem,
    write_domain,
    write_problem,
)
from icarus_lite.language.syntax import Domain, Source
from icarus_lite.symbols import Action

_STATES = Path(__file__).parents[3] / "reference" / "planned_states.py"
_spec = importlib.util.spec_from_file_location("planned_states", _STATES)
states = sys.modules["planned_states"] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(states)

# A shipped domain, its task, the test whose state it begins with, and the length of its plan.
SHIPPED = [
    ("gearbox", "1.1", "task 1.1 takes two steps", 2),
    ("blocks", "sussman", "Sussman's anomaly takes six steps", 6),
    ("hanoi", "three-disks", "three disks take seven moves", 7),
    ("gripper", "carry-both", "two grippers carry two balls in one go", 5),
    ("cater", "find", "to uncover the snitch, the cones go one by one", 2),
]


def shipped(root: Path, name: str, test: str) -> Any:
    domain = load_domain(root / "domains" / f"{name}.icr")
    (found,) = [each for each in domain.tests if each.name == test]
    return states.state_of(domain, found.percepts, found.actions)


def exported(text: str, task: str = "t") -> tuple[Exported, Any, Domain]:
    domain, found = parse_domain(text)
    assert domain is not None, found
    (chosen,) = [each for each in domain.tasks if each.name == task]
    state = states.state_of(domain, chosen.init)
    return export_task(domain, task, chosen.goals, state), state, domain


@pytest.mark.parametrize(("name", "task", "test", "length"), SHIPPED)
def test_a_shortest_plan_of_the_export_is_one_of_ours(
    root: Path, naive_pddl: ModuleType, name: str, task: str, test: str, length: int
) -> None:
    state = shipped(root, name, test)
    domain = state.engine.domain
    goals = next(each.goals for each in domain.tasks if each.name == task)
    result = export_task(domain, task, goals, state)
    steps = naive_pddl.World(result.domain, result.problem).shortest()
    assert len(steps) == length == states.our_length(state, goals)
    assert states.reaches(state, [result.skill(*step) for step in steps], goals)


@pytest.mark.parametrize(("name", "task", "test", "length"), SHIPPED)
def test_there_and_back_the_plan_is_as_long(
    root: Path, name: str, task: str, test: str, length: int
) -> None:
    state = shipped(root, name, test)
    goals = next(each.goals for each in state.engine.domain.tasks if each.name == task)
    result = export_task(state.engine.domain, task, goals, state)
    texts = write_domain(result.domain), write_problem(result.problem)
    domain, found = read_pddl_domain(Source("domain.pddl", texts[0]))
    assert (domain, found) == (result.domain, ())
    assert read_pddl_problem(Source("", texts[1]), result.domain)[0] == result.problem
    back = import_sources(Source("domain.pddl", texts[0]), Source("problem.pddl", texts[1])).domain
    again = states.state_of(back, back.tasks[0].init)
    assert states.our_length(again, back.tasks[0].goals) == length


@pytest.mark.parametrize("name", ["gearbox", "blocks", "gripper", "cater"])
def test_definitions_can_be_put_in_where_nothing_is_recursive(
    root: Path, naive_pddl: ModuleType, name: str
) -> None:
    _, task, test, length = next(each for each in SHIPPED if each[0] == name)
    state = shipped(root, name, test)
    goals = next(each.goals for each in state.engine.domain.tasks if each.name == task)
    result = export_task(state.engine.domain, task, goals, state)
    domain, problem = inlined(result.domain, result.problem)
    assert domain.rules == ()
    steps = naive_pddl.World(domain, problem).shortest()
    assert len(steps) == length
    assert states.reaches(state, [result.skill(*step) for step in steps], goals)


def test_a_recursive_definition_cannot_be_put_in(root: Path) -> None:
    state = shipped(root, "hanoi", "three disks take seven moves")
    goals = state.engine.domain.tasks[0].goals
    result = export_task(state.engine.domain, "three-disks", goals, state)
    with pytest.raises(RecursiveRuleError, match="tower -> tower"):
        inlined(result.domain, result.problem)


def test_the_export_of_task_1_1_is_this(root: Path) -> None:
    state = shipped(root, "gearbox", "task 1.1 takes two steps")
    goals = state.engine.domain.tasks[0].goals
    result = export_task(state.engine.domain, "1.1", goals, state)
    text = write_domain(result.domain)
    assert "  (:types thing hand - object)\n" in text
    assert (
        "  (:derived (free ?hand - hand) (not (exists (?any - thing) (holding ?hand ?any))))\n"
        in text
    )
    assert (
        "    :parameters (?obj ?into - thing ?hand - hand)\n"
        "    :precondition (and (holding ?hand ?obj) (fits ?obj ?into))\n"
        "    :effect (and\n"
        "      (not (holding ?hand ?obj))\n"
        "      (forall (?any-parent - object) (not (attached ?obj ?any-parent)))\n"
        "      (attached ?obj ?into)))\n"
    ) in text
    assert write_problem(result.problem) == (
        "(define (problem gearbox-1-1)\n"
        "  (:domain gearbox)\n"
        "  (:objects hand1 - hand hubcover case - thing)\n"
        "  (:init (graspable hubcover) (fits hubcover case)"
        " (object-type-case case)\n"
        "    (in-reachable-pose-measured hand1 hubcover) (in-reachable-pose-measured hand1 case))\n"
        "  (:goal (attached hubcover case))\n"
        ")\n"
    )
    assert result.skill("insert", ["hubcover", "case", "hand1"]) == Action(
        "insert", ("hubcover", "case")
    )


SLIDERS = """
(percepts (tray ^width) (box :is tray ^lid))
(skills ((put ?x ?y) :elements ((tray ?x) (tray ?y)) :tests ((/= ?x ?y)) :actions ((*put ?x ?y)))
        ((lift ?x) :elements ((attached ?x ?_)) :actions ((*lift ?x))))
(attachments ((put ?x ?y) :until (lift ?x) :child ?x :parent ?y))
(task t :init ((box a ^width 2) (box b ^width 1) (tray c ^width 3) (attached b a))
        :goal ((attached a b) (attached b c)))
"""


def test_attachments_cannot_form_a_circle(naive_pddl: ModuleType) -> None:
    result, state, domain = exported(SLIDERS)
    assert "moves-with" in result.domain.derived
    steps = naive_pddl.World(result.domain, result.problem).shortest()
    assert len(steps) == 2
    assert [str(result.skill(*step)) for step in steps] == ["(put b c)", "(put a b)"]
    assert states.reaches(state, [result.skill(*step) for step in steps], domain.tasks[0].goals)


def test_a_new_parent_replaces_the_old_one(naive_pddl: ModuleType) -> None:
    result, _, _ = exported(SLIDERS)
    world = naive_pddl.World(result.domain, result.problem)
    put = next(action for action in result.domain.actions if action.name == "put")
    after = world.after(world.start, put, {"?x": "b", "?y": "c"})
    assert ("attached", "b", "c") in after
    assert ("attached", "b", "a") not in after


def test_subtypes_make_a_hierarchy_of_types() -> None:
    result, _, _ = exported(SLIDERS)
    assert [(t.name, t.type) for t in result.domain.types] == [("tray", "object"), ("box", "tray")]
    assert [(o.name, o.type) for o in result.problem.objects] == [
        ("a", "box"),
        ("b", "box"),
        ("c", "tray"),
    ]


MEASURED = """
(percepts (block ^size ^color) (spot))
(concepts ((bigger ?a ?b) :elements ((block ?a ^size ?sa) (block ?b ^size ?sb))
                          :tests ((> ?sa ?sb)))
          ((top ?b) :elements ((block ?b) (not (on ?any ?b))))
          ((twins ?a ?b) :elements ((block ?a ^color ?c) (block ?b ^color ?c) (on ?a ?b))))
(skills ((stack ?a ?b) :elements ((top ?a) (top ?b) (block ?a ^color red) (bigger ?b ?a)
                                  (not (block ?b ^color green)))
                       :tests ((/= ?a ?b))
                       :actions ((*stack ?a ?b)) :effects ((on ?a ?b)))
        ((paint ?a ?c) :elements ((block ?a) (block ?_other ^color ?c) (not (painted ?a ?any)))
                       :actions ((*paint ?a ?c)) :effects ((painted ?a ?c))))
(task t :init ((block a ^size 1 ^color red) (block b ^size 2 ^color red)
               (block c ^size 3 ^color green) (block d ^size 4 ^color "Dark Red"))
        :goal ((twins a b) (painted c "Dark Red")))
"""


def test_attributes_and_numbers_are_evaluated_at_the_start(naive_pddl: ModuleType) -> None:
    result, state, domain = exported(MEASURED)
    facts = {(f.predicate, *f.args) for f in result.problem.init}
    assert ("bigger", "c", "a") in facts
    assert ("bigger", "a", "c") not in facts
    assert ("block-color-red", "a") in facts
    assert ("block-color-green", "c") in facts
    assert ("twins-measured", "a", "b") in facts
    assert "top" in result.domain.derived
    steps = naive_pddl.World(result.domain, result.problem).shortest()
    actions = [result.skill(*step) for step in steps]
    assert set(actions) == {Action("stack", ("a", "b")), Action("paint", ("c", "Dark Red"))}
    assert states.reaches(state, actions, domain.tasks[0].goals)


def test_objects_get_legal_names_and_keep_their_values() -> None:
    result, _, _ = exported(MEASURED)
    assert result.objects["dark-red"] == "Dark Red"


NUMBERS = """
(percepts (cup ^size))
(skills ((fill ?c ?n) :elements ((cup ?c) (level ?c ?n) (next ?n ?m)) :tests ((< ?n 2.5))
                      :actions ((*fill ?c)) :effects ((level ?c ?m) (not (level ?c ?n)))))
(task t :init ((cup a) (level a 1) (next 1 2) (next 2 3) (next 3 4)) :goal ((level a 3)))
"""


def test_numbers_that_are_arguments_become_objects(naive_pddl: ModuleType) -> None:
    result, state, domain = exported(NUMBERS)
    steps = naive_pddl.World(result.domain, result.problem).shortest()
    actions = [result.skill(*step) for step in steps]
    assert actions == [Action("fill", ("a", 1)), Action("fill", ("a", 2))]
    assert states.reaches(state, actions, domain.tasks[0].goals)
    assert {o.name for o in result.problem.objects} == {"a", "n1", "n2", "n3"}


MIXED = """
(percepts (lamp ^at) (cat))
(concepts ((lit ?x) :elements ((lamp ?x ^at on)))
          ((both lamp1 ?y) :elements ((lit lamp1) (lit ?y)) :tests ((/= ?y lamp1))))
(skills ((switch ?x) :elements ((lamp ?x) (not (lit ?x))) :actions ((*switch ?x))
                     :effects ((lit ?x)))
        ((switch ?x) :elements ((lamp ?x) (lit ?x) (cat tom)) :actions ((*switch ?x))
                     :effects ((not (lit ?x)))))
(task t :init ((lamp lamp1 ^at off) (lamp lamp2 ^at on) (lamp lamp3 ^at off) (cat tom))
        :goal ((both ?x ?y) (not (lit lamp2)) (not (broken ?any))))
"""


def test_a_perceived_concept_that_effects_state_is_an_ordinary_predicate(
    naive_pddl: ModuleType,
) -> None:
    result, state, domain = exported(MIXED)
    assert result.domain.derived == {"both"}
    assert ("lit", "lamp2") in {(f.predicate, *f.args) for f in result.problem.init}
    assert [action.name for action in result.domain.actions] == ["switch", "switch-2"]
    steps = naive_pddl.World(result.domain, result.problem).shortest()
    actions = [result.skill(*step) for step in steps]
    assert len(actions) == 3
    assert {action.name for action in actions} == {"switch"}
    assert states.reaches(state, actions, domain.tasks[0].goals)


def test_what_the_domain_names_are_constants_and_what_the_goal_names_objects() -> None:
    result, _, _ = exported(MIXED)
    assert [constant.name for constant in result.domain.constants] == ["lamp1"]
    assert [each.name for each in result.problem.objects] == ["lamp2", "lamp3", "tom"]


def test_an_object_of_two_types_has_predicates_instead() -> None:
    result, _, _ = exported(
        "(percepts (a) (b) (c)) (skills ((go ?x) :elements ((a ?x) (b ?x)) :actions ((*go ?x))"
        " :effects ((gone ?x)))) (task t :init ((a x) (b x) (c y)) :goal ((gone x)))"
    )
    assert {(f.predicate, *f.args) for f in result.problem.init} == {("a", "x"), ("b", "x")}
    assert [(each.name, each.type) for each in result.problem.objects] == [
        ("y", "c"),
        ("x", "object"),
    ]


def test_names_that_mean_something_in_pddl_are_changed() -> None:
    result, _, _ = exported(
        "(percepts (object)) (skills ((and ?x) :elements ((object ?x) (not (when ?x)))"
        " :actions ((*do ?x)) :effects ((when ?x)))) (task t :init ((object Either)) :goal"
        " ((when Either)))"
    )
    assert [t.name for t in result.domain.types] == ["thing"]
    assert [p.name for p in result.domain.predicates] == ["when-2"]
    assert [a.name for a in result.domain.actions] == ["and-2"]
    assert [o.name for o in result.problem.objects] == ["either-2"]
    assert result.skill("and-2", ["either-2"]) == Action("and", ("Either",))


def test_a_goal_out_of_reach_is_written_with_a_note(naive_pddl: ModuleType) -> None:
    result, _, _ = exported(
        "(percepts (o)) (skills ((go ?x) :elements ((o ?x)) :actions ((*go ?x))"
        " :effects ((gone ?x)))) (task t :init ((o x)) :goal ((gone y)))"
    )
    assert [note.code for note in result.notes] == ["PDDL017"]
    assert naive_pddl.World(result.domain, result.problem).shortest() is None


def test_an_unbound_argument_leaves_the_skill_out_with_a_note() -> None:
    result, _, _ = exported(
        "(percepts (o)) (skills ((go ?x) :actions ((*go ?x)) :effects ((gone ?x)))"
        "((go ?x) :elements ((o ?x)) :actions ((*go ?x)) :effects ((gone ?x))))"
        "(task t :init ((o x)) :goal ((gone x)))"
    )
    assert [(n.code, n.message) for n in result.notes] == [
        ("PDDL017", "`(go ?x)` is left out: only a caller can give ?x a value")
    ]
    assert [action.name for action in result.domain.actions] == ["go"]


GO = "((go ?x) :elements ((o ?x)) :actions ((*go ?x)) :effects ((gone ?x)))"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "((go ?x) :elements ((o ?x)) :actions ((*go ?x)) :effects ((gone ?x ^at 3)))",
            "the effect (gone ?x ^at 3) sets an attribute, which PDDL cannot say",
        ),
        (
            f"{GO} ((no ?x) :elements ((gone ?x ^at ?a)) :actions ((*go ?x ?a)))",
            "asks for an attribute of what skills change",
        ),
        (
            f"{GO} ((tie ?x ?y) :elements ((o ?x) (o ?y)) :actions ((*tie ?x)))",
            "fits `(tie ?x ?y)` only for some of its arguments",
        ),
    ],
)
def test_what_pddl_cannot_say_is_refused(text: str, message: str) -> None:
    domain = (
        f"(percepts (o)) (skills {text})"
        "(attachments ((tie ?a ?a) :child ?a :parent base))"
        "(task t :init ((o x) (gone x ^at 2)) :goal ((gone x)))"
    )
    with pytest.raises(DomainError) as caught:
        exported(domain)
    assert any(message in found.message for found in caught.value.diagnostics)


def test_a_plain_export_needs_nothing_beyond_typed_strips() -> None:
    result, _, _ = exported(NUMBERS)
    assert "(:requirements :strips :typing)" in write_domain(result.domain)


def test_contradictions_are_left_out_with_a_remark() -> None:
    text = """
    (percepts (object ^x))
    (concepts ((apart ?a ?b) :elements ((object ?a ^x 1) (object ?b ^x 2))))
    (skills ((put ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*put ?a ?b))
                         :effects ((on ?a ?b))))
    {}
    (task t :init ((object a ^x 1) (object b ^x 1)) :goal ((on a b)))"""
    rule = "(contradictions ((on ?a ?b) :elements ((apart ?a ?b)) :cycles 3))"
    remark = "Contradictions are left out: no plan counts on a surprise."
    (with_it, _, _), (without, _, _) = exported(text.format(rule)), exported(text.format(""))
    assert remark in with_it.remarks
    assert remark not in without.remarks
    assert (with_it.domain.actions, with_it.domain.rules) == (
        without.domain.actions,
        without.domain.rules,
    )
