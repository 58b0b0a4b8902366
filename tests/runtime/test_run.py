"""Whole runs: the real ur-rtde client, over TCP, on the stand-in controller."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from icarus_lite import load_domain
from icarus_lite.trace import Trace, read_trace
from runtime.config import load_robot
from runtime.controller.process import ControllerProcess
from runtime.cycle_report import CycleReport
from runtime.run import RunOptions, RunResult, run_task

pytestmark = pytest.mark.robot
CLOCK = 6.0


def run(
    gearbox: Path,
    trace: Path,
    observer: Callable[[CycleReport], None] | None = None,
    **options: object,
) -> RunResult:
    settings = RunOptions(trace=trace, clock=CLOCK, **options)
    return run_task(load_domain(gearbox), "1.1", settings, observer)


def statuses(trace: Trace, name: str) -> list[tuple[str, str | None]]:
    return [
        (anchor["status"], anchor["parent"])
        for cycle in trace.cycles
        for anchor in cycle["anchors"]
        if anchor["name"] == name
    ]


def beliefs(trace: Trace) -> list[set[str]]:
    held: set[str] = set()
    history = []
    for cycle in trace.cycles:
        held = held - set(cycle["removed"]) | {row["belief"] for row in cycle["added"]}
        history.append(held)
    return history


def test_the_hub_cover_is_believed_while_it_is_carried_unseen(
    gearbox: Path, tmp_path: Path
) -> None:
    result = run(gearbox, tmp_path / "run.jsonl")
    assert result.achieved, result.reason
    trace = read_trace(tmp_path / "run.jsonl")
    assert ("attached", "hand1") in statuses(trace, "hubcover")
    history = beliefs(trace)
    assert any("(hidden-in-hand hubcover)" in held for held in history)
    assert "(attached hubcover case)" in history[-1]
    assert "(attached hubcover hand1)" not in history[-1]
    assert trace.cycles[-1]["goals"] == [{"goal": "(attached hubcover case)", "satisfied": True}]
    log = (tmp_path / "run.controller.log").read_text()
    assert "not a robot" in log


def test_without_attachments_the_belief_is_lost(gearbox: Path, tmp_path: Path) -> None:
    result = run(gearbox, tmp_path / "run.jsonl", attachments=False)
    assert not result.achieved
    assert "hubcover is no longer anchored" in result.reason
    assert "(attached hubcover case)" not in beliefs(read_trace(tmp_path / "run.jsonl"))[-1]


def in_carrying(do: Callable[[], object]) -> Callable[[CycleReport], None]:
    """Do something once, when the arm is on its way with the part."""
    done: list[bool] = []

    def observe(report: CycleReport) -> None:
        step = report.decision.step
        moving = step is not None and step.action.name == "insert"
        if moving and report.arm.tcp_pose[2] > 0.15 and not done:
            done.append(True)
            do()

    return observe


@pytest.fixture
def controller(tmp_path: Path):
    joints = load_robot("ur5").look_joints
    with ControllerProcess.start(
        "ur5", clock=CLOCK, joints=joints, log=tmp_path / "controller.log"
    ) as process:
        yield process


def test_a_controller_that_somebody_else_started(
    gearbox: Path, tmp_path: Path, controller: ControllerProcess
) -> None:
    result = run(gearbox, tmp_path / "run.jsonl", address=controller.address)
    assert result.achieved, result.reason


def test_a_protective_stop_ends_the_run_with_its_reason(
    gearbox: Path, tmp_path: Path, controller: ControllerProcess
) -> None:
    stop = in_carrying(lambda: controller.bench({"fault": {"protective_stop": True}}))
    result = run(gearbox, tmp_path / "run.jsonl", stop, address=controller.address)
    assert not result.achieved
    assert "protective stop" in result.reason
    assert result.actions[-1].status == "failed"
    before = controller.bench({"query": "state"})["joints"]
    assert controller.bench({"query": "state"})["joints"] == before
    assert read_trace(tmp_path / "run.jsonl").warning == ""


def test_a_controller_that_dies_mid_move_is_a_failed_task_and_a_whole_trace(
    gearbox: Path, tmp_path: Path, controller: ControllerProcess
) -> None:
    result = run(
        gearbox, tmp_path / "run.jsonl", in_carrying(controller.close), address=controller.address
    )
    assert not result.achieved
    assert controller.address in result.reason or "controller" in result.reason
    trace = read_trace(tmp_path / "run.jsonl")
    assert trace.warning == ""
    assert len(trace.cycles) > 10


def test_an_interrupt_stops_the_arm_and_keeps_the_trace(
    gearbox: Path, tmp_path: Path, controller: ControllerProcess
) -> None:
    trace = tmp_path / "run.jsonl"
    command = [sys.executable, "-m", "runtime.cli", "run", str(gearbox), "--task", "1.1"]
    command += ["--address", controller.address, "--trace", str(trace)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if "(pick-up hand1 hubcover)" in line:
                process.send_signal(signal.SIGINT)
                break
        rest = process.stdout.read()
    assert process.returncode == 1
    assert "interrupted by the operator" in rest
    assert read_trace(trace).warning == ""
    state = controller.bench({"query": "state"})
    assert controller.bench({"query": "state"})["joints"] == state["joints"]
