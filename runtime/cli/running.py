"""`icarus run` and `icarus controller`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.app import DOES_NOT_HOLD, HOLDS, DomainFile, Json, app, load


@app.command(
    epilog="Example: icarus run domains/gearbox.icr --task 1.1 --seed 3 --trace run.jsonl",
)
def run(
    file: DomainFile,
    task: Annotated[str, typer.Option(help="The task's name, such as 1.1.")],
    robot: Annotated[
        str | None,
        typer.Option(help="A robot's name or its YAML file; the task's own if left out."),
    ] = None,
    address: Annotated[
        str | None, typer.Option(help="A controller's host; a stand-in is started if left out.")
    ] = None,
    *,
    live: Annotated[bool, typer.Option("--live", help="Let a real arm move.")] = False,
    no_attachments: Annotated[
        bool, typer.Option("--no-attachments", help="Anchor without the attachment hierarchy.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="Of the scene and the detector's noise.")] = 0,
    trace: Annotated[
        Path | None, typer.Option(help="The trace file; a new one under traces/ if left out.")
    ] = None,
    clock: Annotated[
        float, typer.Option(min=0.1, max=20, help="Robot seconds per second of the stand-in.")
    ] = 4.0,
    as_json: Json = False,
) -> None:
    """Run a task to its end, in the simulated cell on a stand-in controller unless told otherwise.

    Ends with status 0 when the goal is believed, and is still believed after a second look; with
    1 and the reason when it is not.
    """
    from rich.console import Console

    from runtime.run import RunOptions, run_task
    from runtime.view import RunView

    domain = load(file)
    options = RunOptions(
        robot=robot,
        address=address,
        live=live,
        attachments=not no_attachments,
        seed=seed,
        trace=trace,
        clock=clock,
    )
    if as_json:
        result = run_task(domain, task, options)
        typer.echo(json.dumps(result.to_json(), ensure_ascii=False))
    else:
        console = Console()
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


@app.command(
    epilog="Example: icarus controller --model ur5 --address 127.0.0.2",
)
def controller(
    model: Annotated[str, typer.Option(help="ur5 or ur16e.")] = "ur5",
    address: Annotated[str, typer.Option(help="A loopback address.")] = "127.0.0.2",
    clock: Annotated[float, typer.Option(min=0.1, max=20, help="Robot seconds per second.")] = 1.0,
) -> None:
    """Run the stand-in UR controller alone, for ur-rtde programs. Not a robot; Ctrl-C ends it."""
    from runtime.controller.__main__ import main as serve

    raise typer.Exit(serve(["--model", model, "--address", address, "--clock", str(clock)]))
