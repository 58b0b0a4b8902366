"""A trace that was cut off, read back as what a run can go on from."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from scripted_assembly import CONFIG, Body, Eyes

from aapa import Anchoring, AnchorStatus
from icarus_lite import Agent, load_domain
from icarus_lite.errors import TraceError
from icarus_lite.trace import Recording, TraceWriter, header, replay
from runtime.cell import Cell
from runtime.errors import UsageError
from runtime.loop import Loop, TakenUp
from runtime.resuming import (
    CUT_OFF,
    read_cut_off,
    read_world,
    task_of,
    world_keeper,
    world_path,
)
from runtime.run import anchoring_parameters
from runtime.second_look import LoopLimits
from runtime.workplace import Workplace

GOAL = "(attached hubcover case)"


def record(path: Path, gearbox: Path, cycles: int = 1000) -> Body:
    """Record task 1.1 on a scripted body, cut off after some cycles."""
    domain = load_domain(gearbox)
    first = header(domain, [GOAL], task="1.1", robot="ur5", seed=7, others=[], long_term=False)
    body = Body(polls=8)
    agent = Agent(domain, [GOAL], others=(), long_term=False)
    with TraceWriter(path, first) as trace:
        Loop(
            agent,
            Anchoring(anchoring_parameters()),
            body,
            Eyes(body),
            CONFIG,
            trace=trace,
            limits=LoopLimits(cycles=cycles),
        ).run()
    return body


def lines(path: Path) -> list[dict[str, object]]:
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


@pytest.mark.parametrize("cycles", [1, 4, 9, 14, 20])
def test_a_run_goes_on_from_wherever_it_was_cut_off(gearbox: Path, tmp_path: Path, cycles: int):
    path = tmp_path / "run.jsonl"
    body = record(path, gearbox, cycles)
    body.stop()
    found = read_cut_off(path, load_domain(gearbox), "1.1", "ur5")
    assert (found.cycle, found.seed) == (cycles - 1, 7)
    anchoring = Anchoring(anchoring_parameters())
    anchoring.state = found.anchoring
    with TraceWriter(path, None) as trace:
        result = Loop(
            found.agent,
            anchoring,
            body,
            Eyes(body),
            CONFIG,
            trace=trace,
            taken_up=TakenUp(found.anchoring.anchors, found.interrupted),
        ).run()
    assert result.achieved, result.reason
    again = replay(Recording(path))
    assert again.beliefs is None, again
    assert again.decisions is None, again


def test_what_was_under_way_has_failed(gearbox: Path, tmp_path: Path):
    path = tmp_path / "run.jsonl"
    record(path, gearbox, 8)
    interrupted = read_cut_off(path, load_domain(gearbox), "1.1", "ur5").interrupted
    assert interrupted is not None
    assert str(interrupted.action) == "(pick-up hand1 hubcover)"
    assert interrupted.reason == CUT_OFF


def test_anchors_are_taken_up_with_their_names_and_parents(gearbox: Path, tmp_path: Path):
    path = tmp_path / "run.jsonl"
    record(path, gearbox, 16)
    last = lines(path)[-1]
    state = read_cut_off(path, load_domain(gearbox), "1.1", "ur5").anchoring
    assert [anchor.name for anchor in state.anchors] == ["case", "hand1", "hubcover"]
    cover = state.anchors[2]
    assert (cover.status, cover.parent) == (AnchorStatus.ATTACHED, "hand1")
    assert state.frame == last["cycle"] + 1
    assert state.register.bare == {"case", "hubcover"}
    assert state.register.bodies == {"hand1"}


def test_a_trace_without_a_cycle_is_begun_anew(gearbox: Path, tmp_path: Path):
    path = tmp_path / "run.jsonl"
    record(path, gearbox, 1)
    path.write_text(path.read_text(encoding="utf-8").splitlines()[0] + "\n", encoding="utf-8")
    found = read_cut_off(path, load_domain(gearbox), "1.1", "ur5")
    assert (found.cycle, found.joints, found.interrupted) == (-1, None, None)


@pytest.mark.parametrize(
    ("task", "robot", "words"),
    [("1.2", "ur5", "the trace of task 1.1"), ("1.1", "ur16e", "the trace of robot ur5")],
)
def test_a_run_is_resumed_as_what_it_was(gearbox: Path, tmp_path: Path, task, robot, words):
    path = tmp_path / "run.jsonl"
    record(path, gearbox, 2)
    with pytest.raises(UsageError, match=words):
        read_cut_off(path, load_domain(gearbox), task, robot)


def test_an_edited_domain_is_refused(gearbox: Path, tmp_path: Path):
    path, edited = tmp_path / "run.jsonl", tmp_path / "gearbox.icr"
    record(path, gearbox, 2)
    edited.write_text(gearbox.read_text(encoding="utf-8") + "\n; more\n", encoding="utf-8")
    with pytest.raises(UsageError, match="not the domain that"):
        read_cut_off(path, load_domain(edited), "1.1", "ur5")


@pytest.mark.parametrize(
    ("key", "value"),
    [("anchors", "none"), ("arm", {"joints": [0] * 5}), ("anchors", [{"name": "case"}])],
)
def test_a_line_that_cannot_be_taken_up_is_named(gearbox: Path, tmp_path: Path, key, value):
    path = tmp_path / "run.jsonl"
    record(path, gearbox, 3)
    rows = lines(path)
    rows[-1][key] = value
    path.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    with pytest.raises(TraceError, match=rf"run.jsonl:{len(rows)}.*cannot be taken up"):
        read_cut_off(path, load_domain(gearbox), "1.1", "ur5")


def test_the_task_stands_in_the_trace(gearbox: Path, tmp_path: Path):
    path = tmp_path / "run.jsonl"
    record(path, gearbox, 2)
    assert task_of(path) == "1.1"
    TraceWriter(path, header(load_domain(gearbox), [])).close()
    with pytest.raises(TraceError, match="not the trace of a task"):
        task_of(path)


@pytest.mark.parametrize("content", [None, "", "[1]", '{"half":'])
def test_a_cell_that_was_not_kept_is_told(tmp_path: Path, content: str | None):
    trace = tmp_path / "run.jsonl"
    if content is not None:
        world_path(trace).write_text(content, encoding="utf-8")
    with pytest.raises(UsageError, match=r"run\.cell\.json"):
        read_world(trace)


def test_the_cell_is_written_down_before_the_first_cycle_is(tmp_path: Path):
    trace = tmp_path / "new" / "run.jsonl"
    with Cell("ur5", 2) as cell:
        place = Workplace(Body(), None, cell, "a cell")  # type: ignore[arg-type]
        world_keeper(place, trace)
        assert read_world(trace) == json.loads(json.dumps(cell.snapshot()))


def test_where_the_hand_of_a_person_was_is_forgotten(gearbox: Path, tmp_path: Path):
    path = tmp_path / "run.jsonl"
    record(path, gearbox, 9)
    rows = lines(path)
    anchors = rows[-1]["anchors"]
    assert isinstance(anchors, list)
    anchors.append({**anchors[0], "name": "person", "type": "person", "status": "occluded"})
    path.write_text("".join(f"{json.dumps(row)}\n" for row in rows), encoding="utf-8")
    found = read_cut_off(path, load_domain(gearbox), "1.1", "ur5")
    names = {anchor.name for anchor in found.anchoring.anchors}
    assert "person" not in names
    assert names == {anchor["name"] for anchor in anchors} - {"person"}
