"""A run that was cut off goes on as if nothing had happened, as far as its beliefs go."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from recorded_runs import STORE, record

from icarus_lite import Action, Agent, Outcome
from icarus_lite.trace import (
    RESUMED,
    Recording,
    TraceWriter,
    cycle_record,
    header,
    inputs_of,
    replay,
    resumed_agent,
)


def go_on(path: Path, whole: Recording, after: int, **extra: object) -> Agent:
    """Take a run up after a cycle, with what the whole one perceived from there on."""
    agent = resumed_agent(Recording(path))
    with TraceWriter(path, None) as writer:
        for cycle in [each for each in whole.cycles if each > after]:
            percepts, outcomes = inputs_of(whole.record(cycle))
            decision = agent.cycle(percepts, outcomes)
            told = {**extra, RESUMED: True} if cycle == after + 1 else extra
            writer.write(cycle_record(decision, percepts, outcomes, **told))
    return agent


def cut(whole: Path, part: Path, after: int, rest: str = "") -> None:
    lines = whole.read_text(encoding="utf-8").splitlines(keepends=True)
    part.write_text("".join(lines[: after + 2]) + rest, encoding="utf-8")


@pytest.mark.parametrize("seed", range(6))
def test_beliefs_and_reasons_are_those_of_the_run_that_was_not_cut_off(tmp_path, seed):
    run = record(tmp_path / "whole.jsonl", seed, 24, explained=True)
    whole = Recording(run.path)
    for after in range(0, 23, 4):
        part = tmp_path / "part.jsonl"
        cut(run.path, part, after)
        agent = go_on(part, whole, after)
        resumed = Recording(part)
        for cycle in whole.cycles:
            instant = resumed.at(cycle)
            assert [str(b) for b in instant.state.beliefs] == list(run.believed[cycle])
        last = run.whys[-1]
        assert {belief: str(agent.why(belief)) for belief in last} == last


@pytest.mark.parametrize("after", [0, 7, 15])
def test_a_resumed_run_replays_to_the_same_bytes(tmp_path, after):
    run = record(tmp_path / "whole.jsonl", 3, 20)
    part = tmp_path / "part.jsonl"
    cut(run.path, part, after)
    go_on(part, Recording(run.path), after)
    told = replay(Recording(part))
    assert told.beliefs is None, told
    assert told.decisions is None, told


@pytest.mark.parametrize("rest", ['{"cycle": 9, "outco', "garbage", '{"a": "é'[:-1] + "\xc3"])
def test_what_was_cut_off_in_the_middle_of_a_line_is_dropped(tmp_path, rest):
    run = record(tmp_path / "whole.jsonl", 1, 12)
    part = tmp_path / "part.jsonl"
    cut(run.path, part, 8, rest)
    go_on(part, Recording(run.path), 8)
    assert list(Recording(part).cycles) == list(range(12))
    assert Recording(part).warning == ""
    for line in part.read_bytes().splitlines():
        json.loads(line)


def test_a_last_line_that_only_lacks_its_end_is_kept(tmp_path):
    run = record(tmp_path / "whole.jsonl", 1, 12)
    part = tmp_path / "part.jsonl"
    cut(run.path, part, 8)
    part.write_bytes(part.read_bytes()[:-1])
    go_on(part, Recording(run.path), 8)
    assert list(Recording(part).cycles) == list(range(12))


def test_a_run_that_was_cut_off_before_its_first_cycle_begins_there(tmp_path):
    path = tmp_path / "run.jsonl"
    TraceWriter(path, header(STORE, ["(stored a)"])).close()
    agent = resumed_agent(Recording(path))
    assert [str(goal) for goal in agent.goals] == ["(stored a)"]
    assert agent.cycle([]).cycle == 0


def test_goals_that_were_told_are_goals_again(tmp_path):
    path = tmp_path / "run.jsonl"
    agent = Agent(STORE, ["(stored a)"])
    with TraceWriter(path, header(STORE, agent.goals)) as writer:
        for cycle in range(4):
            if cycle == 1:
                agent.add_goal("(taken b)", priority=3, name="extra")
            if cycle == 2:
                agent.remove_goal("(stored a)")
            outcomes = [Outcome(Action("take", ("h", "a")))] if cycle == 0 else []
            writer.write(cycle_record(agent.cycle([], outcomes), [], outcomes))
    resumed = resumed_agent(Recording(path))
    assert "(taken a)" in map(str, resumed.state.beliefs)
    resumed.cycle([])
    assert [str(goal) for goal in resumed.goals] == ["(taken b)"]


def test_a_goal_that_was_reached_is_not_pursued_again(tmp_path):
    path = tmp_path / "run.jsonl"
    agent = Agent(STORE, ["(stored a)"])
    with TraceWriter(path, header(STORE, agent.goals)) as writer:
        for cycle in range(4):
            if cycle == 1:
                agent.add_goal("(taken b)", priority=3, name="once")
            outcomes = [Outcome(Action("take", ("h", "b")))] if cycle == 2 else []
            writer.write(cycle_record(agent.cycle([], outcomes), [], outcomes))
    assert agent.goal_names == ("(stored a)",)
    resumed = resumed_agent(Recording(path))
    resumed.cycle([])
    assert resumed.goal_names == ("(stored a)",)
