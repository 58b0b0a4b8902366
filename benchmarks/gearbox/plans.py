"""When things go wrong in a run, and with whom: drawn from the run's seed."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

from gearbox.trials import TASKS, Trial
from runtime.cell import Act, PersonParameters
from runtime.cell.layout import random_layout
from runtime.parts import load_parts


@dataclass(frozen=True, slots=True)
class Plan:
    """What is to go wrong in one run.

    Args:
        controller: The controller's schedule of faults, as `icarus controller --faults` reads it.
        mishaps: Fields of `runtime.cell.Mishaps`.
        person: How the person behaves; None as usual.
        kill_after: The program is killed after so many cycles; 0: it is not.
        willing: Whether the operator gives the word to go on after a stop or a lost link.
    """

    controller: tuple[Mapping[str, object], ...] = ()
    mishaps: Mapping[str, Any] = field(default_factory=dict)
    person: PersonParameters | None = None
    kill_after: int = 0
    willing: bool = True


Planner: TypeAlias = Callable[[random.Random, Trial], Plan]
"""Draws the plan of a run; the generator is seeded by fault, task and seed of the run."""

_TRAVEL_RAD: Final = (0.1, 4.0)
"""When a fault strikes: the arm's joints have turned by so much since the first move."""


_WILLING: Final = 0.5
"""The share of the runs in which the operator gives the word to go on."""

_ELSEWHERE_M: Final = ((0.32, 0.55), (-0.22, 0.22))
"""Where the person puts parts: x and y."""

_APART_M: Final = 0.1
"""How far from the middle of everything else."""

_CYCLES: Final = (1, 60)
"""When a program is killed."""


def during_motion(fault: str, **parameters: tuple[float, float]) -> Planner:
    """Plan one of the controller's faults while the arm is on its way; draw its parameters."""

    def plan(rng: random.Random, _trial: Trial) -> Plan:
        travel = round(rng.uniform(*_TRAVEL_RAD), 3)
        drawn = {name: round(rng.uniform(*span), 3) for name, span in parameters.items()}
        strikes = {"fault": fault, "when": {"travel_rad": travel}, **drawn}
        return Plan((strikes,), willing=rng.random() < _WILLING)

    return plan


def from_the_start(fault: str) -> Planner:
    """Plan one of the controller's faults that is there before anybody connects."""
    return lambda _rng, _trial: Plan(({"fault": fault, "when": {"time_s": 0.0}},))


def mishap(**rates: float) -> Planner:
    """Plan mishaps of the cell, by their rates."""
    return lambda _rng, _trial: Plan(mishaps=rates)


def refusing(share: float) -> Planner:
    """Plan that the person does not do what is asked, with a probability."""
    return lambda _rng, _trial: Plan(person=PersonParameters(refuses=share))


def silent(_rng: random.Random, _trial: Trial) -> Plan:
    """Plan that the person never says what is done."""
    return Plan(person=PersonParameters(reports=False))


def nothing(_rng: random.Random, _trial: Trial) -> Plan:
    """Plan that nothing goes wrong."""
    return Plan()


def killed(rng: random.Random, _trial: Trial) -> Plan:
    """Plan that the program is killed at some cycle."""
    return Plan(kill_after=rng.randint(*_CYCLES))


def taken(*, reports: bool, back: bool) -> Planner:
    """Plan that the person takes the task's part out of its seat, or away from the table."""

    def plan(rng: random.Random, trial: Trial) -> Plan:
        part = TASKS[trial.task].part
        after = round(rng.uniform(0.0, 2.0), 3)
        acts = [Act("take-away", (part,), when="inserted", after_s=after)]
        if back:
            x, y = (f"{value:.3f}" for value in free_place(rng, trial.seed))
            acts.append(Act("put-back", (part, x, y), when="inserted", after_s=after + 1.0))
        return Plan(person=PersonParameters(tuple(acts), reports))

    return plan


def moved(rng: random.Random, trial: Trial) -> Plan:
    """Plan that the person puts the task's part elsewhere before the robot gets there."""
    part = TASKS[trial.task].part
    x, y = (f"{value:.3f}" for value in free_place(rng, trial.seed))
    at_s = round(rng.uniform(0.0, 6.0), 3)
    return Plan(person=PersonParameters((Act("put-back", (part, x, y), at_s=at_s),)))


def free_place(rng: random.Random, seed: int) -> tuple[float, float]:
    """Draw a place of the table, m, on which nothing stands in the scene of a seed."""
    layout = random_layout(load_parts(), seed)
    places = [each.position[:2] for each in (*layout.parts, layout.fixture)]
    while True:
        place = (rng.uniform(*_ELSEWHERE_M[0]), rng.uniform(*_ELSEWHERE_M[1]))
        if all(math.dist(place, each) > _APART_M for each in places):
            return place


def reaches_in(rng: random.Random, trial: Trial) -> Plan:
    """Plan that the person holds the hand between camera and parts, again and again."""
    task = TASKS[trial.task]
    times = sorted(round(rng.uniform(0.0, 25.0), 3) for _ in range(3))
    over = ((task.part,), (task.receiver,), ())
    acts = (Act("reach-in", parts, at_s=at) for parts, at in zip(over, times, strict=True))
    return Plan(person=PersonParameters(tuple(acts)))
