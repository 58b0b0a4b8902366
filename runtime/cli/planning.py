"""`icarus plan`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from runtime.cli.app import DOES_NOT_HOLD, HOLDS, DomainFile, Json, app, load
from runtime.errors import UsageError

if TYPE_CHECKING:
    from icarus_lite.language.syntax import Condition, Domain
    from runtime.cli.plan_report import Bounds


@app.command(
    epilog="Example: icarus plan domains/gearbox.icr --task 1.1 --frames recorded.jsonl",
)
def plan(
    file: DomainFile,
    task: Annotated[str | None, typer.Option(help="The task's name, such as 1.1.")] = None,
    goal: Annotated[
        str | None, typer.Option(help="The goal instead, such as '((attached hubcover case))'.")
    ] = None,
    frames: Annotated[
        Path | None, typer.Option(help="Recorded frames; the last one is where to plan from.")
    ] = None,
    *,
    explain: Annotated[
        bool,
        typer.Option("--explain", help="Say what each step is for, and how the plan was found."),
    ] = False,
    as_macro: Annotated[
        bool,
        typer.Option("--macro", help="Show the plan as a macro skill that could be adopted."),
    ] = False,
    limit: Annotated[
        int | None,
        typer.Option(metavar="N", help="Give up after so many situations (0: never)."),
    ] = None,
    seconds: Annotated[
        float | None, typer.Option(metavar="S", help="Give up after so many seconds.")
    ] = None,
    improve: Annotated[
        float | None,
        typer.Option(metavar="S", help="Go on for so many seconds to make the plan shorter."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Plan from the last recorded frame, or from what the task itself gives (`:init`).

    Ends with status 0 and the steps, or with 1 and the reason why there is no plan.
    """
    from icarus_lite.language.teams import domain_of
    from icarus_lite.planning import Plan
    from runtime.cli.plan_report import Answer, document, lines
    from runtime.cli.starting import find_task, start_state

    if (task is None) == (goal is None):
        raise UsageError("say what to plan for: either --task NAME or --goal '((…))'")
    bounds = _bounds(limit, seconds, improve)
    domain = load(file)
    chosen = None if task is None else find_task(domain, task)
    domain = domain if chosen is None else domain_of(domain, others=chosen.agents)
    goals = chosen.goals if chosen is not None else _goals(domain, goal or "")
    start = start_state(domain, chosen, frames)
    if frames is None and chosen is not None and not chosen.init:
        typer.echo(f"the state is that of {start.origin}", err=True)
    answer = Answer.of(domain, start.imagination(), goals, bounds)
    if as_json:
        shown = document(answer, explain=explain, as_macro=as_macro)
        typer.echo(json.dumps(shown, ensure_ascii=False))
    else:
        for line in lines(answer, explain=explain, as_macro=as_macro):
            typer.echo(line)
        if not isinstance(answer.found, Plan):
            typer.echo(f"no plan: {answer.found.reason}", err=True)
    raise typer.Exit(HOLDS if isinstance(answer.found, Plan) else DOES_NOT_HOLD)


def _bounds(limit: int | None, seconds: float | None, improve: float | None) -> Bounds:
    """Read how long may be searched. Raises UsageError for less than nothing."""
    from icarus_lite.planning import DEFAULT_LIMIT
    from runtime.cli.plan_report import Bounds

    for option, value in (("--limit", limit), ("--seconds", seconds), ("--improve", improve)):
        if value is not None and not 0 <= value < float("inf"):
            raise UsageError(f"{option} {value}: it cannot be less than 0, nor endless")
    if limit is None:
        limit = None if seconds is not None else DEFAULT_LIMIT
    return Bounds(limit or None, seconds, improve)


def _goals(domain: Domain, text: str) -> tuple[Condition, ...]:
    """Read a goal and see that the domain knows what it speaks of."""
    from icarus_lite.language.checking.vocabulary import vocabulary
    from icarus_lite.language.fragments import parse_conditions
    from icarus_lite.language.wording import closest

    goals = parse_conditions(text)
    known = vocabulary(domain).predicates
    for goal in goals:
        name, size = goal.atom.predicate, len(goal.atom.args)
        if name not in known:
            meant = closest(name, sorted(known))
            hint = f"; did you mean {meant}?" if meant else ""
            raise UsageError(f"goal {goal}: nothing is ever known about {name}{hint}")
        if all(definition.arity != size for definition in known[name]):
            arity = known[name][0].arity
            raise UsageError(f"goal {goal}: {name} takes {arity} arguments, not {size}")
    return goals
