"""Rows: how many get through each step of a clause, and how long the step takes for them.

Each step of a plan is carried out for all rows at once before the next begins, so that its time is
its own. This evaluates every clause from scratch, with the join order and the indexes of the
compiled plan but not its generated code and its numeric kernels: it shows where rows multiply and
where they end. What the network itself spends on a clause is measured apart.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from time import thread_time
from typing import Final, cast

from icarus_lite.errors import InferenceError
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.explaining.lookup import OpenRow, Pattern
from icarus_lite.inference.expressions import Compiled, compile_test
from icarus_lite.inference.facts import FactStore
from icarus_lite.inference.profiling.plans import PlannedStep, RulePlan
from icarus_lite.inference.views import Row
from icarus_lite.language.syntax import variables_of
from icarus_lite.records import dataclass

MOST_ROWS: Final = 200_000
"""How many rows of a step are carried on; the profile says where it left rows out."""


@dataclass(frozen=True, slots=True)
class StepProfile:
    """What one step did in all cycles together.

    Args:
        step: The step.
        rows_in: How many rows came in.
        rows_out: How many went on.
        seconds: How long it took.
        cut: Whether rows were left out because there were too many.
    """

    step: PlannedStep
    rows_in: int
    rows_out: int
    seconds: float
    cut: bool


@dataclass(frozen=True, slots=True)
class ClauseProfile:
    """What one clause did in all cycles together.

    Args:
        plan: The clause and its plan.
        steps: Its steps.
        cycles: How many cycles were looked at.
    """

    plan: RulePlan
    steps: tuple[StepProfile, ...]
    cycles: int

    @property
    def seconds(self) -> float:
        """How long the clause took in all."""
        return sum(each.seconds for each in self.steps)

    @property
    def rows(self) -> int:
        """How many rows got through: derivations, not beliefs."""
        return self.steps[-1].rows_out if self.steps else self.cycles

    @property
    def widest(self) -> StepProfile | None:
        """The step behind which most rows have to be dealt with; the first of equal ones."""
        return max(self.steps, key=lambda each: each.rows_out, default=None)


@dataclass(slots=True)
class _Tally:
    rows_in: int = 0
    rows_out: int = 0
    seconds: float = 0.0
    cut: bool = False


class Profiler:
    """Adds up, cycle by cycle, what each step of some clauses does.

    Args:
        plans: The clauses.
        evaluator: Evaluates their tests.
        most_rows: How many rows of a step are carried on.
    """

    def __init__(
        self,
        plans: Sequence[RulePlan],
        evaluator: Evaluator | None = None,
        most_rows: int = MOST_ROWS,
    ) -> None:
        self._plans = plans
        self._evaluator = evaluator or Evaluator()
        self._most = most_rows
        self._tallies = [[_Tally() for _ in plan.steps] for plan in plans]
        self._cycles = 0

    def observe(self, facts: FactStore) -> None:
        """Evaluate all clauses over the facts of one cycle, all its beliefs included."""
        self._cycles += 1
        for plan, tallies in zip(self._plans, self._tallies, strict=True):
            self._run(plan, tallies, facts)

    def profiles(self) -> tuple[ClauseProfile, ...]:
        """Give what has been added up, in the order of the plans."""
        return tuple(
            ClauseProfile(
                plan,
                tuple(
                    StepProfile(step, each.rows_in, each.rows_out, each.seconds, each.cut)
                    for step, each in zip(plan.steps, tallies, strict=True)
                ),
                self._cycles,
            )
            for plan, tallies in zip(self._plans, self._tallies, strict=True)
        )

    def _run(self, plan: RulePlan, tallies: Sequence[_Tally], facts: FactStore) -> None:
        names = dict.fromkeys(
            name
            for step in plan.steps
            for name in (
                *(v for atom in step.atoms for v in atom.variables),
                *(v for test in step.tests for v in variables_of(test)),
            )
        )
        slots = {name: slot for slot, name in enumerate(names)}
        rows: list[OpenRow] = [[None] * len(slots)]
        for step, tally in zip(plan.steps, tallies, strict=True):
            work = _Work.of(step, slots, facts, self._evaluator)
            begun = thread_time()
            out, cut = work.carry_out(rows, self._most)
            tally.seconds += thread_time() - begun
            tally.rows_in += len(rows)
            tally.rows_out += len(out)
            tally.cut |= cut
            rows = out


@dataclass(frozen=True, slots=True)
class _Work:
    """One step, ready to be carried out on one cycle's facts."""

    patterns: tuple[Pattern, ...]
    tests: tuple[Compiled, ...]
    negated: bool

    @classmethod
    def of(
        cls, step: PlannedStep, slots: dict[str, int], facts: FactStore, evaluator: Evaluator
    ) -> _Work:
        return cls(
            tuple(Pattern(atom, slots, facts) for atom in step.atoms),
            tuple(
                compile_test(test, slots, evaluator.functions, evaluator.path)
                for test in step.tests
            ),
            step.negated,
        )

    def carry_out(self, rows: Iterable[OpenRow], most: int) -> tuple[list[OpenRow], bool]:
        """Give the rows that get through, and whether some were left out."""
        if self.negated:
            (pattern,) = self.patterns
            return [row for row in rows if not pattern.find(row)[0]], False
        out: list[OpenRow] = []
        for row in rows:
            for extended in self._extensions(row, self.patterns):
                if all(_holds(test, extended) for test in self.tests):
                    if len(out) == most:
                        return out, True
                    out.append(extended)
        return out, False

    def _extensions(self, row: OpenRow, patterns: Sequence[Pattern]) -> Iterable[OpenRow]:
        if not patterns:
            yield row
            return
        pattern, *others = patterns
        entries, free = pattern.find(row)
        for values, _, _ in entries:
            extended = list(row)
            for slot, value in zip(free, values, strict=True):
                extended[slot] = value
            yield from self._extensions(extended, others)


def _holds(test: Compiled, row: OpenRow) -> bool:
    """Ask a test; one that has no value lets nothing through.

    The engine has been through these facts already, so that it never came to asking it.
    """
    try:
        return bool(test(cast("Row", row)))
    except InferenceError:
        return False
