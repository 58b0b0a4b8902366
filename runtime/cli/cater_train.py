"""`icarus cater train`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.cater import cater


@cater.command(
    epilog="Example: icarus cater train --model opnet-aa --data data/made --out own.safetensors",
)
def train(
    *,
    model: Annotated[str, typer.Option(help="opnet, opnet-aa, opnet-mlp, baseline-lstm, …")],
    data: Annotated[
        Path, typer.Option(help="A split's folder, or one that holds train/ and dev/.")
    ],
    out: Annotated[Path, typer.Option(help="Where the network goes, a .safetensors file.")],
    config: Annotated[
        str, typer.Option(help="published, practical, practical-aa, or a YAML file.")
    ] = "published",
    dev: Annotated[
        Path | None, typer.Option(help="The dev split; the last tenth of DATA if there is none.")
    ] = None,
    begin_with: Annotated[
        Path | None, typer.Option(help="A trained network to begin with.")
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on with what was interrupted.")
    ] = False,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same network.")] = 0,
    threads: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Of the processor; all cores if left out.")
    ] = None,
    domain: Annotated[
        Path | None, typer.Option(help="Says which actions attach; cater.icr if left out.")
    ] = None,
) -> None:
    """Train a network that follows the snitch, and keep the best on the dev split.

    The first time, the data set is read into arrays in its folder. Beside OUT lie the curve, a
    line an epoch, and what it takes to go on after an interruption. Needs the extra [neural].
    """
    from rich.console import Console

    from aapa.neural.extra import require_torch

    require_torch()
    import torch

    from runtime.cater.training import Listener, Order
    from runtime.cater.training import train as trained
    from runtime.cater.training_bar import TrainingBar

    if threads is not None:
        torch.set_num_threads(threads)
    order = Order(model, data, out, dev, config, seed, begin_with, domain, resume)
    with TrainingBar(Console(stderr=True)) as bar:
        progress = trained(order, Listener(bar.prepared, bar.began, bar.updated, bar.scored))
    best = progress.best
    assert best is not None
    typer.echo(f"{out}: {model} after epoch {best.epoch}, dev mIoU {best.score:.2f} %")
