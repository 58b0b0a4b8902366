"""Why a skill was not taken up: kept cheaply while choosing, put into words only if asked."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.execution.effects import missing_effect
from icarus_lite.execution.path import Bound
from icarus_lite.execution.repertoire import Skill
from icarus_lite.inference import Evaluator, FactStore, bind_pattern, first_obstacle
from icarus_lite.planning import Candidate, Failure, FailureReason
from icarus_lite.records import dataclass

MOST_SHOWN = 8
"""How many refusals are put into words; a deep recursion can have hundreds, all alike."""


@dataclass(frozen=True, slots=True)
class Refusal:
    """A skill instance that was considered and not taken up.

    Args:
        reason: The name of the reason.
        skill: The clause.
        bindings: What was bound when it was refused.
        text: The reason in words, where it does not follow from the beliefs.
    """

    reason: FailureReason
    skill: Skill
    bindings: Bound
    text: str = ""

    @property
    def instance(self) -> str:
        """The skill with what is bound filled in."""
        return str(bind_pattern(self.skill.clause.head, dict(self.bindings)))

    def explained(self, facts: FactStore, evaluator: Evaluator) -> Failure:
        """Say what was in the way: the first condition that failed, the effect that is missing."""
        return Failure(self.reason, f"{self.instance}: {self._why(facts, evaluator)}")

    def _why(self, facts: FactStore, evaluator: Evaluator) -> str:
        clause, bindings = self.skill.clause, dict(self.bindings)
        if self.reason is FailureReason.CONDITIONS_UNSATISFIED:
            obstacle = first_obstacle(clause.elements, clause.tests, facts, bindings, evaluator)
            return str(obstacle) if obstacle is not None else "no way to bind it fits its caller"
        if self.reason is FailureReason.WHILE_BROKEN:
            obstacle = first_obstacle(clause.holds, (), facts, bindings, evaluator)
            return str(obstacle) if obstacle is not None else self.text
        if self.reason is FailureReason.MACRO_EXHAUSTED:
            missing = missing_effect(self.skill.effects, bindings, facts)
            return f"all its subskills are done, but {missing} is not believed"
        return self.text


def explained(
    refusals: Iterable[Refusal], facts: FactStore, evaluator: Evaluator
) -> tuple[Failure, ...]:
    """Put refusals into words, each once, the first few of them."""
    failures: dict[Failure, None] = {}
    for refusal in dict.fromkeys(refusals):
        failures[refusal.explained(facts, evaluator)] = None
        if len(failures) == MOST_SHOWN:
            break
    return tuple(failures)


def as_candidates(
    refusals: Iterable[Refusal], facts: FactStore, evaluator: Evaluator
) -> tuple[Candidate, ...]:
    """Give refusals as skills that were considered and not chosen."""
    return tuple(
        Candidate(refusal.instance, chosen=False, why_not=str(refusal.explained(facts, evaluator)))
        for refusal in list(dict.fromkeys(refusals))[:MOST_SHOWN]
    )
