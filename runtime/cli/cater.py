"""`icarus cater …`: LA-CATER data, made, looked at, and evaluated on."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.app import Json, app

cater = typer.Typer(
    help="LA-CATER: where is the snitch, while it is hidden, contained, or carried?",
    epilog="Example: icarus cater evaluate data/test --models aapa-6500 --perception pp",
    no_args_is_help=True,
    rich_markup_mode=None,
)
app.add_typer(cater, name="cater")

DatasetFolder = Annotated[
    Path, typer.Argument(metavar="DIR", help="The folder that labels/ lies in.")
]


@cater.command(
    epilog="Example: icarus cater evaluate data/test --models last-seen,aapa-6500 --perception pp",
)
def evaluate(
    *,
    folder: DatasetFolder,
    models: Annotated[
        str, typer.Option(help="With commas between them; tau in squared px.")
    ] = "last-seen,heuristic,pa-6500,aapa-3000,aapa-6500,aapa-10000",
    perception: Annotated[
        str, typer.Option(help="od: the detector's boxes; pp: perfect perception.")
    ] = "od",
    jobs: Annotated[
        int | None, typer.Option(min=1, max=1024, help="Processes; all cores if left out.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(help="A Dask scheduler to run on, such as tcp://10.0.0.5:8786.")
    ] = None,
    weights: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=FILE", help="Weights of a network of your own, to be named in --models."
        ),
    ] = None,
    domain: Annotated[
        Path | None, typer.Option(help="Says which actions attach; cater.icr if left out.")
    ] = None,
    progress: Annotated[
        Path | None, typer.Option(help="Where to keep what is done; in DIR if left out.")
    ] = None,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Begin anew, even if there is something to go on from.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Run models on a data set, and print the paper's table: mIoU and mL2 by task.

    If it is interrupted, the same command goes on where it stopped. The result does not depend
    on how many processes work on it.
    """
    from rich.console import Console

    from aapa.lacater import PerceptionKind
    from runtime.cater.evaluate import How, cater_domain
    from runtime.cater.evaluate import evaluate as evaluated
    from runtime.cater.evaluation import Job
    from runtime.cater.progress_bar import ProgressBar
    from runtime.errors import UsageError

    if perception not in tuple(PerceptionKind):
        raise UsageError(f"--perception is {perception!r}; it has to be od or pp")
    names = tuple(dict.fromkeys(name.strip() for name in models.split(",") if name.strip()))
    own = _weights(weights or ())
    job = Job(folder, domain or cater_domain(), names, PerceptionKind(perception), own)
    how = How(jobs, scheduler, progress, fresh)
    with ProgressBar(Console(stderr=True)) as bar:
        report = evaluated(job, how, bar.show, bar.note)
    if as_json:
        document = report.to_json() | {"videos_per_second": report.speeds_json()}
        typer.echo(json.dumps(document, ensure_ascii=False))
        return
    # Wide enough for the table even where the width is not known, as in a pipe.
    console = Console() if sys.stdout.isatty() else Console(width=110)
    for table in report.tables():
        console.print(table)
    for line in report.skipped_lines():
        console.print(line, highlight=False, soft_wrap=True, markup=False)


def _weights(options: Sequence[str]) -> tuple[tuple[str, Path], ...]:
    """Give the name and the file of each NAME=FILE."""
    from runtime.errors import UsageError

    found = {}
    for option in options:
        name, is_there, file = option.partition("=")
        if not (is_there and name and file):
            raise UsageError(f"--weights is {option!r}; it has to be NAME=FILE")
        if name in found:
            raise UsageError(f"--weights names {name} twice")
        found[name] = Path(file)
    return tuple(found.items())
