"""Problems made up here: random towers, and a gearbox to be put together."""

from __future__ import annotations

import random
from itertools import pairwise
from pathlib import Path

from icarus_lite import Percept

BLOCKS = """\
(define (domain blocks)
  (:requirements :strips)
  (:predicates (on ?x ?y) (ontable ?x) (clear ?x) (handempty) (holding ?x))
  (:action pick-up
    :parameters (?x)
    :precondition (and (clear ?x) (ontable ?x) (handempty))
    :effect (and (not (ontable ?x)) (not (clear ?x)) (not (handempty)) (holding ?x)))
  (:action put-down
    :parameters (?x)
    :precondition (holding ?x)
    :effect (and (not (holding ?x)) (clear ?x) (handempty) (ontable ?x)))
  (:action stack
    :parameters (?x ?y)
    :precondition (and (holding ?x) (clear ?y))
    :effect (and (not (holding ?x)) (not (clear ?y)) (clear ?x) (handempty) (on ?x ?y)))
  (:action unstack
    :parameters (?x ?y)
    :precondition (and (on ?x ?y) (clear ?x) (handempty))
    :effect (and (holding ?x) (clear ?y) (not (clear ?x)) (not (handempty)) (not (on ?x ?y)))))
"""

GEARBOX = """\
(define (domain gearbox)
  (:requirements :strips)
  (:predicates (free) (holding ?p) (on-table ?p) (in-case ?p) (screwed ?p) (next ?p ?q) (first ?p))
  (:action pick-up
    :parameters (?p)
    :precondition (and (free) (on-table ?p))
    :effect (and (holding ?p) (not (free)) (not (on-table ?p))))
  (:action put-down
    :parameters (?p)
    :precondition (holding ?p)
    :effect (and (free) (on-table ?p) (not (holding ?p))))
  (:action insert-first
    :parameters (?p)
    :precondition (and (holding ?p) (first ?p))
    :effect (and (free) (in-case ?p) (not (holding ?p))))
  (:action insert
    :parameters (?p ?q)
    :precondition (and (holding ?q) (next ?p ?q) (in-case ?p))
    :effect (and (free) (in-case ?q) (not (holding ?q))))
  (:action screw
    :parameters (?p)
    :precondition (and (free) (in-case ?p))
    :effect (screwed ?p)))
"""


def blocks_problem(chance: random.Random, count: int) -> str:
    """Draw a problem of the blocks world; there is always a plan.

    Args:
        chance: The source of the draw.
        count: How many blocks.
    """
    names = [f"b{number}" for number in range(count)]
    start, end = _towers(chance, names), _towers(chance, names)
    covered = {under for _, under in start}
    init = ["(handempty)", *(f"(clear {each})" for each in names if each not in covered)]
    init += [f"(on {a} {b})" if b else f"(ontable {a})" for a, b in start]
    goal = [f"(on {a} {b})" if b else f"(ontable {a})" for a, b in end]
    return (
        f"(define (problem p) (:domain blocks) (:objects {' '.join(names)})\n"
        f"  (:init {' '.join(init)})\n  (:goal (and {' '.join(goal)})))\n"
    )


def _towers(chance: random.Random, names: list[str]) -> list[tuple[str, str]]:
    """Draw towers: each block with the one below it, or with nothing."""
    order = chance.sample(names, len(names))
    share = chance.choice((0.5, 0.7, 0.9))
    below = ["", *(each if chance.random() < share else "" for each in order)]
    return list(zip(order, below, strict=False))


def gearbox_problem(parts: int) -> str:
    """Give the problem of inserting parts in their order, every fourth to be screwed."""
    names = [f"p{number}" for number in range(1, parts + 1)]
    init = ["(free)", f"(first {names[0]})", *(f"(on-table {each})" for each in names)]
    init += [f"(next {a} {b})" for a, b in pairwise(names)]
    goal = [f"(in-case {each})" for each in names] + [f"(screwed {each})" for each in names[3::4]]
    return (
        f"(define (problem p) (:domain gearbox) (:objects {' '.join(names)})\n"
        f"  (:init {' '.join(init)})\n  (:goal (and {' '.join(goal)})))\n"
    )


def gearbox_scene(parts: int) -> tuple[list[Percept], list[str]]:
    """Give what is perceived of parts on a table beside a case, and the goals: all in the case."""
    kinds = ("hubcover", "input", "output", "plug")
    near = {"x": 0.4, "y": 0.1, "z": 0.01, "seen": "yes"}
    names = [f"{kinds[number % 4]}-{number}" for number in range(parts)]
    scene = [Percept("hand", "hand1", {"reach": 0.85})]
    scene.append(Percept("object", "case", {"type": "case", **near}))
    scene += [Percept("object", each, {"type": each.split("-")[0], **near}) for each in names]
    return scene, [f"(attached {each} case)" for each in names]


def written(folder: Path, domain: str, problem: str) -> tuple[Path, Path]:
    """Write a domain and a problem; give the files."""
    paths = folder / "domain.pddl", folder / "problem.pddl"
    for path, text in zip(paths, (domain, problem), strict=True):
        path.write_text(text, encoding="utf-8")
    return paths
