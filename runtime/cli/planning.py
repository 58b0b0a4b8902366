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
    from icarus_lite.planning import NoPlan, Plan


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
    as_json: Json = False,
) -> None:
    """Plan from the last recorded frame, or from what the task itself gives (`:init`).

    Ends with status 0 and the steps, or with 1 and the reason why there is no plan.
    """
    from icarus_lite.planning import Plan, find_plan
    from runtime.cli.starting import find_task, start_state

    if (task is None) == (goal is None):
        raise UsageError("say what to plan for: either --task NAME or --goal '((…))'")
    domain = load(file)
    chosen = None if task is None else find_task(domain, task)
    goals = chosen.goals if chosen is not None else _goals(domain, goal or "")
    start = start_state(domain, chosen, frames)
    if frames is None and chosen is not None and not chosen.init:
        typer.echo(f"the state is that of {start.origin}", err=True)
    found = find_plan(domain, start.imagination(), goals)
    if as_json:
        typer.echo(json.dumps(_document(found), ensure_ascii=False))
    elif isinstance(found, Plan):
        for number, step in enumerate(found.steps, 1):
            typer.echo(f"{number:>3}  {step.action}")
        if not found.steps:
            typer.echo("nothing to do: the goal holds already")
    else:
        typer.echo(f"no plan: {found.reason}", err=True)
    raise typer.Exit(HOLDS if isinstance(found, Plan) else DOES_NOT_HOLD)


def _goals(domain: Domain, text: str) -> tuple[Condition, ...]:
    """Read a goal and see that the domain knows what it speaks of."""
    from icarus_lite.language.checking.vocabulary import vocabulary
    from icarus_lite.language.fragments import parse_conditions
    from icarus_lite.language.reading.explanations import closest

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


def _document(found: Plan | NoPlan) -> dict[str, object]:
    from icarus_lite.planning import Plan

    if isinstance(found, Plan):
        steps = [str(step.action) for step in found.steps]
        return {"solved": True, "steps": steps, "cost": len(steps)}
    return {"solved": False, "steps": [], "cost": None, "reason": found.reason}
