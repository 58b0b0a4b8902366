"""The paper's tasks, from the first look to the end, and what may come between."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from command_line import icarus

from icarus_lite import load_domain
from icarus_lite.trace import RESUMED, Recording, TraceWriter, header, read_trace, replay
from runtime.cell import Act, CellParameters, Mishaps, PersonParameters
from runtime.config import load_robot
from runtime.cycle_report import CycleReport
from runtime.parts import load_parts
from runtime.run import RunOptions, RunResult, find_task, run_at
from runtime.workplace import Setting, Workplace, open_workplace

CLOCK = 8.0


def run(
    gearbox: Path,
    trace: Path,
    task: str,
    *,
    seed: int = 3,
    cell: CellParameters | None = None,
    faults: list[dict[str, object]] | None = None,
    watch: Callable[[Workplace], Callable[[CycleReport], None]] | None = None,
    **options: object,
) -> tuple[RunResult, dict[str, str]]:
    """Run a task; give its result, and what really sits where in the end."""
    domain = load_domain(gearbox)
    chosen = find_task(domain, task)
    config = load_robot(chosen.robot or "ur5")
    setting = Setting(seed=seed, clock=CLOCK, cell=cell, faults=faults or ())
    with open_workplace(config, load_parts(), setting=setting, log=trace) as workplace:
        observer = None if watch is None else watch(workplace)
        choices = RunOptions(seed=seed, clock=CLOCK, **options)
        result = run_at(workplace, domain, chosen, config, choices, trace, observer)
        return result, dict(workplace.cell.truth.seated)


def outcomes(trace: Path) -> list[tuple[str, str, str]]:
    return [
        (row["name"], row["status"], row.get("reason", ""))
        for cycle in read_trace(trace).cycles
        for row in cycle["outcomes"]
        if row["status"] != "running"
    ]


@pytest.mark.robot
@pytest.mark.parametrize(
    ("task", "seated"),
    [
        ("1.3", {"casingtop-1": "case-1"}),
        ("1.4", {"plug-1": "case-1"}),
        ("2.2", {"input-1": "case-1", "output-1": "case-1", "transfer-1": "case-1"}),
    ],
)
def test_a_task_is_done_in_truth_as_well(gearbox: Path, tmp_path: Path, task, seated):
    trace = tmp_path / "run.jsonl"
    result, truth = run(gearbox, trace, task)
    assert result.achieved, result.reason
    assert truth == seated
    again = replay(Recording(trace))
    assert again.beliefs is None, again
    assert again.decisions is None, again


@pytest.mark.robot
def test_what_a_person_does_is_seen_where_nobody_tells(gearbox: Path, tmp_path: Path):
    silent = CellParameters(person=PersonParameters(reports=False))
    trace = tmp_path / "run.jsonl"
    result, truth = run(gearbox, trace, "2.2", cell=silent)
    assert result.achieved, result.reason
    assert set(truth) == {"input-1", "output-1", "transfer-1"}
    assert "put-in" not in {name for name, _, _ in outcomes(trace)}


@pytest.mark.robot
def test_a_part_that_was_taken_out_again_is_fetched_again(gearbox: Path, tmp_path: Path):
    meddling = PersonParameters(
        acts=(Act("put-back", ("hubcover-1", "0.38", "-0.25"), when="inserted"),), reports=False
    )
    trace = tmp_path / "run.jsonl"
    result, truth = run(gearbox, trace, "1.1", cell=CellParameters(person=meddling))
    withdrawn = [row for cycle in read_trace(trace).cycles for row in cycle.get("withdrawn", [])]
    assert result.achieved, result.reason
    assert truth == {"hubcover-1": "case-1"}
    assert any(row["belief"] == "(attached hubcover case)" for row in withdrawn), withdrawn


@pytest.mark.robot
def test_a_part_that_slips_is_picked_up_again(gearbox: Path, tmp_path: Path):
    trace = tmp_path / "run.jsonl"
    slippery = CellParameters(mishaps=Mishaps(slip_rate=0.5))
    result, truth = run(gearbox, trace, "1.2", seed=1, cell=slippery)
    assert result.achieved == (truth.get("input-1") == "case-1"), result.reason
    told = outcomes(trace)
    assert any("no longer feels" in reason for _, _, reason in told), told


@pytest.mark.robot
def test_at_the_operators_word_the_task_goes_on_after_a_stop(gearbox: Path, tmp_path: Path):
    trace = tmp_path / "run.jsonl"
    asked: list[str] = []

    def operator(reason: str) -> bool:
        asked.append(reason)
        return True

    stop = [{"fault": "protective_stop", "when": {"travel_rad": 4.0}}]
    result, truth = run(gearbox, trace, "1.1", faults=stop, operator=operator)
    assert result.achieved, result.reason
    assert truth == {"hubcover-1": "case-1"}
    assert len(result.recoveries) == 1
    assert "protective stop" in asked[0]


@pytest.mark.robot
def test_a_run_that_was_killed_goes_on_from_its_trace(gearbox: Path, tmp_path: Path):
    trace = tmp_path / "run.jsonl"
    command = [sys.executable, "-m", "runtime.cli", "run", str(gearbox), "--task", "1.1"]
    command += ["--trace", str(trace), "--clock", str(CLOCK), "--seed", "4"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if "(pick-up hand1 hubcover) succeeded" in line:
                process.send_signal(signal.SIGKILL)
                break
    before = len(read_trace(trace).cycles)
    status, out, err = icarus("run", gearbox, "--resume", trace, "--clock", CLOCK)
    assert status == 0, out + err
    rows = read_trace(trace).cycles
    assert [row["cycle"] for row in rows] == list(range(len(rows)))
    assert [row["cycle"] for row in rows if row.get(RESUMED)] == [before]
    assert replay(Recording(trace)).decisions is None
    assert not trace.with_suffix(".cell.json").exists()


def test_a_run_needs_a_task_or_a_trace(gearbox: Path, tmp_path: Path):
    status, out, err = icarus("run", gearbox)
    assert (status, out) == (2, "")
    assert "say which task to run: --task NAME" in err
    status, _, err = icarus("run", gearbox, "--resume", "a.jsonl", "--trace", "b.jsonl")
    assert status == 2
    assert "leave --trace out" in err
    status, _, err = icarus("run", gearbox, "--resume", tmp_path / "none.jsonl")
    assert status == 2
    assert "none.jsonl" in err


def test_a_trace_without_its_cell_is_refused_before_anything_starts(gearbox: Path, tmp_path: Path):
    domain = load_domain(gearbox)
    trace = tmp_path / "run.jsonl"
    TraceWriter(trace, header(domain, [], task="9.9", robot="ur5", seed=0)).close()
    status, _, err = icarus("run", gearbox, "--resume", trace)
    assert status == 2
    assert "no task 9.9" in err


@pytest.mark.parametrize(
    ("text", "words"),
    [("- fault: earthquake\n", "earthquake"), ("faults: [", "YAML"), ("{}", "list of faults")],
)
def test_a_wrong_schedule_of_faults_is_refused(gearbox: Path, tmp_path: Path, text, words):
    path = tmp_path / "faults.yaml"
    path.write_text(text, encoding="utf-8")
    status, _, err = icarus("run", gearbox, "--task", "1.1", "--faults", path)
    assert status == 2
    assert "faults.yaml" in err
    assert words in err
