"""Imagining only what a plan can change: the rest is looked up in the beliefs of now."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference import Closure, Hierarchy
from icarus_lite.language.syntax import Condition, Domain
from icarus_lite.planning.situation import Imagination, Situation
from icarus_lite.planning.steps import PlanStep
from icarus_lite.symbols import ATTACHED


class Focus(Imagination):
    """An imagination that derives anew only what may change.

    Args:
        imagination: The beliefs of now.
        domain: Its attachments count.
        closure: The concepts that rest on what may change, as far as anybody asks for them.
        fluents: The predicates whose facts may change.
    """

    __slots__ = ()

    def __init__(
        self,
        imagination: Imagination,
        domain: Domain,
        closure: Closure,
        fluents: frozenset[str],
    ) -> None:
        self.evaluator = imagination.evaluator
        self._domain, self._closure = domain, closure
        self._percepts = tuple(b for b in imagination.percepts if b.predicate in fluents)
        self._matchers = {}
        self._fixed = imagination.now, {}, fluents
        begin = imagination.start
        asserted = frozenset(b for b in begin.asserted if b.predicate in fluents)
        hierarchy = begin.hierarchy if ATTACHED in fluents else Hierarchy()
        self.start = Situation(asserted, hierarchy)
        self._at_start = self._latest = None

    def bears_out(self, steps: Sequence[PlanStep], goals: Sequence[Condition]) -> str:
        """Carry out a plan; give what does not work about it, empty if it leads to its goals."""
        situation = self.start
        facts = self.facts(situation)
        for step in steps:
            if not any(True for _ in self.instances(step.clause, facts, dict(step.bindings))):
                return f"{step.action} cannot start"
            situation = self.after(situation, step)
            facts = self.facts(situation)
        if self.holds(goals, facts):
            return ""
        missing = [str(goal) for goal in goals if not self.holds([goal], facts)]
        return f"{' '.join(missing or map(str, goals))} does not hold in the end"
