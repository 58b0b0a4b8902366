"""When things go wrong in a run, and with whom: drawn from the run's seed."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

from gearbox.trials import TASKS, Trial
from runtime.cell import Act, PersonParameters
from runtime.cell.arrangement import PlacedPart
from runtime.cell.layout import LayoutParameters, random_layout
from runtime.parts import Vector, load_parts


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

_TRIES: Final = 400

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
            x, y = (f"{value:.3f}" for value in free_place(rng, trial.seed, part))
            acts.append(Act("put-back", (part, x, y), when="inserted", after_s=after + 1.0))
        return Plan(person=PersonParameters(tuple(acts), reports))

    return plan


def moved(rng: random.Random, trial: Trial) -> Plan:
    """Plan that the person puts the task's part elsewhere before the robot gets there."""
    part = TASKS[trial.task].part
    x, y = (f"{value:.3f}" for value in free_place(rng, trial.seed, part))
    at_s = round(rng.uniform(0.0, 6.0), 3)
    return Plan(person=PersonParameters((Act("put-back", (part, x, y), at_s=at_s),)))


def free_place(rng: random.Random, seed: int, kind: str) -> tuple[float, float]:
    """Draw a place of the table, m, for a part of a kind: in view, in reach, and beside nothing.

    What stands in the scene of a seed is in the way, but for the part itself.
    """
    layout, wanted = random_layout(load_parts(), seed), load_parts()[kind]
    others = [each for each in layout.parts if each.model.type != kind]
    room = LayoutParameters()
    for _ in range(_TRIES):
        x = rng.uniform(*_within(room.x_m, wanted.size[0]))
        y = rng.uniform(*_within(room.y_m, wanted.size[1]))
        if room.reach_m[0] <= math.hypot(x, y) <= room.reach_m[1] and all(
            _gap((x, y), wanted.size, each) >= room.gap_m for each in (*others, layout.fixture)
        ):
            return x, y
    # A large part on a full table: where it stood at first there is room for it.
    return next(each.position[:2] for each in layout.parts if each.model.type == kind)


def _within(span: tuple[float, float], size: float) -> tuple[float, float]:
    return span[0] + size / 2, span[1] - size / 2


def _gap(place: tuple[float, float], size: Vector, other: PlacedPart) -> float:
    """Give the free space between the outlines, unturned, of a part and of one that stands, m."""
    dx = abs(place[0] - other.position[0]) - (size[0] + other.model.size[0]) / 2
    dy = abs(place[1] - other.position[1]) - (size[1] + other.model.size[1]) / 2
    return math.hypot(max(dx, 0.0), max(dy, 0.0))


def reaches_in(rng: random.Random, trial: Trial) -> Plan:
    """Plan that the person holds the hand between camera and parts, again and again."""
    task = TASKS[trial.task]
    times = sorted(round(rng.uniform(0.0, 25.0), 3) for _ in range(3))
    over = ((task.part,), (task.receiver,), ())
    acts = (Act("reach-in", parts, at_s=at) for parts, at in zip(over, times, strict=True))
    return Plan(person=PersonParameters(tuple(acts)))
