"""Keeping to a path: the remembered path, moved on by one cycle.

A path is rebuilt each cycle from the levels it had. As long as they stand, the agent keeps to them
(persistence): a macro goes through its subskills in order, and only its beginning is tied to its
start conditions. A level falls when its `:while` no longer holds, its time is over, or its next
subskill cannot begin; then its caller calls anew, with whatever clause and bindings fit the world
as it is now (reactivity). So the new path shares with the old one all that can be kept.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.execution.moment import Moment
from icarus_lite.execution.path import Level, as_bound
from icarus_lite.execution.repertoire import Repertoire, passed_back
from icarus_lite.execution.selection import Selection
from icarus_lite.inference import FactStore
from icarus_lite.planning import Failure, FailureReason
from icarus_lite.records import dataclass, replace


@dataclass(frozen=True, slots=True)
class Progress:
    """What has become of a path.

    Args:
        levels: The path from here to a primitive skill; empty if there is none.
        kept: How many of these levels the path had before.
        completed: Whether its outermost skill has been carried out to its end.
    """

    levels: tuple[Level, ...] = ()
    kept: int = 0
    completed: bool = False


def carry_on(
    repertoire: Repertoire,
    selection: Selection,
    levels: Sequence[Level],
    moment: Moment,
    *,
    finished: bool,
) -> Progress:
    """Move a path on after its primitive skill has come to an end.

    Args:
        repertoire: The skills.
        selection: Chooses what comes below the levels that stay; learns what was dropped and why.
        levels: The path, the primitive last.
        moment: What is known now.
        finished: Whether the primitive is done; otherwise it failed or was broken off.
    """
    standing, done = list(levels[:-1]), levels[-1] if finished else None
    fallen = first_fallen(repertoire, standing, moment)
    if fallen is not None:
        place, failure = fallen
        selection.failures.append(failure)
        standing, done = standing[:place], None
    while standing:
        macro, above = standing.pop(), tuple(standing)
        if done is not None:
            macro = _returned(macro, done)
        below, done = _next(repertoire, selection, macro, above, moment.facts)
        if below is not None:
            return Progress(below, kept=len(above) + 1)
    return Progress(completed=done is not None)


def first_fallen(
    repertoire: Repertoire, macros: Sequence[Level], moment: Moment
) -> tuple[int, Failure] | None:
    """Give the outermost macro that may not go on, and why; None if all may."""
    for place, macro in enumerate(macros):
        skill = repertoire.of(macro.clause)
        if not skill.holds(moment.facts, dict(macro.bindings)):
            condition = " ".join(map(str, macro.clause.holds))
            text = f"{condition} no longer holds while {macro} is carried out"
            return place, Failure(FailureReason.WHILE_BROKEN, text)
        if moment.is_over(macro.clause.timeout_s, macro.since_s):
            text = f"{macro} is not done within {macro.clause.timeout_s:g} s"
            return place, Failure(FailureReason.EFFECT_NOT_BELIEVED, text)
    return None


def _returned(caller: Level, done: Level) -> Level:
    """Let a caller go on after its subskill, with what that passes back."""
    subskill, bindings = caller.clause.subskills[caller.position], dict(caller.bindings)
    back = passed_back(subskill, bindings, done.clause.head, dict(done.bindings))
    return replace(caller, bindings=as_bound(back or bindings), position=caller.position + 1)


def _next(
    repertoire: Repertoire,
    selection: Selection,
    macro: Level,
    above: tuple[Level, ...],
    facts: FactStore,
) -> tuple[tuple[Level, ...] | None, Level | None]:
    """Give the path on from a macro, or the macro if it is done, or neither: it has failed."""
    skill = repertoire.of(macro.clause)
    exhausted = False
    for way in selection.onward(macro):
        if not way.is_at_end:
            below = selection.descend((*above, way), selection.calls(way))
            if below is not None:
                return below, None
        elif not skill.effects or skill.is_done(facts, dict(way.bindings)):
            return None, way
        else:
            exhausted = True
    if skill.is_done(facts, dict(macro.bindings)):
        return None, macro  # somebody else has seen to it
    if exhausted:
        selection.give_up(FailureReason.MACRO_EXHAUSTED, macro)
    else:
        text = f"{macro.call} cannot begin"
        selection.give_up(FailureReason.SUBSKILL_CALL_FAILED, macro, text)
    return None, None
