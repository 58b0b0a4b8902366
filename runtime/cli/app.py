"""The `icarus` program itself: its options before any command, and what all commands share."""

from __future__ import annotations

import sys
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, TextIO

import typer

from icarus_lite import __version__
from runtime.cli.on_demand import CommandsOnDemand
from runtime.errors import UsageError

if TYPE_CHECKING:
    from icarus_lite.language.syntax import Domain

HOLDS: Final = 0
"""Exit status: it holds, it succeeded."""

DOES_NOT_HOLD: Final = 1
"""Exit status: a failed task, a failing test, an unformatted file."""

BAD_INPUT: Final = 2
"""Exit status: bad input or usage, with the reason on standard error."""

app = typer.Typer(
    name="icarus",
    cls=CommandsOnDemand,
    help="A cognitive-architecture rule engine with its own language, action-aware perceptual "
    "anchoring, and Universal Robots arms.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

DomainFile = Annotated[Path, typer.Argument(help="A domain file, such as domains/gearbox.icr.")]
DomainFiles = Annotated[list[Path], typer.Argument(help="Domain files.", metavar="FILE…")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document instead of text.")]


def load(file: Path) -> Domain:
    """Load a domain, or end with its errors. Raises DomainError."""
    from icarus_lite.language import load_domain

    return load_domain(file)


def sink(path: Path | None) -> AbstractContextManager[TextIO]:
    """Open an output file, or standard output, which stays open afterwards.

    Raises:
        UsageError: the file cannot be written.
    """
    if path is None:
        return nullcontext(sys.stdout)
    try:
        return path.open("w", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"{path}: cannot be written: {error.strerror}") from error


def _show_version(value: bool) -> None:  # noqa: FBT001 - the signature typer calls
    if value:
        typer.echo(f"icarus-lite {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    *,
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show it.")
    ] = False,
) -> None:
    """Hold the options that stand before any command."""
