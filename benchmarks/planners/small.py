"""Many small problems, and single decisions: what planning costs inside a cycle."""

from __future__ import annotations

import random
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from icarus_lite import Agent, load_domain
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.planning import Imagination, Plan, find_plan
from icarus_lite.planning.grounding import PlanningDomain
from icarus_lite.planning.search import Limits, search
from planners.generated import (
    BLOCKS,
    GEARBOX,
    blocks_problem,
    gearbox_problem,
    gearbox_scene,
    written,
)
from planners.instances import Instance
from planners.planned import actions, imported
from planners.towers import by_skills
from planners.validation import flaw

GEARBOX_ICR = Path(__file__).resolve().parents[2] / "domains" / "gearbox.icr"
REPEATS = 21


def section(problems: int, blocks: list[Instance]) -> list[str]:
    """Give the part of the page about small problems.

    Args:
        problems: How many problems of the blocks world to draw.
        blocks: Those of the sixty problems that skills are to carry out.
    """
    return [
        "## Small problems",
        "",
        *random_blocks(problems),
        *gearbox(12),
        *skills(blocks),
        "",
    ]


def random_blocks(problems: int) -> list[str]:
    """Solve random problems of the blocks world, 4 to 13 blocks each, and check the plans."""
    chance = random.Random(1)  # noqa: S311 - the same problems each time
    valid = steps = evaluations = 0
    slowest = 0.0
    with tempfile.TemporaryDirectory() as folder:
        for number in range(problems):
            problem = blocks_problem(chance, 4 + number % 10)
            files = written(Path(folder), BLOCKS, problem)
            start = time.process_time()
            task = imported(*files).ground()
            found = search(task, Limits(evaluations=50_000))
            slowest = max(slowest, time.process_time() - start)
            evaluations += found.effort.evaluations
            if found.plan is not None and not flaw(*files, actions(task, found.plan)):
                valid += 1
                steps += len(found.plan)
    return [
        (
            f"* {problems} random problems of the blocks world with 4 to 13 blocks, seed 1: "
            f"**{valid} solved with a valid plan**, {steps} steps, {evaluations} evaluations, "
            f"{1e3 * slowest:.0f} ms for the slowest, reading the files included."
        )
    ]


def gearbox(parts: int) -> list[str]:
    """Time single decisions about a gearbox."""
    with tempfile.TemporaryDirectory() as folder:
        files = written(Path(folder), GEARBOX, gearbox_problem(parts))
        strips = imported(*files)
        plan = search(strips.ground()).plan
        assert plan is not None
        assert not flaw(*files, actions(strips.ground(), plan))
    domain = load_domain(GEARBOX_ICR)
    scene, goals = gearbox_scene(parts)
    engine = InferenceEngine(domain)
    memory = engine.step(Memory(), scene)
    prepared = PlanningDomain(domain, engine.evaluator)
    conditions = [parse_conditions(goal)[0] for goal in goals]

    def ours() -> Plan:
        imagination = Imagination(domain, memory, engine.closure, engine.evaluator)
        found = find_plan(domain, imagination, conditions, prepared=prepared)
        assert isinstance(found, Plan)
        return found

    warm = Agent(domain, goals=goals)
    warm.cycle(scene)
    agents = iter([Agent(domain, goals=goals) for _ in range(REPEATS)])
    return [
        (
            f"* A gearbox of {parts} parts in STRIPS, one hand, every fourth part to be screwed "
            f"({len(plan)} steps): grounding and the whole plan take "
            f"**{milliseconds(lambda: search(strips.ground())):.1f} ms**, the median of {REPEATS}."
        ),
        (
            f"* `domains/gearbox.icr` with {parts} parts, all to go into the case "
            f"({len(ours().steps)} steps): `find_plan`, from beliefs to a plan that has been "
            f"checked, takes **{milliseconds(ours):.1f} ms**; the first cycle of an agent, in "
            f"which its skills decide, {milliseconds(lambda: next(agents).cycle(scene)):.1f} ms."
        ),
    ]


def skills(blocks: list[Instance]) -> list[str]:
    """Let skills carry out problems of the blocks world, without any search."""
    if not blocks:
        return []
    lengths = []
    for each in blocks:
        done = by_skills(each.problem)
        assert not flaw(each.domain, each.problem, done), each.name
        lengths.append(len(done))
    return [
        (
            f"* The {len(blocks)} blocks problems of the table carried out by the skills of "
            f"`benchmarks/planners/towers.icr`, in a simulated world: **{sum(lengths)} actions** "
            f"({', '.join(map(str, lengths))}), all valid, planning never asked."
        )
    ]


def milliseconds(call: Callable[[], object]) -> float:
    """Give the median processor time of a call."""
    times = []
    for _ in range(REPEATS):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return 1e3 * statistics.median(times)
