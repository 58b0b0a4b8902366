"""`icarus repl`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.cli.app import BAD_INPUT, HOLDS, app, load
from runtime.errors import UsageError

if TYPE_CHECKING:
    from runtime.repl import Session


@app.command(
    epilog="Example: icarus repl run.jsonl",
)
def repl(
    file: Annotated[
        Path,
        typer.Argument(
            help="A trace, to ask about; or a domain file, to run it.", metavar="FILE|TRACE.jsonl"
        ),
    ],
    task: Annotated[
        str | None, typer.Option(help="Of a domain: the task whose goals to pursue.")
    ] = None,
    goal: Annotated[
        str | None,
        typer.Option(help="Of a domain: the goal, '((attached hubcover case))'."),
    ] = None,
    frames: Annotated[
        Path | None, typer.Option(help="Of a domain: recorded frames that the cycles perceive.")
    ] = None,
    *,
    cell: Annotated[
        bool, typer.Option("--cell", help="Of a domain: run the task in the simulated cell.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the cell and its detector's noise.")] = 0,
) -> None:
    """Ask about a run, and go through it: why, why not, when; step, back, until; assume, what-if.

    On a trace it answers from the record. On a domain it runs live: percepts are typed or loaded,
    and every cycle can be asked about in the same words. Commands may come from a pipe.
    """
    from runtime.repl.reading import converse

    if _is_trace(file):
        session = _of_trace(file)
    elif cell:
        session = _of_cell(file, task, seed)
    else:
        session = _of_domain(file, task, goal, frames)
    try:
        well = converse(session)
    finally:
        session.close()
    raise typer.Exit(HOLDS if well else BAD_INPUT)


def _is_trace(file: Path) -> bool:
    return file.suffix == ".jsonl"


def _of_trace(file: Path) -> Session:
    from icarus_lite.trace import Recording
    from runtime.repl import Session

    recording = Recording(file)
    if recording.warning:
        typer.echo(recording.warning, err=True)
    session = Session(recording)
    if len(recording):
        session.go_to(recording.cycles[-1])
    return session


def _of_domain(file: Path, task: str | None, goal: str | None, frames: Path | None) -> Session:
    from icarus_lite import Agent
    from icarus_lite.inference import given_percepts
    from icarus_lite.trace import Recording, header
    from runtime.cli.starting import find_task
    from runtime.repl import Session, TypedRun

    if task is not None and goal is not None:
        raise UsageError("say what to pursue once: either --task NAME or --goal '((…))'")
    domain = load(file)
    chosen = None if task is None else find_task(domain, task)
    init = () if chosen is None else chosen.init
    goals = chosen.goals if chosen is not None else (() if goal is None else (goal,))
    others = None if chosen is None else chosen.agents
    agent = Agent(domain, goals, given=init, others=others)
    run = TypedRun(agent, given_percepts(domain, init))
    if frames is not None:
        run.load(frames)
    recording = Recording(header(domain, agent.goals, given=init))
    recording.use(domain)
    return Session(recording, run, file)


def _of_cell(file: Path, task: str | None, seed: int) -> Session:
    from contextlib import ExitStack

    from icarus_lite import Agent
    from icarus_lite.trace import Recording, header
    from runtime.config import load_robot
    from runtime.parts import load_parts
    from runtime.repl import CellRun, Session
    from runtime.run import (
        DEFAULT_CLOCK,
        DEFAULT_ROBOT,
        RunOptions,
        anchoring_parameters,
        find_task,
        loop_at,
    )
    from runtime.workplace import Setting, open_workplace

    if task is None:
        raise UsageError("say which task to run in the cell: --task NAME")
    domain = load(file)
    chosen = find_task(domain, task)
    config = load_robot(chosen.robot or DEFAULT_ROBOT)
    agent = Agent(domain, chosen.goals, given=chosen.init, others=chosen.agents)
    parameters = anchoring_parameters()
    with ExitStack() as stack:
        place = stack.enter_context(
            open_workplace(config, load_parts(), setting=Setting(seed=seed, clock=DEFAULT_CLOCK))
        )
        stack.callback(place.driver.stop)
        run = CellRun(
            agent,
            place.words,
            lambda observer: loop_at(place, agent, config, parameters, RunOptions(), [observer]),
            stack.pop_all().close,
        )
    recording = Recording(header(domain, agent.goals, given=chosen.init, task=task, seed=seed))
    recording.use(domain)
    return Session(recording, run, file)
