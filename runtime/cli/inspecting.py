"""A recorded run, from the shell: why, why-not, when, diff, replay, report, view."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.cli.app import DOES_NOT_HOLD, HOLDS, Json, app
from runtime.errors import UsageError

if TYPE_CHECKING:
    from icarus_lite.trace import Recording

TraceFile = Annotated[
    Path, typer.Argument(help="A trace, as icarus run writes it.", metavar="TRACE.jsonl")
]
Cycle = Annotated[
    int | None, typer.Option("--cycle", help="The cycle asked about; the last if left out.")
]


@app.command(
    epilog='Example: icarus why run.jsonl "(attached hubcover case)" --cycle 120',
)
def why(
    file: TraceFile,
    belief: Annotated[
        str, typer.Argument(help="A belief or percept; variables such as ?x stand for anything.")
    ],
    cycle: Cycle = None,
    *,
    alternatives: Annotated[
        bool, typer.Option("--alternatives", help="Give all its derivations, not only one.")
    ] = False,
    as_json: Json = False,
) -> None:
    """Say why something was believed: its derivation, down to percepts and to actions.

    Ends with status 0 if it was believed in that cycle, with 1 if it was not.
    """
    from icarus_lite.trace import matching, pattern_of

    recording = _open(file)
    instant = recording.at(_cycle(recording, cycle))
    pattern = pattern_of(belief)
    found = [instant.why(fact, alternatives=alternatives) for fact, _ in matching(pattern, instant)]
    if as_json:
        answers = [answer.as_document() for answer in found]
        _print({"asked": str(pattern), "cycle": instant.cycle, "answers": answers})
    elif found:
        typer.echo("\n".join(map(str, found)))
    else:
        typer.echo(str(instant.why_not(belief)))
    raise typer.Exit(HOLDS if found else DOES_NOT_HOLD)


@app.command(
    "why-not",
    epilog='Example: icarus why-not run.jsonl "(insert hubcover case)" --cycle 20',
)
def why_not(
    file: TraceFile,
    asked: Annotated[str, typer.Argument(help="A belief, or a skill; variables are welcome.")],
    cycle: Cycle = None,
    *,
    as_json: Json = False,
) -> None:
    """Say why something was not believed, or why a skill could not start.

    Ends with status 0 if that is so, with 1 if it was believed, or could start, after all.
    """
    from icarus_lite.inference import why_not_document

    recording = _open(file)
    answer = recording.at(_cycle(recording, cycle)).why_not(asked)
    if as_json:
        _print(why_not_document(answer))
    else:
        typer.echo(str(answer))
    raise typer.Exit(DOES_NOT_HOLD if answer.holds else HOLDS)


@app.command(
    epilog='Example: icarus when run.jsonl "(attached ?part case)"',
)
def when(
    file: TraceFile,
    pattern: Annotated[
        str, typer.Argument(help="A belief or a percept, attributes included: (object ?x ^seen no)")
    ],
    *,
    as_json: Json = False,
) -> None:
    """Say in which cycles something was believed or perceived, and what ended it.

    Ends with status 0 if it ever was, with 1 if not.
    """
    from icarus_lite.trace import pattern_of
    from icarus_lite.trace import when as times_of

    asked = pattern_of(pattern)
    found = times_of(asked, _open(file))
    if as_json:
        _print({"asked": str(asked), "answers": [times.as_document() for times in found]})
    elif found:
        typer.echo("\n".join(map(str, found)))
    else:
        typer.echo(f"nothing that matches {asked} was ever believed or perceived")
    raise typer.Exit(HOLDS if found else DOES_NOT_HOLD)


@app.command(
    epilog="Example: icarus diff run.jsonl 40 120",
)
def diff(
    file: TraceFile,
    first: Annotated[int, typer.Argument(help="A cycle.", metavar="A")],
    second: Annotated[int, typer.Argument(help="Another cycle.", metavar="B")],
    *,
    as_json: Json = False,
) -> None:
    """Say what is different between two cycles: beliefs, percepts, and what was done meanwhile."""
    from icarus_lite.trace import compare

    recording = _open(file)
    found = compare(recording.at(first), recording.at(second), recording)
    if as_json:
        _print(found.as_document())
    else:
        typer.echo(str(found))


@app.command(
    epilog="Example: icarus replay run.jsonl",
)
def replay(file: TraceFile, *, as_json: Json = False) -> None:
    """Go through a recorded run again, and say whether the same is believed.

    Ends with status 0 if all beliefs are as recorded, with 1 if not.
    """
    from dataclasses import asdict

    from icarus_lite.trace import replay as run_again

    found = run_again(_open(file))
    if as_json:
        _print({"agrees": found.agrees, **asdict(found)})
    else:
        typer.echo(str(found))
    raise typer.Exit(HOLDS if found.agrees else DOES_NOT_HOLD)


def _open(file: Path) -> Recording:
    from icarus_lite.trace import Recording

    recording = Recording(file)
    if recording.warning:
        typer.echo(recording.warning, err=True)
    return recording


def _cycle(recording: Recording, cycle: int | None) -> int:
    if cycle is None and recording.cycles:
        return recording.cycles[-1]
    return 0 if cycle is None else cycle


def _print(document: object) -> None:
    typer.echo(json.dumps(document, ensure_ascii=False))


@app.command(
    epilog="Example: icarus report run.jsonl --out report",
)
def report(
    file: TraceFile,
    out: Annotated[
        Path, typer.Option(help="A folder; index.html and story.txt are written to it.")
    ],
) -> None:
    """Write a recorded run as one page to look at, and as a story to read.

    The page needs no server and nothing from the network: a timeline of beliefs and actions, why
    each was, who moves with whom, and what the camera saw.
    """
    from runtime.report import write_report

    page, story = write_report(_open(file), out)
    typer.echo(f"{page}\n{story}")


@app.command(
    epilog="Example: icarus view run.jsonl --save run.rrd",
)
def view(
    file: TraceFile,
    save: Annotated[
        Path | None,
        typer.Option(help="Write a file for the viewer instead of opening it.", metavar="FILE.rrd"),
    ] = None,
) -> None:
    """Show a recorded run in the Rerun viewer: camera, cell, hierarchy, beliefs, log.

    It needs the extra [view]. A saved file opens in `rerun FILE.rrd`, or in the viewer's page.
    """
    recording = _open(file)
    try:
        from runtime.pictures.viewing import save_pictures, show_pictures
    except ModuleNotFoundError as error:
        if error.name is None or not error.name.startswith("rerun"):
            raise
        raise UsageError(
            "pictures need the extra [view]: pip install 'icarus-lite[view]'; `icarus report` "
            "makes a page without it"
        ) from None
    if save is None:
        show_pictures(recording)
    else:
        save_pictures(recording, save)
        typer.echo(str(save))
