"""Classical problems, read from PDDL: the domain that comes out, and the plans it leads to."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import pytest

from icarus_lite.inference import InferenceEngine, given_memory, given_percepts
from icarus_lite.language import DomainError, Severity, check_domain, diagnose_text, parse_domain
from icarus_lite.language.formatting.formatter import format_text
from icarus_lite.language.pddl import (
    import_files,
    import_sources,
    read_pddl_domain,
    read_pddl_problem,
)
from icarus_lite.language.syntax import Domain, Source
from icarus_lite.planning import Imagination, NoPlan, Plan, find_plan

BENCHMARKS = [
    ("blocks", "blocks-sussman", 6),
    ("gripper", "gripper-3", 9),
    ("parcels", "parcels-1", 7),
    ("lift", "lift-2", 6),
    ("shelves", "shelves-3", 3),
]
HEAD = (
    "(define (domain d) (:types block room) (:predicates (on ?a ?b - block) (lit ?r - room) (go))"
)


def planned(domain: Domain) -> Plan | NoPlan:
    """Plan for the one task of a domain from what the task gives."""
    (task,) = domain.tasks
    engine = InferenceEngine(domain)
    memory = engine.step(given_memory(domain, task.init), given_percepts(domain, task.init))
    imagination = Imagination(domain, memory, engine.closure, engine.evaluator)
    return find_plan(domain, imagination, task.goals)


def imported(sections: str, problem: str = "(:init) (:goal (go))") -> Domain:
    """Import a domain with these sections, and a problem with an object or two."""
    text = f"(define (problem p) (:domain d) (:objects a b - block r - room) {problem})"
    return import_sources(Source("d.pddl", f"{HEAD} {sections})"), Source("p.pddl", text)).domain


def refusal(sections: str, problem: str = "(:init) (:goal (go))") -> str:
    with pytest.raises(DomainError) as caught:
        imported(sections, problem)
    (found,) = [d for d in caught.value.diagnostics if d.severity is Severity.ERROR]
    return f"{found.code} {found.message}"


@pytest.mark.parametrize(("domain", "problem", "length"), BENCHMARKS)
def test_a_benchmark_is_planned_for_as_shortly_as_can_be(
    problems: Path, naive_pddl: ModuleType, domain: str, problem: str, length: int
) -> None:
    result = import_files(problems / f"{domain}.pddl", problems / f"{problem}.pddl")
    plan = planned(result.domain)
    assert isinstance(plan, Plan)
    assert len(plan.steps) == length
    read, _ = read_pddl_domain(Source("", (problems / f"{domain}.pddl").read_text()))
    assert read is not None
    task, _ = read_pddl_problem(Source("", (problems / f"{problem}.pddl").read_text()), read)
    world = naive_pddl.World(read, task)
    steps = [(step.action.name, tuple(map(str, step.action.args))) for step in plan.steps]
    assert world.is_valid(steps)
    assert len(world.shortest()) == length


@pytest.mark.parametrize(("domain", "problem", "length"), BENCHMARKS)
def test_the_text_that_is_written_is_the_domain_and_has_no_errors(
    problems: Path, domain: str, problem: str, length: int
) -> None:
    result = import_files(problems / f"{domain}.pddl", problems / f"{problem}.pddl")
    read, remarks = parse_domain(result.text)
    assert read == result.domain
    assert format_text(result.text) == result.text
    assert not remarks
    assert length
    _, _, found = diagnose_text(result.text, f"{domain}.icr")
    assert not [each for each in found if each.severity is Severity.ERROR]


@pytest.mark.parametrize("name", ["blocks", "gripper", "parcels", "lift"])
def test_the_checker_has_nothing_to_say_about_a_plain_import(problems: Path, name: str) -> None:
    files = {b[0]: b[1] for b in BENCHMARKS}
    result = import_files(problems / f"{name}.pddl", problems / f"{files[name]}.pddl")
    assert check_domain(result.domain) == ()


def test_types_become_percept_types_and_the_task_gives_the_rest(problems: Path) -> None:
    domain = import_files(problems / "parcels.pddl", problems / "parcels-1.pddl").domain
    assert [(p.name, p.supertype) for p in domain.percepts][:3] == [
        ("vehicle", None),
        ("parcel", None),
        ("van", "vehicle"),
    ]
    (task,) = domain.tasks
    assert task.name == "problem"
    assert "(van red)" in map(str, task.init)
    assert "(at letter d1)" in map(str, task.init)


def test_costs_are_left_out_with_a_note_for_each_file(problems: Path) -> None:
    result = import_files(problems / "parcels.pddl", problems / "parcels-1.pddl")
    assert [note.code for note, _ in result.remarks] == ["PDDL013", "PDDL013"]
    assert "number of steps" in result.remarks[0][0].message


def test_a_type_is_asked_for_only_where_nothing_implies_it() -> None:
    (skill,) = imported(
        "(:action a :parameters (?x ?y - block ?r - room) :precondition (on ?x ?y) :effect (go))"
    ).skills
    assert [str(c) for c in skill.elements] == ["(on ?x ?y)", "(room ?r)"]


def test_alternatives_become_clauses() -> None:
    skills = imported(
        "(:action a :parameters (?x - block ?r - room)"
        " :precondition (and (lit ?r) (or (on ?x ?x) (not (or (on ?x a) (go))))) :effect (go)"
        ") (:constants a - block)",
        "(:init) (:goal (go))",
    ).skills
    assert [[str(c) for c in skill.elements] for skill in skills] == [
        ["(lit ?r)", "(on ?x ?x)"],
        ["(lit ?r)", "(block ?x)", "(not (on ?x a))", "(not (go))"],
    ]
    assert {skill.head.predicate for skill in skills} == {"a"}


def test_not_exists_reads_as_not_with_a_local_variable() -> None:
    (skill,) = imported(
        "(:action a :parameters (?x - block)"
        " :precondition (not (exists (?z - block) (on ?z ?x))) :effect (go))"
    ).skills
    assert [str(c) for c in skill.elements] == ["(block ?x)", "(not (on ?any-z ?x))"]


def test_exists_gives_a_variable_of_the_clause_alone() -> None:
    (skill,) = imported(
        "(:action a :parameters (?x - block)"
        " :precondition (and (exists (?z - block) (and (on ?z ?x) (on ?x ?z)))"
        " (exists (?z - block) (on ?x ?z))) :effect (go))"
    ).skills
    assert [str(c) for c in skill.elements] == ["(on ?z ?x)", "(on ?x ?z)", "(on ?x ?any-z-2)"]


def test_removing_whatever_matches_is_an_effect_with_a_free_variable() -> None:
    (skill,) = imported(
        "(:action a :parameters (?x - block)"
        " :precondition (go) :effect (forall (?z - block) (not (on ?x ?z))))"
    ).skills
    assert [str(c) for c in skill.effects] == ["(not (on ?x ?any-z))"]


def test_a_goal_that_is_no_conjunction_becomes_a_concept() -> None:
    domain = imported(
        "(:action a :parameters (?x ?y - block) :effect (on ?x ?y))",
        "(:init) (:goal (or (on a b) (exists (?x - block) (and (on ?x ?x) (not (= ?x b))))))",
    )
    assert [str(goal) for goal in domain.tasks[0].goals] == ["(goal-reached)"]
    assert len(domain.concepts) == 2
    plan = planned(domain)
    assert isinstance(plan, Plan)
    assert len(plan.steps) == 1


def test_an_empty_goal_holds_from_the_start() -> None:
    plan = planned(imported("(:action a :effect (go))", "(:init) (:goal (and))"))
    assert isinstance(plan, Plan)
    assert plan.steps == ()


def test_what_can_never_be_true_is_no_unknown_predicate() -> None:
    domain = imported("(:action a :precondition (lit r) :effect (go)) (:constants r - room)")
    assert not [d for d in check_domain(domain) if d.severity is Severity.ERROR]
    assert isinstance(planned(domain), NoPlan)


def test_attached_gets_another_name_for_ours_has_one_parent_for_each_child() -> None:
    source = Source(
        "d.pddl",
        "(define (domain d) (:predicates (attached ?a ?b))"
        "(:action tie :parameters (?a ?b) :effect (attached ?a ?b)))",
    )
    problem = Source(
        "p.pddl",
        "(define (problem p) (:domain d) (:objects a b c)"
        "(:init) (:goal (and (attached a b) (attached a c) (attached b a))))",
    )
    result = import_sources(source, problem)
    assert [note.code for note, _ in result.remarks] == ["PDDL016"]
    plan = planned(result.domain)
    assert isinstance(plan, Plan)
    assert len(plan.steps) == 3


def test_a_type_and_a_predicate_of_one_name_are_kept_apart() -> None:
    source = Source(
        "d.pddl",
        "(define (domain d) (:types ball) (:predicates (ball ?b) (seen ?b - ball))"
        "(:action look :parameters (?b - ball) :precondition (ball ?b) :effect (seen ?b)))",
    )
    problem = Source(
        "p.pddl",
        "(define (problem p) (:domain d) (:objects x y - ball)(:init (ball x)) (:goal (seen x)))",
    )
    domain = import_sources(source, problem).domain
    assert [p.name for p in domain.percepts] == ["ball-2"]
    plan = planned(domain)
    assert isinstance(plan, Plan)
    assert [str(step.action) for step in plan.steps] == ["(look x)"]


@pytest.mark.parametrize(
    ("precondition", "message"),
    [
        (
            "(not (exists (?z - block) (and (on ?z ?x) (go))))",
            "PDDL007 `not exists` over more than one predicate has no counterpart here",
        ),
        (
            "(forall (?z - block) (on ?z ?x))",
            "PDDL007 `forall` is a condition over all objects, which has no counterpart here",
        ),
    ],
)
def test_quantifiers_that_clauses_cannot_say_are_refused(precondition: str, message: str) -> None:
    action = f"(:action a :parameters (?x - block) :precondition {precondition} :effect (go))"
    assert refusal(action) == message


def test_not_over_a_narrower_type_is_refused() -> None:
    source = Source(
        "d.pddl",
        "(define (domain d) (:types small - thing) (:predicates (on ?a ?b - thing) (go))"
        "(:action a :parameters (?x - thing)"
        " :precondition (not (exists (?z - small) (on ?z ?x))) :effect (go)))",
    )
    problem = Source("p.pddl", "(define (problem p) (:domain d) (:objects) (:init) (:goal (go)))")
    with pytest.raises(DomainError, match="whatever matches, not only a small"):
        import_sources(source, problem)


def test_too_many_alternatives_are_refused() -> None:
    parts = " ".join(f"(or (go) (lit r{i}))" for i in range(7))
    constants = " ".join(f"r{i}" for i in range(7))
    message = refusal(
        f"(:constants {constants} - room) (:action a :precondition (and {parts}) :effect (go))"
    )
    assert message == "PDDL014 this condition has more than 64 alternatives"


def test_derived_predicates_that_negate_one_another_are_refused() -> None:
    source = Source(
        "d.pddl",
        "(define (domain d) (:predicates (p) (q) (r)) (:derived (p) (not (q)))"
        "(:derived (q) (not (p))) (:action a :effect (r)))",
    )
    problem = Source("p.pddl", "(define (problem p) (:domain d) (:init) (:goal (p)))")
    with pytest.raises(DomainError, match=r"PDDL012.*p -> not q -> p"):
        import_sources(source, problem)
