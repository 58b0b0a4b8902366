"""Runs that hang, die or are interrupted cost themselves, and nothing else."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest
from gearbox.pool import run_all
from gearbox.rows import Ending, Row
from gearbox.trials import Trial


def behave(folder, trial, desk):
    """Do what a trial's fault says."""
    started = Path(folder) / f"{trial.seed}-{desk}"
    if trial.fault == "die":
        os._exit(3)
    if trial.fault == "hang":
        child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
        started.write_text(str(child.pid))
        signal.pause()
    started.write_text("")
    return Row(trial, Ending.ACHIEVED, achieved=True, true=True, reason=f"desk {desk}")


def rows(tmp_path, faults, jobs, limit_s=60.0):
    wanted = [Trial("1.1", seed, fault=fault) for seed, fault in enumerate(faults)]
    runner = partial(behave, str(tmp_path))
    return wanted, list(run_all(wanted, runner, jobs, lambda _trial: limit_s))


@pytest.mark.parametrize("jobs", [1, 2])
def test_each_run_has_its_row(tmp_path, jobs):
    wanted, found = rows(tmp_path, ["none"] * 5, jobs)
    assert sorted(row.trial.seed for row in found) == [trial.seed for trial in wanted]
    assert {row.ending for row in found} == {Ending.ACHIEVED}
    assert len({row.reason for row in found}) <= jobs


def test_a_process_that_dies_is_replaced(tmp_path):
    _, found = rows(tmp_path, ["none", "die", "none"], 1)
    assert [row.ending for row in found] == [Ending.ACHIEVED, Ending.BROKEN, Ending.ACHIEVED]
    assert found[1].reason == "its process ended by itself (3)"


def test_a_run_that_hangs_is_broken_off_with_all_it_has_started(tmp_path):
    _, found = rows(tmp_path, ["hang", "none"], 1, limit_s=4.0)
    assert [row.ending for row in found] == [Ending.BROKEN, Ending.ACHIEVED]
    assert found[0].reason == "no end within 4 s"
    child = int((tmp_path / "0-0").read_text())
    deadline = time.monotonic() + 10
    while _is_there(child) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert not _is_there(child)


def test_whoever_stops_listening_ends_the_processes(tmp_path):
    runner = partial(behave, str(tmp_path))
    wanted = [Trial("1.1", seed, fault="none" if seed == 0 else "hang") for seed in range(3)]
    some = run_all(wanted, runner, 1, lambda _trial: 60.0)
    assert next(some).trial.seed == 0
    some.close()
    assert not (tmp_path / "2-0").exists()


def test_no_runs_need_no_processes():
    assert list(run_all([], behave, 2, lambda _trial: 1.0)) == []


def _is_there(process: int) -> bool:
    """Whether a process runs; one that has ended and is not fetched yet does not."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"
