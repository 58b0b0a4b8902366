"""Skills that lead from an aim directly: the first path to an intended skill, or to a goal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from icarus_lite.execution.experience import Experience
from icarus_lite.execution.moment import Moment
from icarus_lite.execution.path import Aim, Level
from icarus_lite.execution.selection import Selection
from icarus_lite.inference import change_of
from icarus_lite.language.syntax import Atom, Condition, Constant
from icarus_lite.planning import FailureReason, NoPlan, PlanningDomain, PlanStep, find_plan
from icarus_lite.records import replace
from icarus_lite.symbols import Action


def path_to_skill(selection: Selection, call: Atom) -> tuple[Level, ...] | None:
    """Find a path from an intended skill to a primitive that can act now."""
    return selection.descend((), selection.call(call, {}))


def path_to_goals(
    selection: Selection, goals: Sequence[Condition], moment: Moment
) -> tuple[Aim, tuple[Level, ...]] | None:
    """Find a path to the first goal, in their order, that skills lead to from here.

    A goal is left to the skills only if they do not undo one that is believed already: how to
    have both is a question for planning.

    Returns:
        The goal and its path; None if no skill leads on.
    """
    believed = [goal for goal in goals if moment.believes([goal])]
    for goal in goals:
        if goal in believed:
            continue
        options = _keeping(believed, selection, selection.toward(goal), moment)
        levels = selection.descend((), options)
        if levels is not None:
            return goal, levels
    return None


def obstacle(
    prepared: PlanningDomain,
    selection: Selection,
    goals: Sequence[Condition],
    moment: Moment,
    experience: Experience,
) -> NoPlan | None:
    """Say why neither skills nor a plan lead to some goals from here; None if something does."""
    if path_to_goals(selection, goals, moment) is not None:
        return None
    found = find_plan(
        prepared.domain,
        moment.imagination,
        goals,
        excluded=list(experience.given_up),
        prepared=prepared,
    )
    if not isinstance(found, NoPlan):
        return None
    return replace(found, reason="; ".join([found.reason, *experience.complaints]))


def _keeping(
    believed: Sequence[Condition],
    selection: Selection,
    options: Iterable[Level],
    moment: Moment,
) -> Iterator[Level]:
    """Leave out the skills whose effects would undo one of these goals."""
    for level in options:
        undone = moment.undone_by(_as_one_step(level), believed) if believed else None
        if undone is None:
            yield level
        else:
            text = f"it would undo {undone}, which holds"
            selection.refuse(FailureReason.LOOP, level, text)


def _as_one_step(level: Level) -> PlanStep:
    """Give a skill, be it a macro, as if it were done in one step: all that counts is its end."""
    instance = level.instance
    args = tuple(term.value for term in instance.args if isinstance(term, Constant))
    change = change_of(level.clause.effects, dict(level.bindings))
    action = Action(instance.predicate, args)
    return PlanStep(action, (), level.clause, level.bindings, change)
