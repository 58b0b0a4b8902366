"""Plans that are followed in worlds that others change: kept, repaired, replanned, and why."""

from __future__ import annotations

import importlib.util
import json
import random
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from icarus_lite import Agent, DecisionKind, FrameError, load_domain
from icarus_lite.agent import Decision
from icarus_lite.execution import Verdict
from icarus_lite.trace import cycle_record

ROOT = Path(__file__).resolve().parents[3]
BLOCKS = load_domain(ROOT / "domains" / "blocks.icr")
GRIPPER = load_domain(ROOT / "domains" / "gripper.icr")

_spec = importlib.util.spec_from_file_location(
    "skill_worlds", ROOT / "tests" / "reference" / "skill_worlds.py"
)
worlds = importlib.util.module_from_spec(_spec)
sys.modules["skill_worlds"] = worlds
_spec.loader.exec_module(worlds)

SUSSMAN = ["(on a b)", "(on b c)"]


def move(world, block: str, onto: str | None) -> None:
    """Move a block that nothing stands on; None for onto the table."""
    column = world.column_of(block)
    assert world.towers[column][-1] == block
    world.towers[column].pop()
    if onto is None:
        world.towers.append([block])
    else:
        world.towers[world.column_of(onto)].append(block)


def followed(
    towers: list[list[str]], goals: list[str], after: dict[int, tuple[str, str | None]]
) -> tuple[list[Decision], Agent]:
    """Let an agent act while somebody moves blocks after some of its actions, counted from 1."""
    world, agent = worlds.BlocksWorld(towers), Agent(BLOCKS, goals)

    def meddle(world) -> None:
        if len(world.done) in after:
            block, onto = after.pop(len(world.done))
            move(world, block, onto)

    return worlds.run(world, agent, meddle=meddle, cycles=40), agent


def verdicts(decisions: list[Decision]) -> list[str]:
    return [str(each.plan.verdict) for each in decisions if each.plan is not None]


def test_without_surprises_the_plan_is_made_once_and_kept() -> None:
    decisions, agent = followed([["a", "c"], ["b"]], SUSSMAN, {})
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    assert verdicts(decisions) == ["made", *["kept"] * 5]
    assert [d.plan.position for d in decisions if d.plan] == [0, 1, 2, 3, 4, 5]
    assert all(len(d.plan.plan.steps) == 6 and d.plan.plan.links for d in decisions if d.plan)
    assert agent.plan_counts.made == 1
    assert agent.plan_counts.surprises == 0


def test_what_nothing_rests_on_may_be_as_it_likes() -> None:
    decisions, agent = followed([["a", "c"], ["b"], ["d"], ["e"]], SUSSMAN, {2: ("e", "d")})
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    assert verdicts(decisions) == ["made", *["kept"] * 5]
    status = decisions[2].plan
    assert [str(each) for each in status.surprises] == [
        "(above e d)",
        "(not (clear d))",
        "(not (ontable e t))",
        "(on e d)",
    ]
    assert status.text.endswith("and 1 more: nothing rests on it")
    assert decisions[2].reason == "next step of the plan, 4 to go"
    assert not decisions[3].plan.surprises  # it is no news any longer
    assert (agent.plan_counts.surprises, agent.plan_counts.kept) == (1, 1)


def test_steps_that_somebody_else_has_done_are_skipped() -> None:
    decisions, agent = followed([["a", "c"], ["b"]], SUSSMAN, {2: ("b", "c")})
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    assert [str(d.step.action) for d in decisions if d.step] == [
        "(unstack hand1 c a)",
        "(put-down hand1 c t)",
        "(pick-up hand1 a t)",
        "(stack hand1 a b)",
    ]
    assert decisions[2].plan.verdict is Verdict.REPAIRED
    assert decisions[2].plan.text.endswith("the plan goes on with step 5 (pick-up hand1 a t)")
    assert agent.plan_counts.repaired == 1


def test_steps_that_somebody_has_undone_are_done_once_more() -> None:
    decisions, agent = followed([["a", "c"], ["b"]], SUSSMAN, {2: ("c", "a")})
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    assert len(decisions) == 2 + 6 + 1
    status = decisions[2].plan
    assert (status.verdict, status.position) == (Verdict.REPAIRED, 0)
    assert status.text.startswith("(clear a) is not so, on which step 5 (pick-up hand1 a t) rests")
    assert status.text.endswith("back to step 1 (unstack hand1 c a)")
    assert (agent.plan_counts.made, agent.plan_counts.repaired) == (1, 1)


def test_where_no_rest_of_it_works_another_plan_is_made() -> None:
    decisions, agent = followed([["a", "c"], ["b"], ["d"]], SUSSMAN, {2: ("d", "b")})
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    replanned = decisions[2].plan
    assert replanned.verdict is Verdict.REPLANNED
    assert replanned.text == "(clear b) is not so, on which step 3 (pick-up hand1 b t) rests"
    assert str(replanned.plan.steps[0].action) == "(unstack hand1 d b)"
    counts = agent.plan_counts
    assert (counts.made, counts.surprises, counts.replanned) == (2, 1, 1)


def test_a_ball_that_somebody_brings_along_need_not_be_fetched() -> None:
    world = worlds.CorridorWorld({"ball1": 6.0})
    agent = Agent(GRIPPER, ["(lies-in ball1 hall)", "(robot-in robby hall)"])

    def meddle(world) -> None:
        if len(world.done) == 1:  # the robot has gone to the kitchen
            world.balls["ball1"] = 2.0

    decisions = worlds.run(world, agent, meddle=meddle)
    assert decisions[-1].kind is DecisionKind.ACHIEVED
    assert world.done == ["(drive robby kitchen)", "(drive robby hall)"]


def test_why_this_action_goes_down_to_the_goal() -> None:
    world, agent = worlds.BlocksWorld([["a", "c"], ["b"]]), Agent(BLOCKS, SUSSMAN)
    with pytest.raises(FrameError, match="run a cycle first"):
        agent.why_action()
    agent.cycle(world.percepts())
    answer = agent.why_action()
    assert str(answer).splitlines() == [
        "cycle 0: (unstack hand1 c a); first of 6 steps to the goal",
        "for (on a b) (on b c)",
        "(unstack hand1 c a), step 1 of 6",
        "  needs (on c a): holds",
        "  needs (clear c): holds",
        "  needs (hand-empty hand1): holds",
        "  brings about (holding hand1 c), which step 2 (put-down hand1 c t) needs",
        "  brings about (not (on c a)), so that (clear a), which step 5 (pick-up hand1 a t) needs",
        "  and so: step 2 (put-down hand1 c t) → step 4 (stack hand1 b c) → (on b c)",
    ]
    shown = json.loads(json.dumps(answer.as_dict()))
    assert shown["action"] == "(unstack hand1 c a)"
    assert [link["consumer"] for link in shown["purpose"]["serves"]] == [1, 4]


def test_why_this_action_on_a_skill_path_names_the_skills_above_it() -> None:
    world = worlds.BlocksWorld([["a", "b", "c", "d"]])
    agent = Agent(BLOCKS, intentions=["(make-clear a)"])
    agent.cycle(world.percepts())
    lines = str(agent.why_action()).splitlines()
    assert lines[1] == "for (make-clear a) → (make-clear b) → (make-clear c)"
    assert agent.why_action().purpose is None


def test_the_trace_has_links_where_they_are_new_and_only_there() -> None:
    decisions, _ = followed([["a", "c"], ["b"], ["d"], ["e"]], SUSSMAN, {2: ("e", "d")})
    rows = [json.loads(json.dumps(cycle_record(d, [], [])))["plan"] for d in decisions]
    assert rows[-1] is None
    assert [("links" in row) for row in rows[:-1]] == [True, *[False] * 5]
    assert rows[0]["links"][0] == {
        "producer": None,
        "fact": "(on c a)",
        "condition": "(on c a)",
        "consumer": 0,
        "through": [],
    }
    assert rows[2]["surprises"] == [
        "(above e d)",
        "(not (clear d))",
        "(not (ontable e t))",
        "(on e d)",
    ]
    assert rows[2]["verdict"] == "kept"


@dataclass
class Adversary:
    """Moves a block now and then, mostly anyhow, sometimes as the agent would want it."""

    rng: random.Random
    helpful: float
    probability: float = 0.2
    moves: int = field(default=0)

    def __call__(self, world) -> None:
        if self.rng.random() >= self.probability:
            return
        tops = [tower[-1] for tower in world.towers if tower]
        if self.rng.random() < self.helpful:
            for block, onto in (("b", "c"), ("a", "b")):
                if {block, onto} <= set(tops):
                    self.moves += 1
                    move(world, block, onto)
                    return
        block = self.rng.choice(tops)
        places: list[str | None] = [top for top in tops if top != block]
        self.moves += 1
        move(world, block, self.rng.choice([*places, None]))


def against(seed: int, helpful: float) -> tuple[list[Decision], Agent, Adversary]:
    rng = random.Random(seed)
    names = list("abcde")
    rng.shuffle(names)
    cut = sorted(rng.sample(range(1, 5), 2))
    towers = [names[: cut[0]], names[cut[0] : cut[1]], names[cut[1] :]]
    adversary = Adversary(rng, helpful)
    agent = Agent(BLOCKS, SUSSMAN)
    run: Callable[..., list[Decision]] = worlds.run
    return run(worlds.BlocksWorld(towers), agent, meddle=adversary, cycles=300), agent, adversary


@pytest.mark.parametrize("helpful", [0.0, 0.5])
def test_the_goal_is_reached_though_an_adversary_moves_blocks(helpful: float) -> None:
    moves = kept = repaired = replanned = 0
    for seed in range(12):
        decisions, agent, adversary = against(seed, helpful)
        assert decisions[-1].kind is DecisionKind.ACHIEVED, (seed, decisions[-1].reason)
        counts = agent.plan_counts
        assert counts.surprises == counts.kept + counts.repaired + counts.replanned
        assert counts.made <= 1 + counts.replanned + sum(d.plan is None for d in decisions)
        moves += adversary.moves
        kept, repaired = kept + counts.kept, repaired + counts.repaired
        replanned += counts.replanned
    assert moves > 10
    assert kept  # otherwise the test shows nothing
    assert replanned
    if helpful:
        assert repaired


def test_the_same_adversary_meets_the_same_agent() -> None:
    def told(seed: int) -> list[object]:
        decisions, _, _ = against(seed, 0.5)
        return [json.dumps(cycle_record(each, [], [])["plan"]) for each in decisions]

    assert told(5) == told(5)
