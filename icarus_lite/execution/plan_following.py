"""Following a plan: does it still work, does some rest of it, or is it to be given up?

A plan says what is to be believed before each of its steps. When the beliefs are others, that is a
surprise. Most surprises do not matter: what no remaining step and no goal rests on may be as it
likes. After one that matters the plan may still work in another way; a later step may be possible
already, because somebody has helped; or an earlier one may have to be done once more.

Source: triangle tables and their kernels (Fikes, Hart and Nilsson 1972) say which beliefs matter.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from enum import StrEnum

from icarus_lite.execution.moment import Moment
from icarus_lite.language.syntax import Condition
from icarus_lite.planning import (
    Plan,
    PlanStep,
    Projection,
    Requirement,
    Rest,
    later_start,
    pattern_of,
    project,
    rebound,
    sparse_rest,
    unmet,
    with_links,
    working_rest,
)
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import Action, Belief

MOST_NAMED = 3
"""How many surprising beliefs are named in a sentence."""


class Verdict(StrEnum):
    """What monitoring has come to about a plan."""

    MADE = "made"  # it is new
    UNDER_WAY = "under-way"  # a step of it is running
    KEPT = "kept"  # it goes on as it is
    REPAIRED = "repaired"  # it goes on elsewhere: steps are skipped, or done once more
    REPLANNED = "replanned"  # it is new, in place of one that no longer worked


@dataclass(frozen=True, slots=True)
class PlanStatus:
    """A plan that is being followed, and how it stands.

    Args:
        plan: The whole plan with its links, steps that are done included.
        position: The step that is next, or under way, from 0.
        verdict: What monitoring has come to in this cycle.
        text: That in words.
        surprises: The beliefs that are not as the plan had them and were the cycle before.
        changed: Whether its steps or links are others than in the cycle before.
    """

    plan: Plan
    position: int
    verdict: Verdict
    text: str
    surprises: tuple[Condition, ...] = ()
    changed: bool = False


@dataclass(frozen=True, slots=True)
class PlanCounts:
    """What has become of plans so far.

    Args:
        made: Plans made.
        surprises: Times at which beliefs were not as the plan had them.
        kept: Surprises after which the plan went on as it was.
        repaired: Surprises after which it went on elsewhere.
        replanned: Surprises after which it was given up.
    """

    made: int = 0
    surprises: int = 0
    kept: int = 0
    repaired: int = 0
    replanned: int = 0

    def after(self, verdict: Verdict) -> PlanCounts:
        """Count one more surprise, and what has become of the plan."""
        return PlanCounts(
            self.made,
            self.surprises + 1,
            self.kept + (verdict is Verdict.KEPT),
            self.repaired + (verdict is Verdict.REPAIRED),
            self.replanned + (verdict is Verdict.REPLANNED),
        )


class PlanFollower:
    """Follows one plan at a time.

    Afterwards `counts` has what has become of plans, and `status` how the present one stands.
    """

    def __init__(self) -> None:
        self.counts = PlanCounts()
        self.status: PlanStatus | None = None
        self._expected: dict[int, frozenset[Belief]] = {}
        self._known: frozenset[Condition] = frozenset()
        self._lost = ""

    @property
    def rest(self) -> tuple[PlanStep, ...]:
        """The steps still to be done, the one under way included; none without a plan."""
        return () if self.status is None else self.status.plan.steps[self.status.position :]

    @property
    def words(self) -> str:
        """Why the present step is taken, as a sentence."""
        going = f"next step of the plan, {len(self.rest)} to go"
        if self.status is None or not self.status.surprises or not self.status.changed:
            return going  # what nothing rests on is in the status, for who asks
        return f"{going}; {self.status.verdict}: {self.status.text}"

    def take_up(self, plan: Plan, moment: Moment) -> PlanStep:
        """Follow a plan from its first step on, and give that step as it is bound now.

        Args:
            plan: A plan of at least one step that works from the beliefs of now.
            moment: What is known now.
        """
        projection = project(moment.imagination, plan.steps, plan.goals)
        plan = with_links(moment.imagination, plan, projection)
        self._expect(0, projection)
        verdict = Verdict.REPLANNED if self._lost else Verdict.MADE
        self.status = PlanStatus(plan, 0, verdict, self._lost or "it is new", changed=True)
        self.counts = replace(self.counts, made=self.counts.made + 1)
        self._known = self._differences(moment)
        self._lost = ""
        return plan.steps[0]

    def drop(self, why: str = "") -> None:
        """Follow the plan no longer.

        Args:
            why: What was wrong with it, which is why another is made; empty if nothing was.
        """
        if self.status is not None or not why:
            self._lost = why
        self.status = None

    def goes_on(self, step: PlanStep) -> None:
        """Note that the present step is running, or is carried out once more."""
        if self.status is not None:
            plan = self.status.plan.rebound(self.status.position, [step])
            text = f"step {self.status.position + 1} is under way"
            self.status = replace(
                self.status,
                plan=plan,
                verdict=Verdict.UNDER_WAY,
                text=text,
                surprises=(),
                changed=False,
            )

    def step_ended(self) -> None:
        """Move on to the next step; with none left, the plan is carried through."""
        if len(self.rest) <= 1:
            self.drop()
        elif self.status is not None:
            self.status = replace(self.status, position=self.status.position + 1)

    def review(self, moment: Moment, given_up: Collection[Action]) -> PlanStep | None:
        """Compare beliefs with what the plan expects; keep it, repair it, or give it up.

        Args:
            moment: What is known now, with nothing under way.
            given_up: Actions that must not be used any longer.

        Returns:
            The step to begin now; None without a plan, or if it has been given up.
        """
        status = self.status
        if status is None:
            return None
        plan, position = status.plan, status.position
        before, self._known = self._known, self._differences(moment)
        surprises = tuple(sorted(self._known - before, key=str))
        broken = unmet(plan, position, moment.facts)
        step = None if broken else _startable(plan.steps[position], moment, given_up)
        if step is not None and not surprises:
            self.status = _kept(status, step, "as expected", ())
            return step
        if step is None:
            why = _complaint(plan, broken, position)
            rest = working_rest(moment.imagination, plan, given_up)
            if rest is None:
                rest = sparse_rest(moment.imagination, plan, position, given_up)
        else:
            why = _named(surprises)
            rest = later_start(moment.imagination, plan, position, given_up)
        if rest is not None:
            self._go_on_with(rest, position, why, surprises)
            self._known = self._differences(moment)
        elif step is not None:
            self.status = _kept(status, step, f"{why}: nothing rests on it", surprises)
        else:
            self.drop(why)
        verdict = Verdict.REPLANNED if self.status is None else self.status.verdict
        self.counts = self.counts.after(verdict)
        return self.rest[0] if self.rest else None

    def _go_on_with(
        self, rest: Rest, position: int, why: str, surprises: tuple[Condition, ...]
    ) -> None:
        """Follow the rest of the plan that works."""
        self._expect(rest.position, rest.projection)
        same = rest.start == position and not rest.left_out
        verdict = Verdict.KEPT if same else Verdict.REPAIRED
        text = f"{why}: {_way_on(rest, position)}"
        self.status = PlanStatus(rest.plan, rest.position, verdict, text, surprises, changed=True)

    def _expect(self, position: int, projection: Projection) -> None:
        """Take down what is to be believed before each step from one on."""
        stages = enumerate(projection.stages, position)
        self._expected.update((number, stage.beliefs) for number, stage in stages)

    def _differences(self, moment: Moment) -> frozenset[Condition]:
        """Give what is not as the plan has it: beliefs it did not expect, and such as are missing.

        Literals say how things are, not how they were expected to be.
        """
        held = moment.beliefs
        expected = held if self.status is None else self._expected.get(self.status.position, held)
        more = [Condition(pattern_of(belief)) for belief in held - expected]
        less = [Condition(pattern_of(belief), negated=True) for belief in expected - held]
        return frozenset([*more, *less])


def _startable(step: PlanStep, moment: Moment, given_up: Collection[Action]) -> PlanStep | None:
    """Bind a step anew; None if it could not start now, or must not be used."""
    if step.action in given_up:
        return None
    return rebound(moment.imagination, step, moment.facts)


def _kept(
    status: PlanStatus, step: PlanStep, text: str, surprises: tuple[Condition, ...]
) -> PlanStatus:
    plan = status.plan.rebound(status.position, [step])
    return PlanStatus(plan, status.position, Verdict.KEPT, text, surprises)


def _named(surprises: Sequence[Condition]) -> str:
    shown = ", ".join(map(str, surprises[:MOST_NAMED]))
    more = len(surprises) - MOST_NAMED
    return f"surprise {shown}" + (f" and {more} more" if more > 0 else "")


def _complaint(plan: Plan, broken: Sequence[Requirement], position: int) -> str:
    """Say what is wrong with a plan: what it rests on and is not so."""
    if not broken:
        return f"step {position + 1} {plan.steps[position].action} cannot start"
    first = broken[0]
    whose = "the goal"
    if first.consumer is not None:
        whose = f"step {first.consumer + 1} {plan.steps[first.consumer].action}"
    return f"{first} is not so, on which {whose} rests"


def _way_on(rest: Rest, position: int) -> str:
    if rest.left_out:
        steps = "step is" if rest.left_out == 1 else "steps are"
        return f"{rest.left_out} {steps} left out"
    if rest.start == position:
        return "the rest of the plan works all the same"
    step = rest.plan.steps[rest.position].action
    if rest.start < position:
        return f"back to step {rest.start + 1} {step}"
    return f"the plan goes on with step {rest.start + 1} {step}"
