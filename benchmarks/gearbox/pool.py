"""Many runs over several processes, one loopback address each.

Runs are meant to go wrong: clients hang, controllers die. So each process is given its runs one by
one through a pipe; one that does not answer in time, or ends, is replaced, and the run it was at is
told as broken.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import TypeAlias

from gearbox.rows import Ending, Row
from gearbox.trials import Trial

Desk: TypeAlias = int
"""The number of a process, from 0: what it derives its loopback address from."""

Runner: TypeAlias = Callable[[Trial, Desk], Row]

_FAREWELL_S = 5.0


@dataclass(slots=True)
class _Worker:
    """A process, the pipe to it, and what it is at."""

    desk: Desk
    process: BaseProcess
    pipe: Connection
    trial: Trial | None = None
    deadline: float = field(default=float("inf"))


def run_all(
    wanted: Sequence[Trial],
    runner: Runner,
    jobs: int,
    limit_s: Callable[[Trial], float],
) -> Iterator[Row]:
    """Carry runs out, several at a time, and give their rows as they come.

    Args:
        wanted: The runs, in the order in which they are begun.
        runner: Carries one out, in one of the processes; it can be pickled.
        jobs: How many at a time, at least 1.
        limit_s: How long a run may take, s of wall time; one that takes longer is broken off.

    Yields:
        A row for each run, broken ones included.
    """
    waiting = deque(wanted)
    workers = [_hire(desk, runner) for desk in range(min(jobs, len(waiting)))]
    try:
        for worker in workers:
            _hand_out(worker, waiting, limit_s)
        while busy := [worker for worker in workers if worker.trial is not None]:
            soonest = min(worker.deadline for worker in busy)
            heard = wait([w.pipe for w in busy], max(0.0, soonest - time.monotonic()))
            for place, worker in enumerate(workers):
                if worker.trial is None:
                    continue
                if worker.pipe in heard:
                    row = _answer(worker)
                elif time.monotonic() >= worker.deadline:
                    row = _broken(worker.trial, f"no end within {limit_s(worker.trial):.0f} s")
                else:
                    continue
                yield row
                if row.ending is Ending.BROKEN:
                    _dismiss(worker)
                    workers[place] = _hire(worker.desk, runner)
                _hand_out(workers[place], waiting, limit_s)
    finally:
        for worker in workers:
            _dismiss(worker)


def _hire(desk: Desk, runner: Runner) -> _Worker:
    # Not forked: the threads of numerical libraries do not survive that everywhere.
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_work, args=(theirs, runner, desk), name=f"desk-{desk}")
    process.start()
    theirs.close()
    return _Worker(desk, process, ours)


def _hand_out(worker: _Worker, waiting: deque[Trial], limit_s: Callable[[Trial], float]) -> None:
    worker.trial = waiting.popleft() if waiting else None
    if worker.trial is not None:
        worker.deadline = time.monotonic() + limit_s(worker.trial)
        worker.pipe.send(worker.trial)


def _answer(worker: _Worker) -> Row:
    assert worker.trial is not None
    try:
        answer: Row = worker.pipe.recv()
    except (EOFError, OSError):
        worker.process.join(_FAREWELL_S)
        return _broken(worker.trial, f"its process ended by itself ({worker.process.exitcode})")
    return answer


def _broken(trial: Trial, reason: str) -> Row:
    return Row(trial, Ending.BROKEN, achieved=False, true=False, reason=reason)


def _dismiss(worker: _Worker) -> None:
    """End a process, with all that it has started."""
    worker.pipe.close()
    if worker.trial is None:
        worker.process.join(_FAREWELL_S)
    if worker.process.pid is not None and worker.process.is_alive():
        # Only a process that has made a group of its own: until then its group is ours.
        if os.getpgid(worker.process.pid) == worker.process.pid:
            os.killpg(worker.process.pid, signal.SIGKILL)
        else:
            worker.process.kill()
    worker.process.join(_FAREWELL_S)


def _work(pipe: Connection, runner: Runner, desk: Desk) -> None:
    """Carry out what comes through the pipe, until it closes."""
    os.setpgid(0, 0)
    # Whoever interrupts the experiment ends these processes by closing their pipes.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    while True:
        try:
            trial: Trial = pipe.recv()
        except (EOFError, OSError):
            return
        pipe.send(runner(trial, desk))
