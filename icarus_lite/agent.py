"""The agent: one cycle, from percepts to a decision."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum

from icarus_lite.errors import FrameError
from icarus_lite.inference import (
    BeliefState,
    Change,
    Explanation,
    Functions,
    InferenceEngine,
    explain,
    given_memory,
)
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.syntax import Atom, Condition, Constant, Domain
from icarus_lite.planning import (
    Candidate,
    Imagination,
    NoPlan,
    PlanStep,
    candidates,
    find_plan,
    holds,
)
from icarus_lite.symbols import Action, Belief, Outcome, Percept, Status

MAX_ATTEMPTS = 3
"""How often one action may fail before the planner does without it."""


class DecisionKind(StrEnum):
    """What the agent has decided in a cycle."""

    ACT = "act"  # start the action
    CONTINUE = "continue"  # let the running action go on
    ABORT = "abort"  # stop the running action: what it relied on is no longer believed
    ACHIEVED = "achieved"  # all goals are believed
    IMPASSE = "impasse"  # nothing leads to the goals; the reason says why


@dataclass(frozen=True, slots=True)
class GoalStatus:
    """A goal and whether it is believed now."""

    goal: Condition
    satisfied: bool


@dataclass(frozen=True, slots=True)
class Decision:
    """What one cycle came to.

    Args:
        cycle: The cycle's number, from 0.
        kind: What to do.
        state: All beliefs of the cycle with their supports.
        added: Beliefs that were not held in the cycle before.
        removed: Beliefs that are no longer held.
        goals: Each goal and whether it is believed.
        path: The steps from here to the goals, the present one first.
        step: The step to start, continue or abort; None when there is none.
        reason: Why, in words.
        candidates: Where a plan was looked for, the skills that were considered for its first
            step, and why the others were not chosen.
    """

    cycle: int
    kind: DecisionKind
    state: BeliefState
    added: tuple[Belief, ...]
    removed: tuple[Belief, ...]
    goals: tuple[GoalStatus, ...]
    path: tuple[PlanStep, ...]
    step: PlanStep | None
    reason: str
    candidates: tuple[Candidate, ...] = ()

    @property
    def beliefs(self) -> tuple[Belief, ...]:
        """All beliefs of this cycle, sorted."""
        return self.state.beliefs

    @property
    def action(self) -> Action | None:
        """The action to start or to let run; None when there is nothing to do or it must stop."""
        going = self.kind in (DecisionKind.ACT, DecisionKind.CONTINUE)
        return self.step.action if going and self.step is not None else None

    @property
    def commands(self) -> tuple[Action, ...]:
        """The driver's commands for the action."""
        return self.step.commands if self.action is not None and self.step is not None else ()


class Agent:
    """Infers, watches its goals and chooses the next skill, once per cycle.

    Args:
        domain: A checked domain.
        goals: Literals as text or syntax, all to be achieved: `["(attached hubcover case)"]`.
        functions: Python predicates that `:tests` may call by name. They must be pure.
        given: Facts that are believed from the start, as in a task's `:init`. Percepts among
            them are left out: perception reports those itself.

    Raises:
        DomainError: a goal given as text does not parse.

    Example:
        >>> from icarus_lite.language import parse_domain
        >>> domain, _ = parse_domain("(percepts (lamp ^lit)) (concepts ((dark ?l)"
        ...     " :elements ((lamp ?l ^lit no))))")
        >>> agent = Agent(domain, goals=["(dark l1)"])
        >>> agent.cycle([Percept("lamp", "l1", {"lit": "no"})]).kind.value
        'achieved'
    """

    def __init__(
        self,
        domain: Domain,
        goals: Iterable[str | Condition] = (),
        *,
        functions: Functions | None = None,
        given: Iterable[Atom] = (),
    ) -> None:
        self.domain = domain
        self.goals: tuple[Condition, ...] = tuple(
            condition
            for goal in goals
            for condition in (parse_conditions(goal) if isinstance(goal, str) else (goal,))
        )
        self._engine = InferenceEngine(domain, functions)
        self._memory = given_memory(domain, given)
        self._path: tuple[PlanStep, ...] = ()
        self._running: PlanStep | None = None
        self._failures: dict[Action, list[str]] = {}
        self._candidates: tuple[Candidate, ...] = ()

    @property
    def state(self) -> BeliefState:
        """The beliefs of the last cycle."""
        return self._memory.state

    def cycle(
        self,
        percepts: Iterable[Percept],
        last_outcome: Outcome | Sequence[Outcome] | None = None,
    ) -> Decision:
        """Run one recognise-act cycle.

        Args:
            percepts: Everything perceived now, anchored objects that are hidden included.
            last_outcome: What became of the action decided on before (and of other agents'
                actions, in order); None if nothing is known of any.

        Raises:
            FrameError: a percept is malformed.
            InferenceError: a test of the domain cannot be evaluated.
        """
        outcomes = _as_outcomes(last_outcome)
        before = self._memory.state
        self._memory = self._engine.step(
            self._memory, percepts, outcomes, self._planned_changes(outcomes)
        )
        state = self._memory.state
        self._take_note(outcomes)
        self._candidates = ()
        kind, reason = self._decide(outcomes)
        if kind is DecisionKind.ACT:
            self._running = self._path[0]
        return Decision(
            state.cycle,
            kind,
            state,
            tuple(b for b in state.beliefs if b not in before),
            tuple(b for b in before.beliefs if b not in state),
            tuple(GoalStatus(goal, holds([goal], state.facts())) for goal in self.goals),
            self._path,
            self._running,
            reason,
            self._candidates,
        )

    def why(self, belief: str | Belief) -> Explanation:
        """Explain why a belief is held now, down to percepts and actions.

        Raises:
            FrameError: the text is not one belief without variables.
        """
        return explain(_as_belief(belief), self.state)

    def _planned_changes(self, outcomes: Sequence[Outcome]) -> dict[int, Change]:
        """Give the exact effects of our own action, whose clause and bindings we know."""
        running = self._running
        if running is None:
            return {}
        return {i: running.change for i, o in enumerate(outcomes) if o.action == running.action}

    def _take_note(self, outcomes: Sequence[Outcome]) -> None:
        for outcome in outcomes:
            ours = self._running is not None and outcome.action == self._running.action
            if not ours or outcome.status is Status.RUNNING:
                continue
            self._running = None
            if outcome.status is Status.FAILED:
                self._failures.setdefault(outcome.action, []).append(outcome.reason)
                self._path = ()
            else:
                self._path = self._path[1:]

    def _decide(self, outcomes: Sequence[Outcome]) -> tuple[DecisionKind, str]:
        facts = self.state.facts()
        if self._running is not None:
            broken = self._broken(self._running)
            if broken:
                return DecisionKind.ABORT, broken
            return DecisionKind.CONTINUE, f"{self._running.action} is running"
        if holds(self.goals, facts, evaluator=self._engine.evaluator):
            self._path = ()
            return DecisionKind.ACHIEVED, "all goals are believed"
        imagination = Imagination(
            self.domain, self._memory, self._engine.closure, self._engine.evaluator
        )
        if self._path:
            again = imagination.instances(self._path[0].clause, facts, dict(self._path[0].bindings))
            if any(True for _ in again):
                return DecisionKind.ACT, f"next step of the plan, {len(self._path)} to go"
        excluded = [a for a, reasons in self._failures.items() if len(reasons) >= MAX_ATTEMPTS]
        found = find_plan(self.domain, imagination, self.goals, excluded=excluded)
        self._candidates = tuple(candidates(self.domain, imagination, self.goals, found))
        if isinstance(found, NoPlan):
            self._path = ()
            given_up = [
                f"{a} failed {MAX_ATTEMPTS} times: {self._failures[a][-1]}" for a in excluded
            ]
            return DecisionKind.IMPASSE, "; ".join([found.reason, *given_up])
        self._path = found.steps
        failed = [o.reason for o in outcomes if o.status is Status.FAILED and o.reason]
        after = f" after a failure ({failed[-1]})" if failed else ""
        return DecisionKind.ACT, f"first of {len(found.steps)} steps to the goal{after}"

    def _broken(self, step: PlanStep) -> str:
        """Say what a running step relied on and is no longer believed; empty if nothing."""
        known, present = self._memory.known, {p.name for p in self.state.percepts}
        for argument in step.action.args:
            if argument in known and argument not in present:
                return f"{argument} is no longer anchored while {step.action} is running"
        facts, bindings = self.state.facts(), dict(step.bindings)
        for condition in step.clause.holds:
            if not holds([condition], facts, bindings, self._engine.evaluator):
                return f"{condition} no longer holds while {step.action} is running"
        return ""


def _as_outcomes(given: Outcome | Sequence[Outcome] | None) -> tuple[Outcome, ...]:
    if given is None:
        return ()
    return (given,) if isinstance(given, Outcome) else tuple(given)


def _as_belief(text: str | Belief) -> Belief:
    if isinstance(text, Belief):
        return text
    conditions = parse_conditions(text)
    if len(conditions) != 1 or conditions[0].negated:
        raise FrameError(f"expected one belief such as (attached o1 hand1), got {text}")
    atom = conditions[0].atom
    values = tuple(term.value for term in atom.args if isinstance(term, Constant))
    if len(values) != len(atom.args):
        raise FrameError(f"a belief has no variables: {text}")
    return Belief(atom.predicate, values)
