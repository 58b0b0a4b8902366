"""`icarus infer`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from icarus_lite import FrameError, InferenceError
from runtime.cli.app import DomainFile, app, load, sink


@app.command(
    epilog="Example: icarus infer domains/gearbox.icr --frames recorded.jsonl --out beliefs.jsonl",
)
def infer(
    file: DomainFile,
    frames: Annotated[Path, typer.Option(help="Recorded percepts and actions, one cycle a line.")],
    out: Annotated[
        Path | None, typer.Option(help="Where to write; standard output if left out.")
    ] = None,
    max_beliefs: Annotated[
        int, typer.Option(help="How many beliefs one concept may have.", min=1)
    ] = 5_000_000,
    max_seconds: Annotated[float, typer.Option(help="How long one cycle may take.", min=0)] = 30.0,
) -> None:
    """Infer the beliefs of each recorded cycle."""
    from icarus_lite.inference import Budget, InferenceEngine, Memory
    from icarus_lite.trace import beliefs_line, read_frames

    engine = InferenceEngine(load(file), budget=Budget(max_beliefs, max_seconds))
    memory = Memory()
    with sink(out) as lines:
        for frame in read_frames(frames):
            try:
                memory = engine.step(memory, frame.percepts, frame.outcomes)
            except FrameError as error:
                raise FrameError(error.message, path=str(frames), line=frame.line) from None
            except InferenceError as error:
                raise InferenceError(f"{frames}:{frame.line}: {error}") from None
            for note in memory.state.notes:
                typer.echo(f"{frames}:{frame.line}: {note}", err=True)
            lines.write(beliefs_line(frame.cycle, memory.state.beliefs) + "\n")
            lines.flush()
