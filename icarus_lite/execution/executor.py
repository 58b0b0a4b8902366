"""The executor: keeps to its skill path or plan, and chooses anew when that ends or falls.

Skills come first: a path from a goal or an intended skill down to a primitive that can act now.
Only on an impasse, when no skill leads on from the beliefs of now, is planning asked; its plan is
then followed as long as its next step can start.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence

from icarus_lite.execution.choice import Choice
from icarus_lite.execution.choosing import obstacle, path_to_goals, path_to_skill
from icarus_lite.execution.decision import DecisionKind
from icarus_lite.execution.experience import Experience
from icarus_lite.execution.moment import Moment
from icarus_lite.execution.monitoring import Execution, Fate, Judgement, judge
from icarus_lite.execution.path import Aim, Level, SkillPath
from icarus_lite.execution.persistence import carry_on, first_fallen
from icarus_lite.execution.plan_following import PlanCounts, PlanFollower
from icarus_lite.execution.refusal import as_candidates, explained
from icarus_lite.execution.repertoire import Repertoire
from icarus_lite.execution.requests import Request, is_needless, judge_request, request_for
from icarus_lite.execution.selection import Selection
from icarus_lite.inference import Evaluator
from icarus_lite.language.syntax import Atom, Condition, Domain
from icarus_lite.outcomes import Outcome
from icarus_lite.planning import (
    Candidate,
    Failure,
    FailureReason,
    NoPlan,
    Plan,
    PlanningDomain,
    PlanStep,
    candidates,
    find_plan,
    plan_step,
)
from icarus_lite.records import replace
from icarus_lite.symbols import Action


class Executor:
    """Carries out intentions, one after the other, then pursues goals.

    A goal is a state: what leads to it ends once all goals are believed. An intention is a skill:
    it is carried out to its end, all its subskills, unless what it is for is believed before it
    is begun.

    Args:
        domain: The skills and what else plans are made of.
        evaluator: Evaluates the tests of the domain.
        goals: Literals to be achieved, all of them.
        intentions: Skills to be carried out, in this order.
    """

    def __init__(
        self,
        domain: Domain,
        evaluator: Evaluator,
        goals: Sequence[Condition],
        intentions: Sequence[Atom] = (),
    ) -> None:
        self._evaluator = evaluator
        self._planning = PlanningDomain(domain, evaluator)
        self._repertoire = Repertoire(domain, evaluator)
        self._goals = tuple(goals)
        self._intentions = tuple(intentions)
        self._carried_out = 0
        self._following = PlanFollower()
        self._planned_in: Hashable = None
        self._path: SkillPath | None = None
        self._running: Execution | None = None
        self._request: Request | None = None
        self._experience = Experience()

    @property
    def running(self) -> PlanStep | None:
        """The primitive skill under way, or asked for, if any."""
        return None if self._running is None else self._running.step

    @property
    def carried_out(self) -> int:
        """How many of the intentions, in their order, have been carried out."""
        return self._carried_out

    @property
    def plan_counts(self) -> PlanCounts:
        """What has become of plans so far: made, kept, repaired and replanned after surprises."""
        return self._following.counts

    @property
    def intention(self) -> Atom | None:
        """The skill to be carried out next, or under way; None if all have been."""
        return next(iter(self._intentions[self._carried_out :]), None)

    @property
    def given_up(self) -> frozenset[Action]:
        """The actions that are not to be used now."""
        return frozenset(self._experience.given_up)

    def settle(
        self, moment: Moment, outcomes: Sequence[Outcome]
    ) -> tuple[Choice | None, tuple[Failure, ...]]:
        """See what has become of the step under way: the first half of deciding.

        Args:
            moment: What is known now, the outcomes taken into account.
            outcomes: What became of actions since the last cycle.

        Returns:
            The choice if the step goes on, is awaited or has to be stopped, None if there is none
            or it has come to its end; and what went wrong with it.
        """
        self._experience.end_pauses(moment.cycle, moment.time_s)
        if self._running is None:
            return None, ()
        judgement = self._judge(self._running, outcomes, moment)
        going = self._keep_going(self._running, judgement, moment)
        if going is not None:
            return going, ()
        failures = () if judgement.failure is None else (judgement.failure,)
        return None, failures + self._come_to_end(judgement.fate, moment)

    def choose(self, moment: Moment, failures: tuple[Failure, ...] = ()) -> Choice:
        """Choose the next step, with none under way: the second half of deciding.

        Args:
            moment: What is known now.
            failures: What went wrong with the step that has come to its end.
        """
        choice = self._choose(moment, failures)
        if self._is_done_unasked(choice, moment):
            choice = self._choose(moment, failures + self._come_to_end(Fate.FINISHED, moment))
        if choice.kind is not DecisionKind.ACT or choice.step is None:
            return choice
        self._running = Execution(choice.step, moment.scene, moment.time_s)
        request = self._request = request_for(choice.step, moment.cycle)
        return choice if request is None else choice.asking(request)

    def pursue(self, goals: Sequence[Condition], *, afresh: bool = False) -> None:
        """Pursue other goals from now on; path and plan for those before are given up.

        Args:
            goals: What is to be achieved, all of it.
            afresh: Whether to forget what was begun on the way to the goals before.
        """
        self._goals = tuple(goals)
        self._path = None
        self._following.drop()
        if afresh:
            self._experience.forget_beginnings()

    @property
    def is_under_way(self) -> bool:
        """Whether there is a path or a plan that is being followed."""
        return self._path is not None or self._following.status is not None

    def obstacle(self, goals: Sequence[Condition], moment: Moment) -> NoPlan | None:
        """Say why nothing leads to some goals from here, or None if something does.

        Nothing is changed by asking: path and plan stay as they are.
        """
        selection = Selection(self._repertoire, moment, self._experience)
        return obstacle(self._planning, selection, goals, moment, self._experience)

    def withdraw(self) -> None:
        """Wait no longer for what another agent was asked for."""
        if self._request is not None:
            self._running, self._request = None, None

    def _is_done_unasked(self, choice: Choice, moment: Moment) -> bool:
        """Tell whether another agent has done already what it would be asked for."""
        if choice.step is None or choice.step.clause.agent is None:
            return False
        skill = self._repertoire.of(choice.step.clause)
        is_done = skill.is_done(moment.facts, dict(choice.step.bindings))
        return is_done or is_needless(self._following.status, moment)

    # The primitive skill under way.

    def _judge(
        self, execution: Execution, outcomes: Sequence[Outcome], moment: Moment
    ) -> Judgement:
        """Say what becomes of the skill under way, and learn from it."""
        action = execution.step.action
        ours = [outcome for outcome in outcomes if outcome.action == action]
        skill, outcome = self._repertoire.of(execution.step.clause), ours[-1] if ours else None
        if self._request is None:
            judgement = judge(execution, skill, outcome, moment)
        else:
            judgement = judge_request(execution, self._request, skill, outcome, moment)
        if judgement.fate is Fate.FINISHED:
            self._experience.note_success(action)
        elif self._request is not None:
            if judgement.failure is not None:
                why = judgement.failure.text
                self._experience.note_declined(action, why, moment.cycle, moment.time_s)
        elif judgement.fate is Fate.FAILED:
            self._experience.note_failure(action, ours[-1].reason)
        elif judgement.disappoints and judgement.failure is not None:
            why = judgement.failure.text
            self._experience.note_disappointment(action, execution.scene, why)
        return judgement

    def _keep_going(
        self, execution: Execution, judgement: Judgement, moment: Moment
    ) -> Choice | None:
        """Decide on a skill that is still under way; None if it has come to its end."""
        fate, failure, step = judgement.fate, judgement.failure, execution.step
        macros = () if self._path is None else self._path.levels[:-1]
        fallen = first_fallen(self._repertoire, macros, moment)
        if self._request is not None:
            is_over = fate is not Fate.GOES_ON or fallen is not None or self._is_all_done(moment)
            if is_over or is_needless(self._following.status, moment):
                return None
            self._following.goes_on(step)
            choice = self._choice(DecisionKind.AWAIT, f"waiting: {self._request.text}", step)
            return replace(choice, request=self._request)
        if fate is Fate.GOES_ON and fallen is not None:
            fate, failure = Fate.BREAK_OFF, fallen[1]
        if fate is Fate.GOES_ON:
            self._following.goes_on(step)
            return self._choice(DecisionKind.CONTINUE, f"{step.action} is running", step)
        if fate is Fate.BREAK_OFF and failure is not None:
            self._running = replace(execution, stopping=True)
            self._following.goes_on(step)
            return self._choice(DecisionKind.ABORT, failure.text, step, (failure,))
        given_up = step.action in self._experience.given_up
        if fate is not Fate.REPEAT or fallen is not None or given_up or self._is_all_done(moment):
            return None
        return self._repeat(execution, failure, moment)

    def _repeat(self, execution: Execution, failure: Failure | None, moment: Moment) -> Choice:
        """Carry a skill out once more, with the values of attributes as they are now."""
        step = self._again(execution.step, moment) or execution.step
        self._running = replace(execution, step=step, scene=moment.scene)
        if self._path is None:
            self._following.goes_on(step)
        else:
            *macros, last = self._path.levels
            levels = (*macros, replace(last, bindings=step.bindings))
            self._path = replace(self._path, levels=levels, step=step)
        reason = "once more" if failure is None else f"once more: {failure.text}"
        return self._choice(DecisionKind.ACT, reason, step, () if failure is None else (failure,))

    def _come_to_end(self, fate: Fate, moment: Moment) -> tuple[Failure, ...]:
        """Move path or plan on after the primitive has come to its end; say what was given up."""
        self._running, self._request = None, None
        if self._path is None:
            self._move_plan_on(fate)
            return ()
        selection = Selection(self._repertoire, moment, self._experience)
        finished = fate is Fate.FINISHED
        progress = carry_on(
            self._repertoire, selection, self._path.levels, moment, finished=finished
        )
        aims, self._path = self._path.aims, None
        if progress.levels:
            self._path = self._take(aims, progress.levels, progress.kept, moment)
        elif progress.completed and aims == (self.intention,):
            self._note_carried_out()
        return tuple(selection.failures)

    def _move_plan_on(self, fate: Fate) -> None:
        """Go on to the next step of the plan, unless this one has to be done without."""
        step, *after = self._following.rest
        if fate is Fate.FAILED:
            self._following.drop(f"{step.action} has failed")
        elif step.action in self._experience.given_up:
            self._following.drop(f"{step.action} is given up")
        else:
            self._following.step_ended()
        if fate is Fate.FINISHED and not after:
            self._experience.note_plan_carried_through(self._planned_in)

    # What to do next, when nothing is under way.

    def _choose(self, moment: Moment, failures: tuple[Failure, ...]) -> Choice:
        """Go on with path or plan; or find a path; or, on an impasse, ask for a plan."""
        while self._path is None and self.intention is not None:
            if not self._repertoire.is_met(self.intention, moment.facts):
                break
            self._note_carried_out()
        if self._is_all_done(moment):
            self._path = None
            self._following.drop()
            self._experience.forget_beginnings()
            return Choice(DecisionKind.ACHIEVED, self._achieved(), failures=failures)
        after = f" after a failure ({failures[0].text})" if failures else ""
        if self._path is not None:
            reason = f"{self._path}{after}"
            return self._choice(DecisionKind.ACT, reason, self._path.step, failures)
        step = self._following.review(moment, self._experience.given_up)
        if step is not None:
            return self._choice(DecisionKind.ACT, self._following.words, step, failures)
        selection = Selection(self._repertoire, moment, self._experience)
        path = self._path = self._find_path(selection, moment)
        if path is None:
            return self._ask_planning(selection, moment, failures, after)
        choice = self._choice(DecisionKind.ACT, f"{path}{after}", path.step, failures)
        return replace(choice, candidates=(Candidate(str(path.step.action), chosen=True),))

    def _find_path(self, selection: Selection, moment: Moment) -> SkillPath | None:
        if self.intention is not None:
            levels = path_to_skill(selection, self.intention)
            return None if levels is None else self._take((self.intention,), levels, 0, moment)
        found = path_to_goals(selection, self._goals, moment)
        return None if found is None else self._take((found[0],), found[1], 0, moment)

    def _ask_planning(
        self,
        selection: Selection,
        moment: Moment,
        failures: tuple[Failure, ...],
        after: str,
    ) -> Choice:
        """On an impasse: search for a plan to the goals, or to what the intention brings about."""
        refused = explained(selection.refusals, moment.facts, self._evaluator)
        failures = (*failures, *selection.failures, *refused)
        intention, goals = self.intention, self._goals
        considered: tuple[Candidate, ...] = ()
        if intention is not None:
            goals = self._repertoire.aims_of(intention)
            considered = as_candidates(selection.refusals, moment.facts, self._evaluator)
        if not goals or moment.believes(goals):
            reason = f"{intention} cannot be carried out; {'; '.join(map(str, failures[:1]))}"
            return Choice(DecisionKind.IMPASSE, reason, candidates=considered, failures=failures)
        given_up = self._experience.given_up
        in_vain = self._experience.planning_in_vain(moment.scene)
        found: Plan | NoPlan
        if in_vain:
            found = NoPlan(in_vain, final=False, failure=FailureReason.LOOP)
        else:
            found = find_plan(
                self._planning.domain,
                moment.imagination,
                goals,
                excluded=list(given_up),
                prepared=self._planning,
            )
        considered += tuple(candidates(self._planning.domain, moment.imagination, goals, found))
        if isinstance(found, NoPlan):
            no_plan = Failure(found.failure, found.reason)
            reasons = [*map(str, failures[:1] if intention else ()), found.reason]
            reasons += self._experience.complaints
            failures = (no_plan, *failures) if intention is None else (*failures, no_plan)
            return Choice(
                DecisionKind.IMPASSE, "; ".join(reasons), candidates=considered, failures=failures
            )
        first, self._planned_in = self._following.take_up(found, moment), moment.scene
        reason = f"first of {len(found.steps)} steps to the goal{after}"
        choice = self._choice(DecisionKind.ACT, reason, first, failures)
        return replace(choice, candidates=considered)

    def _take(
        self, aims: tuple[Aim, ...], levels: tuple[Level, ...], kept: int, moment: Moment
    ) -> SkillPath:
        """Commit to a path; its levels from `kept` on are begun now."""
        last = levels[-1]
        step = plan_step(last.clause, dict(last.bindings))
        assert step is not None, "selection ends at a primitive that can be carried out"
        self._experience.note_begun(levels[kept:], moment.scene, moment.cycle)
        return SkillPath(aims, levels, step)

    def _again(self, step: PlanStep, moment: Moment) -> PlanStep | None:
        """Bind a step anew, or give None if it could not start now."""
        bindings = self._repertoire.of(step.clause).again(moment.facts, dict(step.bindings))
        return None if bindings is None else plan_step(step.clause, bindings)

    # What it is all for.

    def _note_carried_out(self) -> None:
        self._carried_out += 1
        self._following.drop()
        self._experience.forget_beginnings()

    def _is_all_done(self, moment: Moment) -> bool:
        return self.intention is None and moment.believes(self._goals)

    def _achieved(self) -> str:
        if not self._intentions:
            return "all goals are believed"
        carried_out = "all intended skills are carried out"
        return f"{carried_out}, and all goals are believed" if self._goals else carried_out

    def _choice(
        self,
        kind: DecisionKind,
        reason: str,
        step: PlanStep,
        failures: tuple[Failure, ...] = (),
    ) -> Choice:
        """Decide on a step of the path, or of the plan if there is no path."""
        if self._path is not None:
            return Choice(kind, reason, (step,), step, self._path, failures=failures)
        aims = self._goals if self.intention is None else (self.intention,)
        path = SkillPath(aims, (Level(step.clause, step.bindings),), step)
        following = self._following
        return Choice(kind, reason, following.rest, step, path, (), failures, following.status)
