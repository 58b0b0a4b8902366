"""Why a goal was set aside, and when it is worth trying again.

A goal to which nothing leads is tried again when something has changed that it depends on: a
belief that some skill or concept on the way to it asks for, a skill that can start now and could
not before, an action that may be used again, or the goals that it must not harm. Measured numbers
change all the time; they count where they change a belief or let a skill start.
"""

from __future__ import annotations

from collections.abc import Hashable

from icarus_lite.execution import Moment
from icarus_lite.language.syntax import Condition, Domain, SkillClause
from icarus_lite.planning import Failure, relevance
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief


@dataclass(frozen=True, slots=True)
class Blockade:
    """Why a goal was set aside.

    Args:
        reason: In words.
        circumstances: What it was like then, see `Circumstances`.
        failures: What did not lead on, by name.
    """

    reason: str
    circumstances: Hashable
    failures: tuple[Failure, ...] = ()


class Circumstances:
    """What goals depend on, as it is in a cycle.

    Goals that depend on the same predicates and skills, as those of one long-term goal do, share
    what is found out about them.

    Args:
        domain: The skills and concepts.
    """

    def __init__(self, domain: Domain) -> None:
        self._domain = domain
        self._kinds: dict[tuple[Condition, ...], _Kind] = {}
        self._moment: Moment | None = None
        self._now: dict[_Kind, Hashable] = {}
        self._before: dict[_Kind, Hashable] = {}

    def at(self, moment: Moment, goals: tuple[Condition, ...]) -> Hashable:
        """Give what makes two moments the same to goals: equal values, often the very same.

        Args:
            moment: What is known now.
            goals: What is to hold.
        """
        if moment is not self._moment:
            self._moment, self._before, self._now = moment, self._now, {}
        kind = self._kind_of(goals)
        if kind not in self._now:
            found, before = kind.at(moment), self._before.get(kind)
            self._now[kind] = before if before == found else found
        return self._now[kind]

    def _kind_of(self, goals: tuple[Condition, ...]) -> _Kind:
        kind = self._kinds.get(goals)
        if kind is None:
            found = relevance(self._domain, goals)
            measuring = tuple(clause for clause in found.skills if clause.tests)
            kind = _Kind(tuple(sorted({name for name, _ in found.signs})), measuring)
            self._kinds[goals] = kind
        return kind


@dataclass(frozen=True, slots=True)
class _Kind:
    """What some goals depend on: predicates, and skills whose start takes measuring."""

    predicates: tuple[str, ...]
    measuring: tuple[SkillClause, ...]

    def at(self, moment: Moment) -> Hashable:
        facts = moment.facts
        beliefs = frozenset(
            _as_known(fact)
            for predicate in self.predicates
            for ((_, fact, _),) in facts.rows(predicate).values()
        )
        if not self.measuring:
            return beliefs
        steps = moment.imagination.applicable(self.measuring, facts)
        return beliefs, frozenset(step.action for step in steps)


def _as_known(fact: Belief) -> Hashable:
    """Give a fact without its measured numbers."""
    values = fact.attributes.items()
    known = frozenset((name, value) for name, value in values if not isinstance(value, float))
    return fact.predicate, fact.args, known
