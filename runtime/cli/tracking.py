"""`icarus track`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from runtime.cli.app import app, load, sink

if TYPE_CHECKING:
    from aapa.anchors import Anchor
    from aapa.formats import OutputFormat
    from aapa.jsonl import RecordedFrame


@app.command(
    epilog="Example: icarus track --detections seen.jsonl --domain domains/cater.icr --tau 6500",
)
def track(  # noqa: PLR0913 - each is an option
    detections: Annotated[
        Path,
        typer.Option(
            help="Recorded detections: JSON Lines, one frame a line, with actions; MOT Challenge "
            "text (.txt, .csv); or COCO results (.json)."
        ),
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
    from_: Annotated[
        Literal["jsonl", "mot", "coco"] | None,
        typer.Option("--from", help="The recording's format, if its name does not tell."),
    ] = None,
    to: Annotated[
        Literal["jsonl", "mot"] | None,
        typer.Option(help="What to write: jsonl, or mot, which --out FILE.txt stands for too."),
    ] = None,
    images: Annotated[
        Path | None,
        typer.Option(help="For COCO results: the file with the images and categories."),
    ] = None,
    object_type: Annotated[
        str, typer.Option("--type", help="For MOT text, which has none: the type of all objects.")
    ] = "object",
    min_score: Annotated[
        float, typer.Option(help="Leave out detections of a lower score.", min=0.0, max=1.0)
    ] = 0.0,
    *,
    visible_only: Annotated[
        bool, typer.Option("--visible-only", help="Leave out what is not seen in a frame.")
    ] = False,
    reasons: Annotated[
        bool, typer.Option("--reasons", help="Tell of each anchor why it is believed to be there.")
    ] = False,
    skip_malformed: Annotated[
        bool,
        typer.Option("--skip-malformed", help="Pass malformed parts over, and count them."),
    ] = False,
) -> None:
    """Anchor recorded detections: where every object is, seen or hidden, frame by frame.

    MOT text counts frames and pixels from 1, JSON Lines and this program from 0: each is
    written and read as its format demands.
    """
    from aapa.formats import InputFormat, OutputFormat, read_recording
    from aapa.formats.refusals import Skipped, refuse
    from runtime.tracking import read_parameters
    from runtime.tracking import track as anchored

    parameters = read_parameters(anchoring, tau)
    rules = None if domain is None else load(domain)
    skipped = Skipped()
    frames = read_recording(
        detections,
        None if from_ is None else InputFormat(from_),
        images=images,
        type_name=object_type,
        refused=skipped if skip_malformed else refuse,
    )
    lines_of = _lines_of(None if to is None else OutputFormat(to), out, reasons=reasons)
    note = partial(typer.echo, err=True)
    with sink(out) as lines:
        for frame, anchors in anchored(_scored(frames, min_score), parameters, rules, note):
            shown = [anchor for anchor in anchors if not visible_only or anchor.status == "visible"]
            for line in lines_of(frame, shown):
                lines.write(line + "\n")
            lines.flush()
    if skipped.count:
        note(skipped.report("part"))


def _lines_of(
    to: OutputFormat | None, out: Path | None, *, reasons: bool
) -> Callable[[int, Iterable[Anchor]], list[str]]:
    """Give what turns the anchors of a frame into lines."""
    from aapa.formats import InputFormat, MotWriter, OutputFormat, guess_format
    from aapa.jsonl import anchors_line
    from runtime.errors import UsageError

    if to is None:
        mot = out is not None and guess_format(out) is InputFormat.MOT
        to = OutputFormat.MOT if mot else OutputFormat.JSONL
    if to is OutputFormat.MOT:
        if reasons:
            raise UsageError("MOT text has no place for reasons; write JSON Lines, with --to jsonl")
        return MotWriter().lines
    return lambda frame, anchors: [anchors_line(frame, anchors, reasons=reasons)]


def _scored(frames: Iterable[RecordedFrame], least: float) -> Iterable[RecordedFrame]:
    """Leave out what scores too low; a body that reports its own place always counts."""
    for frame in frames:
        kept = tuple(d for d in frame.detections if d.score >= least or d.name is not None)
        yield frame if len(kept) == len(frame.detections) else replace(frame, detections=kept)
