"""Nomination: which of the domain's long-term goals matter now, and about what.

A long-term goal is general, `(clean ?table)`; its relevance, `((dirty ?table))`, is matched against
the beliefs of a cycle, and each way in which it holds nominates a goal about certain objects.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.errors import InferenceError
from icarus_lite.goals.goal import Goal
from icarus_lite.inference import Evaluator, FactStore, Matcher, bind_pattern
from icarus_lite.language.syntax import Condition, LongTermGoal, Variable
from icarus_lite.symbols import Value, format_value, is_number


class Nominator:
    """Nominates goals by their relevance.

    Args:
        goals: The long-term goals of a domain, their names unique.
        evaluator: Evaluates the tests of the domain.
    """

    def __init__(self, goals: Sequence[LongTermGoal], evaluator: Evaluator) -> None:
        self._goals = tuple(
            (goal, Matcher(goal.relevance, evaluator=evaluator), _names_in(goal.goals))
            for goal in goals
        )

    def nominated(self, facts: FactStore) -> dict[str, Goal]:
        """Give the goals that matter now by their names, in the order of domain and beliefs.

        Two ways in which a relevance holds are one goal if they agree on what is to hold; the
        greater of their priorities counts.

        Raises:
            InferenceError: a priority is no number.
        """
        found: dict[str, Goal] = {}
        for goal, relevance, names in self._goals:
            for match in relevance.matches(facts):
                bound = {name: match.bindings[name] for name in names if name in match.bindings}
                instance = _instance(goal, bound, match.bindings)
                known = found.setdefault(instance.name, instance)
                if instance.priority > known.priority:
                    found[instance.name] = instance
        return found


def _instance(goal: LongTermGoal, bound: Mapping[str, Value], match: Mapping[str, Value]) -> Goal:
    conditions = tuple(
        Condition(bind_pattern(each.atom, bound), each.negated, each.span) for each in goal.goals
    )
    name = " ".join([goal.name, *map(format_value, bound.values())])
    return Goal(name, conditions, _priority(goal, match), goal.maintain, is_long_term=True)


def _priority(goal: LongTermGoal, match: Mapping[str, Value]) -> float:
    if not isinstance(goal.priority, Variable):
        return goal.priority
    value = match[goal.priority.name]
    if not is_number(value):
        raise InferenceError(
            f"the priority of the long-term goal `{goal.name}` is {format_value(value)}, "
            f"to which its relevance binds {goal.priority}; expected a number"
        )
    return float(value)


def _names_in(conditions: Sequence[Condition]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(_each(conditions)))


def _each(conditions: Sequence[Condition]) -> Iterator[str]:
    for condition in conditions:
        yield from condition.atom.variables
