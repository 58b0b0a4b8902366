"""The agenda: all top-level goals of an agent, how each stands, and which comes first."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping

from icarus_lite.execution import GoalReport, Moment, Standing
from icarus_lite.goals.blockade import Blockade
from icarus_lite.goals.goal import Goal
from icarus_lite.records import dataclass

_REMOVED = "it was removed"
_LAPSED = "it no longer matters"
_REACHED = "it is reached"


@dataclass(slots=True)
class Entry:
    """A goal on the agenda.

    Args:
        goal: The goal.
        satisfied: Whether it is believed now.
        leaving: Why it is going to be dropped; empty if it is not.
        blockade: Why it was set aside; None if it was not.
        reason: Something to say about how it stands.
    """

    goal: Goal
    satisfied: bool = False
    leaving: str = ""
    blockade: Blockade | None = None
    reason: str = ""

    @property
    def name(self) -> str:
        """The name of the goal."""
        return self.goal.name

    @property
    def priority(self) -> float:
        """The priority of the goal."""
        return self.goal.priority


class Agenda:
    """The goals of an agent, in the order in which they came to be goals."""

    def __init__(self) -> None:
        self._entries: dict[str, Entry] = {}
        self._removed: set[str] = set()
        # Long-term goals that are done with until they have ceased to matter in between.
        self._done_with: set[str] = set()

    def __iter__(self) -> Iterator[Entry]:
        return iter(self._entries.values())

    def get(self, name: str | None) -> Entry | None:
        """Give the entry of a name; None if there is none."""
        return None if name is None else self._entries.get(name)

    def add(self, goal: Goal) -> None:
        """Add a goal, in place of one of the same name if there is one."""
        self._removed.discard(goal.name)
        known = self._entries.get(goal.name)
        if known is None:
            self._entries[goal.name] = Entry(goal)
        else:
            known.goal, known.leaving, known.blockade = goal, "", None

    def remove(self, name: str) -> bool:
        """Let a goal be dropped at the next point where nothing is under way for it.

        Returns:
            Whether there is such a goal.
        """
        if name not in self._entries or name in self._removed:
            return False
        self._removed.add(name)
        self._entries[name].leaving = _REMOVED
        return True

    def update(self, moment: Moment, nominated: Mapping[str, Goal]) -> None:
        """Take in what is known now: which goals are believed, and which matter.

        Args:
            moment: What is known now.
            nominated: The long-term goals that matter now. One that was reached, and is not to be
                kept up, counts anew only once it has ceased to matter in between.
        """
        self._done_with &= nominated.keys()
        for name, goal in nominated.items():
            entry = self._entries.get(name)
            if entry is None and name not in self._done_with:
                self._entries[name] = Entry(goal)
            elif entry is not None and entry.goal.is_long_term:
                entry.goal = goal
        for entry in self:
            entry.satisfied = moment.believes(entry.goal.conditions)
            if entry.satisfied:
                entry.blockade, entry.reason = None, ""
            entry.leaving = self._why_leaving(entry, nominated)

    def _why_leaving(self, entry: Entry, nominated: Mapping[str, Goal]) -> str:
        if entry.name in self._removed:
            return _REMOVED
        if entry.goal.is_long_term and entry.name not in nominated:
            return _LAPSED
        return _REACHED if entry.satisfied and not entry.goal.maintain else ""

    def drop(self, but: Collection[str] = ()) -> list[Entry]:
        """Take the goals off that are leaving, all but some, and give them."""
        leaving = [entry for entry in self if entry.leaving and entry.name not in but]
        for entry in leaving:
            del self._entries[entry.name]
            self._removed.discard(entry.name)
            if entry.goal.is_long_term:
                self._done_with.add(entry.name)
        return leaving

    def in_turn(self) -> list[Entry]:
        """Give the goals that are not believed, the most important first."""
        waiting = [entry for entry in self if not entry.satisfied]
        return sorted(waiting, key=lambda entry: -entry.priority)


def report(entry: Entry, *, pursued: bool = False, dropped: bool = False) -> GoalReport:
    """Say how a goal stands."""
    standing, reason = Standing.NOMINATED, entry.reason
    if dropped:
        standing, reason = Standing.DROPPED, entry.leaving
    elif entry.satisfied:
        standing = Standing.SATISFIED
    elif pursued:
        standing = Standing.PURSUED
    elif entry.blockade is not None:
        standing, reason = Standing.SUSPENDED, entry.blockade.reason
    goal = entry.goal
    return GoalReport(goal.name, goal.conditions, goal.priority, goal.maintain, standing, reason)
