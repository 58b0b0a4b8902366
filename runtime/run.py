"""`run_task`: one task of a domain, from the first look to a clear end."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from importlib.resources import files
from pathlib import Path

import yaml

from aapa import Anchoring, AnchoringParameters
from aapa.assignment import prepare
from icarus_lite import Agent, DomainError
from icarus_lite.language import check_commands
from icarus_lite.language.syntax import Domain, Task
from icarus_lite.trace import TraceWriter, ensure_writable, header
from runtime.cell import CellParameters
from runtime.cell_source import CellColleague, known_actions
from runtime.config import RobotConfig, load_robot
from runtime.cycle_report import CycleReport
from runtime.errors import UsageError
from runtime.loop import Loop, TakenUp
from runtime.parts import load_parts
from runtime.people import Operator, People
from runtime.resuming import CutOff, read_cut_off, read_world, world_keeper, world_path
from runtime.run_record import ActionRecord
from runtime.second_look import LoopLimits
from runtime.workplace import Setting, Workplace, open_workplace

DEFAULT_ROBOT = "ur5"
DEFAULT_CLOCK = 4.0
"""Robot seconds per second in a cell that is simulated anyway."""


@dataclass(frozen=True, slots=True)
class RunResult:
    """How a task ended.

    Args:
        task: Its name.
        robot: The robot that ran it.
        achieved: Whether the goal was believed, and went on being believed when looked at again.
        reason: Why, as a sentence.
        recoveries: The reasons for which the arm had stopped and was set going again.
        cycles: How many cycles it took.
        actions: The actions that were started, with the cycle and how they ended.
        trace: The trace file.
    """

    task: str
    robot: str
    achieved: bool
    reason: str
    cycles: int
    actions: tuple[ActionRecord, ...]
    trace: str
    recoveries: tuple[str, ...] = ()

    def to_json(self) -> dict[str, object]:
        """Give the JSON document of `icarus run --json`."""
        return {
            "task": self.task,
            "robot": self.robot,
            "outcome": "achieved" if self.achieved else "failed",
            "reason": self.reason,
            "cycles": self.cycles,
            "actions": [asdict(action) for action in self.actions],
            "trace": self.trace,
            "recoveries": list(self.recoveries),
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """How to run a task.

    Args:
        robot: A robot's name or configuration file; None takes the task's own.
        address: A controller's host; None starts a stand-in.
        live: Whether a real arm may move.
        attachments: False takes the attachment hierarchy from the anchoring (the paper's PA).
        seed: Of scene and noise.
        trace: The trace file; None chooses a new one under `traces/`.
        clock: Robot seconds per second of the stand-in.
        limits: When the loop gives up.
        resume: The trace of a run that was cut off, to be taken up and gone on with.
        operator: Whose word it takes to set the arm going again after it was stopped or lost;
            None: nobody's, the run ends there.
        cell: What the simulated cell is like, person and mishaps included; None for the usual.
        faults: What goes wrong with the stand-in that is started, and when.
    """

    robot: str | None = None
    address: str | None = None
    live: bool = False
    attachments: bool = True
    seed: int = 0
    trace: Path | None = None
    clock: float = DEFAULT_CLOCK
    limits: LoopLimits | None = None
    resume: Path | None = None
    operator: Operator | None = None
    cell: CellParameters | None = None
    faults: Sequence[Mapping[str, object]] = ()


def run_task(
    domain: Domain,
    task: str,
    options: RunOptions | None = None,
    observer: Callable[[CycleReport], None] | None = None,
    announce: Callable[[str], None] | None = None,
) -> RunResult:
    """Run a task of a domain to its end.

    Args:
        domain: A checked domain.
        task: The task's name, such as "1.1".
        options: How to run it.
        observer: Called after every cycle.
        announce: Called once with a sentence that says what arm and what cell this is.

    Raises:
        UsageError: no such task; a skill needs a command that the driver does not offer.
        ConfigError: the robot's configuration is wrong.
        ControllerError: the controller does not start, or nobody answers.
    """
    options = options or RunOptions()
    chosen = find_task(domain, task)
    config = load_robot(options.robot or chosen.robot or DEFAULT_ROBOT)
    cut_off = None
    if options.resume is not None:
        cut_off = read_cut_off(options.resume, domain, chosen.name, config.model)
    path = options.resume or options.trace or _new_trace_path(chosen.name, options.seed)
    ensure_writable(path)
    with open_workplace(
        config,
        load_parts(),
        address=options.address,
        live=options.live,
        setting=_setting(options, cut_off, path),
        log=path,
    ) as workplace:
        if announce is not None:
            announce(workplace.words)
        return run_at(workplace, domain, chosen, config, options, path, observer, cut_off)


def run_at(
    workplace: Workplace,
    domain: Domain,
    task: Task,
    config: RobotConfig,
    options: RunOptions,
    trace: Path,
    observer: Callable[[CycleReport], None] | None = None,
    cut_off: CutOff | None = None,
) -> RunResult:
    """Run a task at a workplace that stands already; otherwise as `run_task`.

    Raises:
        DomainError: a skill needs a command that the driver does not offer.
    """
    missing = check_commands(domain, workplace.driver.commands)
    if missing:
        raise DomainError(missing, domain.source)
    parameters = replace(anchoring_parameters(), use_attachments=options.attachments)
    if cut_off is None:
        agent = Agent(domain, task.goals, given=task.init, others=task.agents, long_term=False)
        first = header(
            domain,
            task.goals,
            given=task.init,
            others=list(task.agents),
            long_term=False,
            task=task.name,
            robot=config.model,
            seed=options.seed,
            workplace=workplace.words,
            anchoring=_plain(asdict(parameters)),
        )
    else:
        agent, first = cut_off.agent, None
    keep = world_keeper(workplace, trace)
    watchers = [keep] if observer is None else [keep, observer]
    with TraceWriter(trace, first) as writer:
        loop = loop_at(workplace, agent, config, parameters, options, watchers, writer, cut_off)
        result = loop.run()
    if result.achieved:
        world_path(trace).unlink(missing_ok=True)  # nobody will want to go on with it
    return RunResult(
        task.name,
        config.model,
        result.achieved,
        result.reason,
        result.cycles,
        result.actions,
        str(trace),
        result.recoveries,
    )


def loop_at(
    workplace: Workplace,
    agent: Agent,
    config: RobotConfig,
    parameters: AnchoringParameters,
    options: RunOptions,
    observers: Sequence[Callable[[CycleReport], None]] = (),
    trace: TraceWriter | None = None,
    cut_off: CutOff | None = None,
) -> Loop:
    """Give the loop that runs an agent at a workplace."""
    prepare()
    anchoring = Anchoring(parameters)
    if cut_off is not None:
        anchoring.state = cut_off.anchoring
    colleague = CellColleague(workplace.cell, workplace.source, known_actions(agent.domain))
    taken_up = None
    if cut_off is not None:
        taken_up = TakenUp(cut_off.anchoring.anchors, cut_off.interrupted)
    return Loop(
        agent,
        anchoring,
        workplace.driver,
        workplace.source,
        config,
        trace=trace,
        observers=observers,
        limits=options.limits,
        people=People(colleague, options.operator),
        taken_up=taken_up,
    )


def _setting(options: RunOptions, cut_off: CutOff | None, trace: Path) -> Setting:
    """Give what the simulated part is like; of a run that was cut off, as it was left."""
    setting = Setting(
        seed=options.seed, clock=options.clock, cell=options.cell, faults=options.faults
    )
    if cut_off is None or cut_off.joints is None:
        return setting
    return replace(
        setting,
        seed=cut_off.seed,
        joints=cut_off.joints,
        gripper_closed=cut_off.gripper_closed,
        world=read_world(trace),
    )


def find_task(domain: Domain, name: str) -> Task:
    """Find a task by its name.

    Raises:
        UsageError: there is none; the message says which there are.
    """
    names = [task.name for task in domain.tasks]
    for task in domain.tasks:
        if task.name == name:
            return task
    close = difflib.get_close_matches(name, names, 1)
    hint = f"; did you mean {close[0]}?" if close else ""
    listed = ", ".join(names) if names else "none"
    raise UsageError(f"{domain.source.path} has no task {name}{hint} (tasks: {listed})")


def anchoring_parameters() -> AnchoringParameters:
    """Read the anchoring parameters of the simulated cell."""
    text = (files("runtime") / "data" / "anchoring.yaml").read_text(encoding="utf-8")
    return AnchoringParameters.from_mapping(yaml.safe_load(text))


def _new_trace_path(task: str, seed: int) -> Path:
    folder = Path("traces")
    stem = f"task-{task}-seed{seed}"
    candidate, number = folder / f"{stem}.jsonl", 2
    while candidate.exists():
        candidate, number = folder / f"{stem}-{number}.jsonl", number + 1
    return candidate


def _plain(values: Mapping[str, object]) -> dict[str, object]:
    return {
        key: sorted(value) if isinstance(value, frozenset) else value
        for key, value in values.items()
    }
