"""What one cycle comes to."""

from __future__ import annotations

from enum import StrEnum

from icarus_lite.execution.path import SkillPath
from icarus_lite.execution.plan_following import PlanStatus
from icarus_lite.execution.requests import Request
from icarus_lite.inference import BeliefState, Withdrawal
from icarus_lite.language.syntax import Atom, Condition
from icarus_lite.planning import Candidate, Failure, PlanStep
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action, Belief


class DecisionKind(StrEnum):
    """What the agent has decided in a cycle."""

    ACT = "act"  # start the action
    CONTINUE = "continue"  # let the running action go on
    ABORT = "abort"  # stop the running action: what it relied on is no longer believed
    ACHIEVED = "achieved"  # all goals are believed, all intentions carried out
    IMPASSE = "impasse"  # nothing leads to the goals; the reason says why
    REQUEST = "request"  # ask another agent to do something, and keep still
    AWAIT = "await"  # keep still until another agent has done something


@dataclass(frozen=True, slots=True)
class GoalStatus:
    """A goal and whether it is believed now."""

    goal: Condition
    satisfied: bool


class Standing(StrEnum):
    """How a top-level goal stands among the others."""

    NOMINATED = "nominated"  # it matters, and waits for its turn
    PURSUED = "pursued"  # what is done now is done for it
    SATISFIED = "satisfied"  # it is believed, and kept up
    SUSPENDED = "suspended"  # nothing leads to it now; it is tried again when that changes
    DROPPED = "dropped"  # it is a goal no longer


@dataclass(frozen=True, slots=True)
class GoalReport:
    """A top-level goal and how it stands.

    Args:
        name: What it is called.
        goals: What is to hold, all of it.
        priority: How much it matters; greater comes first.
        maintain: Whether it is kept up once it is reached.
        standing: How it stands.
        reason: Why, in words, where there is something to say.
    """

    name: str
    goals: tuple[Condition, ...]
    priority: float
    maintain: bool
    standing: Standing
    reason: str = ""


@dataclass(frozen=True, slots=True)
class GoalChange:
    """A goal that somebody has added or removed since the cycle before.

    Args:
        name: What it is called.
        goals: What is to hold; nothing for a goal that was removed.
        priority: How much it matters.
        maintain: Whether it is kept up once it is reached.
    """

    name: str
    goals: tuple[Condition, ...] = ()
    priority: float = 0.0
    maintain: bool = False


@dataclass(frozen=True, slots=True)
class IntentionStatus:
    """A skill that the agent is to carry out, and whether it has been."""

    skill: Atom
    done: bool


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
        path: The plan: the primitive steps from here to the goals, the present one first. Where
            skills lead the way, no plan is made, and the present step is all there is.
        step: The step to start, continue or abort; None when there is none.
        reason: Why, in words.
        candidates: Where a plan was looked for, the skills that were considered for its first
            step, and why the others were not chosen.
        skill_path: What the present step is for, level by level: goal or intention, macro skills,
            primitive, each with its clause and bindings. None when there is no step.
        intentions: Each skill that the agent is to carry out, and whether it has been.
        failures: What did not lead on in this cycle, by name; where the action is aborted, or
            nothing leads on, the first is why.
        plan: The plan that is being followed, with its causal links, and what has become of it
            in this cycle; None where skills lead the way.
        agenda: Each top-level goal and how it stands, those that were dropped in this cycle
            included.
        request: What another agent is asked for, or is waited for.
        told: The goals that were added and removed since the cycle before, in order.
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
    skill_path: SkillPath | None = None
    intentions: tuple[IntentionStatus, ...] = ()
    failures: tuple[Failure, ...] = ()
    plan: PlanStatus | None = None
    agenda: tuple[GoalReport, ...] = ()
    request: Request | None = None
    told: tuple[GoalChange, ...] = ()

    @property
    def beliefs(self) -> tuple[Belief, ...]:
        """All beliefs of this cycle, sorted."""
        return self.state.beliefs

    @property
    def withdrawn(self) -> tuple[Withdrawal, ...]:
        """What would have persisted, and is withdrawn in this cycle, with what contradicts it."""
        return self.state.withdrawn

    @property
    def action(self) -> Action | None:
        """The action to start or to let run; None when there is nothing to do or it must stop."""
        going = self.kind in (DecisionKind.ACT, DecisionKind.CONTINUE)
        return self.step.action if going and self.step is not None else None

    @property
    def commands(self) -> tuple[Action, ...]:
        """The driver's commands for the action."""
        return self.step.commands if self.action is not None and self.step is not None else ()
