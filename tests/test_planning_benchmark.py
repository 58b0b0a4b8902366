"""What the planning benchmark rests on: its judge of plans, its own problems, its skills."""

from __future__ import annotations

import random

import pytest
from planners.generated import BLOCKS, GEARBOX, blocks_problem, gearbox_problem, written
from planners.instances import NUMBERS, instances
from planners.planned import actions, imported
from planners.towers import by_skills
from planners.validation import flaw

from icarus_lite.planning.search import Limits, improve, search

DOMAIN = """\
(define (domain d)  ; trucks
  (:types truck place - object van - truck)
  (:constants home - place)
  (:predicates (at ?t - truck ?p - place) (road ?a ?b - place))
  (:action Drive
    :parameters (?t - truck ?a ?b - place)
    :precondition (and (at ?t ?a) (road ?a ?b) (not (= ?a ?b)))
    :effect (and (not (at ?t ?a)) (at ?t ?b))))
"""
PROBLEM = """\
(define (problem p) (:domain d) (:objects v - van far - place)
  (:init (at v home) (road home far) (road home home) (road far home))
  (:goal (and (at v far) (not (at v home)))))
"""
DRIVE = ("drive", "v", "home", "far")


@pytest.mark.parametrize(
    ("plan", "wrong"),
    [
        ([DRIVE], ""),
        ([DRIVE, ("drive", "v", "far", "home"), DRIVE], ""),
        ([], "in the end ('at', 'v', 'far') does not hold"),
        ([DRIVE, ("drive", "v", "far", "home")], "in the end ('at', 'v', 'far') does not hold"),
        ([DRIVE, DRIVE], "step 2, (drive v home far): ('at', 'v', 'home') does not hold"),
        ([("drive", "v", "home", "home")], "not ('=', 'home', 'home') does not hold"),
        ([("drive", "far", "home", "far")], "far is no truck"),
        ([("drive", "v", "home")], "takes 3 arguments"),
        ([("fly", "v", "home", "far")], "no such action"),
    ],
)
def test_the_judge_says_what_is_wrong_with_a_plan(tmp_path, plan, wrong):
    files = written(tmp_path, DOMAIN, PROBLEM)
    found = flaw(*files, plan)
    assert found.endswith(wrong)
    assert bool(found) == bool(wrong)


def test_the_judge_guesses_nothing(tmp_path):
    files = written(tmp_path, DOMAIN, PROBLEM.replace("(and (at v far)", "(or (at v far)"))
    with pytest.raises(ValueError, match="more than a literal"):
        flaw(*files, [DRIVE])


def test_there_are_sixty_problems_and_a_missing_checkout_is_told(tmp_path):
    assert sum(map(len, NUMBERS.values())) == 60
    with pytest.raises(SystemExit, match=r"task05.pddl is not there: name a checkout"):
        instances(tmp_path, ["blocks"])


@pytest.mark.parametrize("seed", range(15))
def test_towers_are_planned_for_and_carried_out_by_skills(tmp_path, seed):
    problem = blocks_problem(random.Random(seed), 3 + seed % 8)
    files = written(tmp_path, BLOCKS, problem)
    task = imported(*files).ground()
    plan = search(task, Limits(evaluations=20_000)).plan
    assert plan is not None
    assert not flaw(*files, actions(task, plan))
    shorter = improve(task, plan, Limits(evaluations=300))
    assert len(shorter) <= len(plan)
    assert not flaw(*files, actions(task, shorter))
    assert not flaw(*files, by_skills(files[1]))


def test_skills_do_not_move_a_block_that_can_stay(tmp_path):
    problem = (
        "(define (problem p) (:domain blocks) (:objects a b c d)"
        " (:init (handempty) (on b a) (ontable a) (clear b) (on d c) (ontable c) (clear d))"
        " (:goal (and (on b a) (on a c))))"
    )
    files = written(tmp_path, BLOCKS, problem)
    done = by_skills(files[1])
    assert not flaw(*files, done)
    assert len(done) == 8
    assert sum(action[0] == "unstack" for action in done) == 2


def test_a_gearbox_is_put_together_in_twenty_seven_steps(tmp_path):
    files = written(tmp_path, GEARBOX, gearbox_problem(12))
    task = imported(*files).ground()
    plan = search(task).plan
    assert plan is not None
    assert len(plan) == 27
    assert not flaw(*files, actions(task, plan))
