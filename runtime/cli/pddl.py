"""`icarus pddl export` and `icarus pddl import`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from icarus_lite import FrameError
from runtime.cli.app import DomainFile, app, load

if TYPE_CHECKING:
    from icarus_lite.language import Diagnostic
    from icarus_lite.language.syntax import Source

pddl = typer.Typer(
    help="Exchange planning problems with other planners.",
    no_args_is_help=True,
    rich_markup_mode=None,
    epilog="Example: icarus pddl export domains/gearbox.icr --task 1.1 --out gearbox-pddl",
)
app.add_typer(pddl, name="pddl")


@pddl.command(
    "export",
    epilog="Example: icarus pddl export domains/gearbox.icr --task 1.1 --out gearbox-pddl",
)
def export(
    file: DomainFile,
    task: Annotated[str, typer.Option(help="The task's name, such as 1.1.")],
    out: Annotated[Path, typer.Option(help="The folder for domain.pddl and problem.pddl.")],
    frames: Annotated[
        Path | None, typer.Option(help="Recorded frames; the last one is the initial state.")
    ] = None,
    *,
    inline: Annotated[
        bool,
        typer.Option("--inline", help="Write no derived predicates: put their definitions in."),
    ] = False,
) -> None:
    """Write a task as PDDL: typed STRIPS with negative preconditions and derived predicates.

    The initial state is that of the last recorded frame, or what the task itself gives (:init),
    or that of a test of the domain.
    """
    from icarus_lite.language.pddl import export_task, inlined, write_domain, write_problem
    from icarus_lite.language.teams import domain_of
    from runtime.cli.starting import Known, find_task, start_state

    whole = load(file)
    chosen = find_task(whole, task)
    domain = domain_of(whole, others=chosen.agents)
    start = start_state(domain, chosen, frames)
    exported = export_task(domain, chosen.name, chosen.goals, Known(start))
    pddl_domain, pddl_problem = exported.domain, exported.problem
    if inline:
        pddl_domain, pddl_problem = inlined(pddl_domain, pddl_problem)
    _tell([(note, domain.source) for note in exported.notes])
    remarks = (f"The domain {domain.name}, for its task {task}.", *exported.remarks)
    origin = f"The initial state is that of {start.origin}."
    _write(out / "domain.pddl", write_domain(pddl_domain, remarks))
    _write(out / "problem.pddl", write_problem(pddl_problem, (origin,)))
    count = len(pddl_domain.actions)
    typer.echo(f"{out / 'domain.pddl'}: {count} action{'s' * (count != 1)}")
    typer.echo(f"{out / 'problem.pddl'}: {origin[0].lower()}{origin[1:]}")


@pddl.command(
    "import",
    epilog="Example: icarus pddl import domain.pddl problem.pddl --out blocks.icr",
)
def import_(
    domain: Annotated[Path, typer.Argument(help="A PDDL domain.", metavar="DOMAIN.pddl")],
    problem: Annotated[Path, typer.Argument(help="A problem for it.", metavar="PROBLEM.pddl")],
    out: Annotated[Path, typer.Option(help="The domain file to write.")],
) -> None:
    """Make a domain file of a PDDL domain and problem; the problem becomes a task `problem`."""
    from icarus_lite.language.pddl import import_files

    imported = import_files(domain, problem)
    _tell(imported.remarks)
    _write(out, imported.text)
    count = len(imported.domain.skills)
    typer.echo(f"{out}: {count} skill{'s' * (count != 1)}, task problem")


def _tell(
    findings: list[tuple[Diagnostic, Source]] | tuple[tuple[Diagnostic, Source], ...],
) -> None:
    from icarus_lite.language import render

    for finding, source in findings:
        typer.echo(render(finding, source), err=True)


def _write(path: Path, text: str) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise FrameError(f"cannot be written: {reason.lower()}", path=str(path)) from error
