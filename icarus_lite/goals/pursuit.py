"""The goal that is being pursued: what it must not harm, and what the way to it has cost."""

from __future__ import annotations

from collections import Counter

from icarus_lite.execution import Choice, DecisionKind, Executor, Moment
from icarus_lite.goals.agenda import Agenda, Entry
from icarus_lite.goals.goal import together
from icarus_lite.language.syntax import Condition

MAX_UNDONE = 3
"""How often the way to one goal may leave another undone before it is not taken any more."""


class Pursuit:
    """Pursues one goal at a time, and learns which goals cannot be had together.

    Goals that are reached and no less important are kept: pursued is the goal *and* those. A plan
    may undo them on the way if it makes them good again.

    Args:
        executor: Finds the steps.
        agenda: All goals.
    """

    def __init__(self, executor: Executor, agenda: Agenda) -> None:
        self._executor = executor
        self._agenda = agenda
        self._target: tuple[Condition, ...] = ()
        self._aims: tuple[Condition, ...] | None = None
        self._own_losses: set[str] = set()
        self._undone: Counter[tuple[str, str]] = Counter()
        self.name: str | None = None

    @property
    def present(self) -> Entry | None:
        """The goal that is being pursued; None if none is, or it is a goal no more."""
        return self._agenda.get(self.name)

    def kept_by(self, entry: Entry) -> list[Entry]:
        """Give the goals that one must not harm: reached, or to be made good, no less important."""
        return [
            each
            for each in self._agenda
            if each is not entry
            and each.priority >= entry.priority
            and (each.satisfied or (self.name == entry.name and each.name in self._own_losses))
        ]

    def aims_of(self, entry: Entry) -> tuple[Condition, ...]:
        """Give what is to be achieved for a goal, all of it."""
        return together(entry.goal, [each.goal for each in self.kept_by(entry)])

    def take_up(self, entry: Entry) -> None:
        """Pursue a goal from now on; nothing changes if it is the present one."""
        is_other, target = entry.name != self.name, entry.goal.conditions
        if not is_other and self._executor.is_under_way and target == self._target:
            return  # what has been reached by chance meanwhile does not make the way a worse one
        present, was_reached = self.present, False
        if is_other and self.name is not None:
            was_reached = present is None or present.satisfied
            self.leave()
        aims = self.aims_of(entry)
        if aims != self._aims:
            self._executor.pursue(aims, afresh=was_reached)
        if present is not None and is_other and not was_reached:
            entry.reason = f"clearly more important than {present.name}"
        self.name, self._target, self._aims = entry.name, target, aims

    def leave(self) -> None:
        """Pursue the goal no longer, and learn what the way to it has cost."""
        present = self.present
        if present is not None:
            lost = (self._agenda.get(name) for name in self._own_losses)
            for each in lost:
                if each and not each.satisfied and each.priority >= present.priority:
                    self._undone[present.name, each.name] += 1
        self._own_losses.clear()
        self.name = None

    def keep_all(self) -> None:
        """Pursue nothing in particular: all goals are reached."""
        self.leave()
        goals = [entry.goal for entry in self._agenda]
        aims = together(goals[0], goals[1:]) if goals else ()
        if aims != self._aims:
            self._executor.pursue(aims, afresh=True)
            self._aims = aims

    def foresee(self, choice: Choice, moment: Moment) -> None:
        """Note which goals the step that is begun now will undo."""
        begun = choice.kind in (DecisionKind.ACT, DecisionKind.REQUEST)
        if not begun or choice.step is None:
            return
        for entry in self._agenda:
            may_suffer = entry.satisfied and entry.name != self.name
            if may_suffer and moment.undone_by(choice.step, entry.goal.conditions) is not None:
                self._own_losses.add(entry.name)

    def make_good(self) -> None:
        """Forget the losses that have been made good."""
        self._own_losses -= {entry.name for entry in self._agenda if entry.satisfied}

    @property
    def is_unfinished(self) -> bool:
        """Whether the goal is reached, and the way to it has yet to make good what it has cost."""
        present = self.present
        if present is None or not present.satisfied or not self._executor.is_under_way:
            return False
        return any(not each.satisfied for each in self.kept_by(present))

    def will_make_good(self, entry: Entry) -> bool:
        """Tell whether the way that has undone a goal is still being gone."""
        return self._executor.is_under_way and entry.name in self._own_losses

    def foe_of(self, entry: Entry) -> str | None:
        """Give the goal, no less important, that the way to one keeps undoing; None if none."""
        for (name, foe), times in self._undone.items():
            if name == entry.name and times >= MAX_UNDONE:
                other = self._agenda.get(foe)
                if other is not None and other.priority >= entry.priority:
                    return foe
        return None
