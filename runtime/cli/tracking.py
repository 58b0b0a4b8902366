"""`icarus track`."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.app import app, load, sink


@app.command(
    epilog="Example: icarus track --detections seen.jsonl --domain domains/cater.icr --tau 6500",
)
def track(
    detections: Annotated[
        Path, typer.Option(help="Recorded detections and actions, one frame a line.")
    ],
    domain: Annotated[
        Path | None, typer.Option(help="Says which actions attach what; without it, none do.")
    ] = None,
    tau: Annotated[
        float | None,
        typer.Option(help="Squared px up to which a detection is still the same object: 6500."),
    ] = None,
    anchoring: Annotated[
        Path | None, typer.Option(help="YAML with more of the anchoring's parameters.")
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Where to write; standard output if left out.")
    ] = None,
) -> None:
    """Anchor recorded detections: where every object is, seen or hidden, frame by frame."""
    from aapa.jsonl import anchors_line, read_frames
    from runtime.tracking import read_parameters
    from runtime.tracking import track as anchored

    parameters = read_parameters(anchoring, tau)
    rules = None if domain is None else load(domain)
    with sink(out) as lines:
        for frame, anchors in anchored(
            read_frames(detections), parameters, rules, partial(typer.echo, err=True)
        ):
            lines.write(anchors_line(frame, anchors) + "\n")
            lines.flush()
