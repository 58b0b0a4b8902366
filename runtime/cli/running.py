"""`icarus run`."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.cli.app import DOES_NOT_HOLD, HOLDS, DomainFile, Json, app, load
from runtime.errors import UsageError

if TYPE_CHECKING:
    from rich.console import Console

    from runtime.people import Operator


@app.command(
    epilog="Example: icarus run domains/gearbox.icr --task 1.1 --seed 3 --trace run.jsonl",
)
def run(  # noqa: PLR0913 - options
    file: DomainFile,
    task: Annotated[
        str | None, typer.Option(help="The task's name, such as 1.1; not needed to resume.")
    ] = None,
    robot: Annotated[
        str | None,
        typer.Option(help="A robot's name or its YAML file; the task's own if left out."),
    ] = None,
    address: Annotated[
        str | None, typer.Option(help="A controller's host; a stand-in is started if left out.")
    ] = None,
    *,
    live: Annotated[bool, typer.Option("--live", help="Let a real arm move.")] = False,
    recover: Annotated[
        bool,
        typer.Option(
            "--recover",
            help="Set the arm going again after it was stopped or lost, without asking each time.",
        ),
    ] = False,
    resume: Annotated[
        Path | None, typer.Option(help="Go on with the run of this trace, which was cut off.")
    ] = None,
    no_attachments: Annotated[
        bool, typer.Option("--no-attachments", help="Anchor without the attachment hierarchy.")
    ] = False,
    unreported: Annotated[
        bool, typer.Option("--unreported", help="The person tells nothing of what they do.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the scene and the detector's noise.")] = 0,
    trace: Annotated[
        Path | None, typer.Option(help="The trace file; a new one under traces/ if left out.")
    ] = None,
    clock: Annotated[
        float, typer.Option(min=0.1, max=20, help="Robot seconds per second of the stand-in.")
    ] = 4.0,
    faults: Annotated[
        Path | None, typer.Option(help="A YAML file: what goes wrong with the stand-in, and when.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Run a task to its end, in the simulated cell on a stand-in controller unless told otherwise.

    Ends with status 0 when the goal is believed, and is still believed after a second look; with
    1 and the reason when it is not.
    """
    from rich.console import Console

    from runtime.cell import CellParameters, PersonParameters
    from runtime.resuming import task_of
    from runtime.run import RunOptions, run_task
    from runtime.view import RunView

    if resume is not None and trace is not None:
        raise UsageError("--resume goes on with its own trace: leave --trace out")
    if task is None:
        if resume is None:
            raise UsageError("say which task to run: --task NAME")
        task = task_of(resume)
    domain = load(file)
    console = Console()
    options = RunOptions(
        robot=robot,
        address=address,
        live=live,
        attachments=not no_attachments,
        seed=seed,
        trace=trace,
        clock=clock,
        resume=resume,
        operator=_operator(console, always=recover, never=as_json),
        cell=CellParameters(person=PersonParameters(reports=not unreported)),
        faults=() if faults is None else _schedule(faults),
    )
    if as_json:
        result = run_task(domain, task, options)
        typer.echo(json.dumps(result.to_json(), ensure_ascii=False))
    else:
        with RunView(console, f"task {task} of {domain.name}, seed {seed}") as view:
            result = run_task(domain, task, options, view.show, view.announce)
        word = "achieved" if result.achieved else "failed"
        console.print(
            f"task {result.task} {word} after {result.cycles} cycles: {result.reason}",
            style="bold green" if result.achieved else "bold red",
            highlight=False,
            soft_wrap=True,
        )
        console.print(f"trace: {result.trace}", highlight=False, soft_wrap=True)
    raise typer.Exit(HOLDS if result.achieved else DOES_NOT_HOLD)


def _schedule(path: Path) -> Sequence[Mapping[str, object]]:
    """Read what goes wrong, and when; a mistake in the file is told here, with its name."""
    import yaml

    from runtime.controller.faults import load_faults

    load_faults(path)
    content: Sequence[Mapping[str, object]] = yaml.safe_load(path.read_text(encoding="utf-8"))
    return content or ()


def _operator(console: Console, *, always: bool, never: bool) -> Operator | None:
    """Give whose word sets the arm going again: the person's, given now or when it is needed."""
    if always:
        return lambda _reason: True
    if never or not console.is_terminal:
        return None

    def ask(reason: str) -> bool:
        console.print(f"the arm has stopped: {reason}", style="bold red", highlight=False)
        return typer.confirm("Is it safe to set it going again?", default=False)

    return ask
