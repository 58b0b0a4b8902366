"""One run, from an empty table to a row of figures."""

from __future__ import annotations

import itertools
import os
import resource
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final

from gearbox.endings import ending
from gearbox.faults import plan_of, signs_of, true_reasons
from gearbox.judging import Judge, Verdict
from gearbox.killing import run_and_kill
from gearbox.operating import Operator, last_words
from gearbox.plans import Plan
from gearbox.rows import GOOD, ROOT, Ending, Row, Trace, code_digest
from gearbox.safety import Witness, struck, travels, unsafe
from gearbox.trials import TASKS, Trial
from icarus_lite import IcarusError, load_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.trace import Recording, replay
from runtime.cell import CellParameters, Mishaps, PersonParameters
from runtime.config import RobotConfig, load_robot
from runtime.controller.ports import BUSY
from runtime.controller.process import ControllerProcess
from runtime.errors import ControllerError, RuntimeFault
from runtime.parts import load_parts
from runtime.percepts import HAND
from runtime.resuming import read_cut_off, read_world
from runtime.run import RunOptions, find_task, run_at
from runtime.workplace import Setting, open_workplace

DOMAIN: Final = ROOT / "domains" / "gearbox.icr"
_NET: Final = 77
_KILL_WITHIN_S: Final = 60.0
_ADDRESSES: Final = 250


@dataclass(frozen=True, slots=True)
class Desk:
    """Where runs are carried out.

    Args:
        folder: For traces and logs.
        keep: Whether the files of runs that ended well are kept too.
    """

    folder: Path
    keep: bool = False

    def __call__(self, trial: Trial, number: int) -> Row:
        """Carry a run out at the desk of a number; see `carry_out`."""
        return carry_out(trial, number, self)


@dataclass(slots=True)
class _Course:
    """What came of a run, as far as it came."""

    verdict: Verdict | None = None
    achieved: bool = False
    reason: str = ""
    cycles: int = 0
    broken: bool = False
    recoveries: tuple[str, ...] = ()
    killed: bool = False
    unsafe: tuple[str, ...] = ()
    travels: tuple[tuple[str, float], ...] = ()
    struck: tuple[str, ...] = ()
    travel_rad: float = 0.0
    wall_s: float = 0.0
    cpu_s: float = 0.0


def carry_out(trial: Trial, number: int, desk: Desk) -> Row:
    """Run a trial, judge it, read its trace again, and give its row. Never raises.

    Args:
        trial: The run.
        number: Of the desk: each has loopback addresses of its own.
        desk: Where its files go.
    """
    load = os.getloadavg()[0]
    desk.folder.mkdir(parents=True, exist_ok=True)
    path = desk.folder / f"{trial.key}.jsonl"
    _clear(desk, trial)
    began, cpu = time.perf_counter(), _processor_s()
    course = _Course()
    try:
        _run(trial, number, path, course)
    except (IcarusError, RuntimeFault) as error:  # refused with a sentence: a proper end
        course.reason = str(error)
    except Exception:  # noqa: BLE001 - told in the row, which is then a broken one
        course.reason, course.broken = traceback.format_exc(limit=-6), True
    course.wall_s = time.perf_counter() - began
    course.cpu_s = _processor_s() - cpu
    row = _row(trial, course, trace_of(path), load)
    if not desk.keep and row.ending in GOOD and not row.unsafe and not row.trace.damage:
        _clear(desk, trial)
    return row


def _clear(desk: Desk, trial: Trial) -> None:
    """Remove what there is of a run: trace, logs, the cell as it was left."""
    for file in desk.folder.glob(f"{trial.key}.*"):
        file.unlink()


def _run(trial: Trial, number: int, path: Path, course: _Course) -> None:
    """Carry a run out, and note what came of it even where it raises."""
    plan, config = plan_of(trial), load_robot(TASKS[trial.task].robot)
    with _controller(trial, number, path, plan, config) as controller:
        operator = Operator(controller, willing=plan.willing)
        person = plan.person or PersonParameters()
        cell = CellParameters(mishaps=Mishaps(**plan.mishaps), person=person)
        options = RunOptions(
            attachments=trial.attachments,
            seed=trial.seed,
            clock=trial.clock,
            cell=cell,
            operator=operator,
        )
        try:
            course.killed = _kill(trial, path, controller.address, plan)
            _take_part(trial, config, controller, options, path, course)
        finally:
            _hear_witnesses(controller, config, operator, trial, course)


def _kill(trial: Trial, path: Path, address: str, plan: Plan) -> bool:
    if not plan.kill_after:
        return False
    return run_and_kill(trial, DOMAIN, path, address, plan.kill_after, _KILL_WITHIN_S)


def _take_part(
    trial: Trial,
    config: RobotConfig,
    controller: ControllerProcess,
    options: RunOptions,
    path: Path,
    course: _Course,
) -> None:
    """Run the task from its beginning, or from where it was killed, with the judge beside."""
    domain, setting = _domain(), Setting(seed=trial.seed, clock=trial.clock, cell=options.cell)
    task, cut_off = find_task(domain, trial.task), None
    if course.killed:
        cut_off = read_cut_off(path, domain, task.name, config.model)
        if cut_off.joints is not None:
            setting = replace(
                setting,
                joints=cut_off.joints,
                gripper_closed=cut_off.gripper_closed,
                world=read_world(path),
            )
    with open_workplace(
        config, load_parts(), address=controller.address, setting=setting, log=path
    ) as workplace:
        judge = Judge(TASKS[trial.task], workplace.cell.truth, HAND)
        try:
            result = run_at(workplace, domain, task, config, options, path, judge, cut_off)
        finally:
            course.verdict = judge.verdict()
        course.achieved, course.reason = result.achieved, result.reason
        course.cycles, course.recoveries = result.cycles, result.recoveries


def _hear_witnesses(
    controller: ControllerProcess,
    config: RobotConfig,
    operator: Operator,
    trial: Trial,
    course: _Course,
) -> None:
    """Ask the controller and the operator what happened, once everybody has let go of the arm."""
    journal, state = last_words(controller, ended=True)
    witness = Witness(journal, state, operator.notices, trial.clock)
    course.unsafe = unsafe(witness, config)
    course.travels = travels(witness)
    course.travel_rad = float(journal.get("travel_rad", 0.0))
    events = [] if course.verdict is None else [*course.verdict.events]
    events += ["killed"] * course.killed + ["the controller ended"] * (not controller.alive)
    course.struck = (*struck(journal), *signs_of(trial, events))


def _controller(
    trial: Trial, number: int, path: Path, plan: Plan, config: RobotConfig
) -> ControllerProcess:
    """Start a controller at an address that nobody has used lately.

    A fresh controller for each run, and a fresh address: what is left of the run before, such as
    a client that tries to connect again, must not meet it.
    """
    refusal: ControllerError | None = None
    for _ in range(_ADDRESSES):
        try:
            return ControllerProcess.start(
                config.model,
                address=next(_addresses(number)),
                clock=trial.clock,
                joints=config.look_joints,
                log=path.with_suffix(".controller.log"),
                faults=plan.controller,
                seed=trial.seed,
            )
        except ControllerError as error:
            refusal = error
            if BUSY not in str(error):
                break
    assert refusal is not None
    raise refusal


@cache
def _addresses(number: int) -> Iterator[str]:
    """Give the addresses of a desk, in turn."""
    return itertools.cycle(f"127.{_NET}.{number}.{last}" for last in range(2, 2 + _ADDRESSES))


@cache
def _domain() -> Domain:
    return load_domain(DOMAIN)


_code = cache(code_digest)


def trace_of(path: Path) -> Trace:
    """Read a run's trace again and replay it: the agent must come to the very same cycles."""
    if not path.exists():
        return Trace()
    try:
        recording = Recording(path)
        again = replay(recording)
    except IcarusError as error:
        return Trace(0, str(error))
    first = again.beliefs or again.decisions
    return Trace(len(recording), recording.warning or ("" if first is None else str(first)))


def _processor_s() -> float:
    """Give the processor time of this process and of all that it has started and that ended, s."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(each.ru_utime + each.ru_stime for each in used)


def _row(trial: Trial, course: _Course, trace: Trace, load: float) -> Row:
    verdict = course.verdict
    row = Row(
        trial,
        _ending(trial, course),
        achieved=course.achieved,
        true=verdict is not None and verdict.true,
        reason=course.reason,
        struck=course.struck,
        recoveries=course.recoveries,
        cycles=course.cycles,
        wall_s=round(course.wall_s, 3),
        cpu_s=round(course.cpu_s, 3),
        travel_rad=round(course.travel_rad, 3),
        travels=course.travels,
        unsafe=course.unsafe,
        trace=trace,
        load=round(load, 2),
        code=_code(),
    )
    if verdict is None:
        return row
    return replace(
        row,
        troubles=verdict.troubles,
        withdrawn=verdict.withdrawn,
        actions=verdict.actions,
        robot_s=round(verdict.robot_s, 3),
        false_at_end=verdict.false_at_end,
        episodes=verdict.episodes,
        places=verdict.places,
    )


def _ending(trial: Trial, course: _Course) -> Ending:
    if course.broken:
        return Ending.BROKEN
    verdict = course.verdict
    return ending(
        achieved=course.achieved,
        true=verdict is not None and verdict.true,
        troubled=bool(course.recoveries)
        or (verdict is not None and bool(verdict.troubles or verdict.withdrawn)),
        reason=course.reason,
        reasons=true_reasons(trial, () if verdict is None else verdict.away),
    )
