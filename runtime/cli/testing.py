"""`icarus test`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.cli.app import BAD_INPUT, DOES_NOT_HOLD, HOLDS, DomainFiles, Json, app

if TYPE_CHECKING:
    from icarus_lite.language import Diagnostic
    from icarus_lite.testing import CaseOutcome


@app.command(
    "test",
    epilog="Example: icarus test domains/gearbox.icr -k hidden",
)
def run_domain_tests(
    files: DomainFiles,
    *,
    select: Annotated[
        str, typer.Option("-k", metavar="TEXT", help="Only tests with this text in their name.")
    ] = "",
    as_json: Json = False,
) -> None:
    """Run the tests in domain files; tell of each that fails what is not as it states, and why.

    Ends with status 0 when all hold, 1 when one does not, 2 when a file has errors.
    """
    from icarus_lite.testing import describe, summary, to_json

    outcomes: list[CaseOutcome] = []
    problems: list[Diagnostic] = []
    for file in files:
        ran = _run(file, select, problems)
        if ran is None:
            continue
        outcomes += ran
        if not as_json:
            for outcome in ran:
                if not outcome.passed:
                    typer.echo(f"failed: {outcome.test.name}\n{describe(outcome)}\n")
            typer.echo(f"{file}: {summary(ran)}")
    failed = sum(not outcome.passed for outcome in outcomes)
    if as_json:
        document = {
            "passed": len(outcomes) - failed,
            "failed": failed,
            "tests": [to_json(outcome) for outcome in outcomes],
            "problems": [problem.to_json() for problem in problems],
        }
        typer.echo(json.dumps(document, ensure_ascii=False, indent=2))
    elif len(files) > 1:
        typer.echo(f"{len(files)} files: {summary(outcomes)}")
    if problems or _selects_nothing(select, outcomes):
        raise typer.Exit(BAD_INPUT)
    raise typer.Exit(DOES_NOT_HOLD if failed else HOLDS)


def _run(file: Path, select: str, problems: list[Diagnostic]) -> tuple[CaseOutcome, ...] | None:
    """Run the selected tests of a file; None, with the errors told, if it does not load."""
    from icarus_lite.inference import InferenceEngine
    from icarus_lite.language import DomainError
    from icarus_lite.testing import run_test
    from runtime.cli.app import load

    try:
        domain = load(file)
    except DomainError as error:
        typer.echo(str(error), err=True)
        problems += error.diagnostics
        return None
    engine = InferenceEngine(domain)
    chosen = (test for test in domain.tests if select.casefold() in test.name.casefold())
    return tuple(run_test(engine, test) for test in chosen)


def _selects_nothing(select: str, outcomes: list[CaseOutcome]) -> bool:
    """Tell whether a selection was made that fits no test, and say so."""
    if outcomes or not select:
        return False
    typer.echo(f'no test has "{select}" in its name', err=True)
    return True
