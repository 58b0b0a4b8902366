"""`icarus check`."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.cli.app import BAD_INPUT, HOLDS, DomainFiles, Json, app

if TYPE_CHECKING:
    from icarus_lite.language import Diagnostic
    from icarus_lite.language.syntax import Domain

Verbose = Annotated[
    bool, typer.Option("--verbose", "-v", help="Tell of names that nothing uses as well.")
]


@app.command(
    epilog="Example: icarus check domains/gearbox.icr",
)
def check(
    files: DomainFiles,
    *,
    verbose: Verbose = False,
    as_json: Json = False,
) -> None:
    """Parse and check domain files; tell every problem with file, line, column and a hint.

    A domain with a task for a robot is also checked for commands that no driver offers. Warnings
    and notes are silenced by a comment in their line: `; noqa: ICR029`.
    """
    from icarus_lite.language import diagnose_file, render, to_json

    found: list[Diagnostic] = []
    for file in files:
        domain, source, diagnostics = diagnose_file(file, thorough=verbose)
        if domain is not None and any(task.robot for task in domain.tasks):
            diagnostics += _unoffered(domain)
        found.extend(diagnostics)
        if not as_json:
            for diagnostic in diagnostics:
                typer.echo(render(diagnostic, source), err=True)
    errors = sum(d.severity == "error" for d in found)
    if as_json:
        typer.echo(json.dumps([to_json(d) for d in found], ensure_ascii=False, indent=2))
    else:
        typer.echo(_summary(len(files), found))
    raise typer.Exit(BAD_INPUT if errors else HOLDS)


def _unoffered(domain: Domain) -> tuple[Diagnostic, ...]:
    """Find the commands that the arms cannot carry out."""
    from icarus_lite.language import check_commands
    from runtime.drivers.motions import COMMANDS

    return check_commands(domain, COMMANDS)


def _summary(files: int, found: list[Diagnostic]) -> str:
    counted = {
        name: sum(d.severity == name for d in found) for name in ("error", "warning", "note")
    }
    said = ", ".join(f"{n} {name}{'s' * (n != 1)}" for name, n in counted.items() if n)
    return f"{files} file{'s' * (files != 1)}: {said or 'no problems'}"
