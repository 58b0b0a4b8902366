"""`icarus controller`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.app import app


@app.command(
    epilog="Example: icarus controller --model ur5 --address 127.0.0.2 --faults faults.yaml",
)
def controller(
    model: Annotated[str, typer.Option(help="ur5 (CB3, 125 Hz) or ur16e (e-Series, 500 Hz).")] = (
        "ur5"
    ),
    address: Annotated[str, typer.Option(help="A loopback address.")] = "127.0.0.2",
    clock: Annotated[float, typer.Option(min=0.1, max=20, help="Robot seconds per second.")] = 1.0,
    joints: Annotated[
        str | None,
        typer.Option(help="Where the arm stands at first: six angles with commas, rad."),
    ] = None,
    version: Annotated[
        str | None, typer.Option(help="The PolyScope version to play, such as 5.11.")
    ] = None,
    faults: Annotated[
        Path | None, typer.Option(help="What is to go wrong and when: a YAML file.")
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of what the faults leave to chance.")] = 0,
    journal: Annotated[
        Path | None, typer.Option(help="Write what the controller witnesses, as JSON lines.")
    ] = None,
    log: Annotated[Path | None, typer.Option(help="Write a log of all that happens.")] = None,
) -> None:
    """Run the stand-in UR controller alone, for ur-rtde programs. Not a robot; Ctrl-C ends it."""
    from runtime.controller.__main__ import main as serve

    options = {
        "--joints": joints,
        "--version": version,
        "--faults": faults,
        "--journal": journal,
        "--log": log,
    }
    arguments = ["--model", model, "--address", address, "--clock", str(clock), "--seed", str(seed)]
    # One word each, so that a leading minus is not taken for an option.
    arguments += [f"{name}={value}" for name, value in options.items() if value is not None]
    raise typer.Exit(serve(arguments))
