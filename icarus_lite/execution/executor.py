"""The executor: keeps to its skill path or plan, and chooses anew when that ends or falls.

Skills come first: a path from a goal or an intended skill down to a primitive that can act now.
Only on an impasse, when no skill leads on from the beliefs of now, is planning asked; its plan is
then followed as long as its next step can start.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace

from icarus_lite.execution.choosing import path_to_goals, path_to_skill
from icarus_lite.execution.decision import DecisionKind
from icarus_lite.execution.experience import MAX_ATTEMPTS, Experience
from icarus_lite.execution.moment import Moment
from icarus_lite.execution.monitoring import Execution, Fate, Judgement, judge
from icarus_lite.execution.path import Aim, Level, SkillPath
from icarus_lite.execution.persistence import carry_on, first_fallen
from icarus_lite.execution.refusal import as_candidates, explained
from icarus_lite.execution.repertoire import Repertoire
from icarus_lite.execution.selection import Selection
from icarus_lite.inference import Evaluator
from icarus_lite.language.syntax import Atom, Condition, Domain
from icarus_lite.planning import (
    Candidate,
    Failure,
    FailureReason,
    NoPlan,
    Plan,
    PlanStep,
    candidates,
    find_plan,
    plan_step,
)
from icarus_lite.symbols import Outcome


@dataclass(frozen=True, slots=True)
class Choice:
    """What the executor has come to: see `Decision` for each part."""

    kind: DecisionKind
    reason: str
    plan: tuple[PlanStep, ...] = ()
    step: PlanStep | None = None
    skill_path: SkillPath | None = None
    candidates: tuple[Candidate, ...] = ()
    failures: tuple[Failure, ...] = ()


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
        self._domain = domain
        self._evaluator = evaluator
        self._repertoire = Repertoire(domain, evaluator)
        self._goals = tuple(goals)
        self._intentions = tuple(intentions)
        self._carried_out = 0
        self._plan: tuple[PlanStep, ...] = ()
        self._planned_in: Hashable = None
        self._path: SkillPath | None = None
        self._running: Execution | None = None
        self._experience = Experience()

    @property
    def running(self) -> PlanStep | None:
        """The primitive skill under way, if any."""
        return None if self._running is None else self._running.step

    @property
    def carried_out(self) -> int:
        """How many of the intentions, in their order, have been carried out."""
        return self._carried_out

    def decide(self, moment: Moment, outcomes: Sequence[Outcome]) -> Choice:
        """Decide what to do in this cycle.

        Args:
            moment: What is known now, the outcomes taken into account.
            outcomes: What became of actions since the last cycle.
        """
        failures: tuple[Failure, ...] = ()
        if self._running is not None:
            judgement = self._judge(self._running, outcomes, moment)
            going = self._keep_going(self._running, judgement, moment)
            if going is not None:
                return going
            failures = () if judgement.failure is None else (judgement.failure,)
            failures += self._come_to_end(judgement.fate, moment)
        choice = self._choose(moment, failures)
        if choice.kind is DecisionKind.ACT and choice.step is not None:
            self._running = Execution(choice.step, moment.scene, moment.time_s)
        return choice

    # The primitive skill under way.

    def _judge(
        self, execution: Execution, outcomes: Sequence[Outcome], moment: Moment
    ) -> Judgement:
        """Say what becomes of the skill under way, and learn from it."""
        action = execution.step.action
        ours = [outcome for outcome in outcomes if outcome.action == action]
        skill = self._repertoire.of(execution.step.clause)
        judgement = judge(execution, skill, ours[-1] if ours else None, moment)
        if judgement.fate is Fate.FINISHED:
            self._experience.note_success(action)
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
        if fate is Fate.GOES_ON and fallen is not None:
            fate, failure = Fate.BREAK_OFF, fallen[1]
        if fate is Fate.GOES_ON:
            return self._choice(DecisionKind.CONTINUE, f"{step.action} is running", step)
        if fate is Fate.BREAK_OFF and failure is not None:
            self._running = replace(execution, stopping=True)
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
            self._plan = (step, *self._plan[1:])
        else:
            *macros, last = self._path.levels
            levels = (*macros, replace(last, bindings=step.bindings))
            self._path = replace(self._path, levels=levels, step=step)
        reason = "once more" if failure is None else f"once more: {failure.text}"
        return self._choice(DecisionKind.ACT, reason, step, () if failure is None else (failure,))

    def _come_to_end(self, fate: Fate, moment: Moment) -> tuple[Failure, ...]:
        """Move path or plan on after the primitive has come to its end; say what was given up."""
        self._running = None
        if self._path is None:
            given_up = self._plan and self._plan[0].action in self._experience.given_up
            self._plan = () if fate is Fate.FAILED or given_up else self._plan[1:]
            if fate is Fate.FINISHED and not self._plan:
                self._experience.note_plan_carried_through(self._planned_in)
            return ()
        selection = Selection(self._repertoire, moment, self._experience)
        finished = fate is Fate.FINISHED
        progress = carry_on(
            self._repertoire, selection, self._path.levels, moment, finished=finished
        )
        aims, self._path = self._path.aims, None
        if progress.levels:
            self._path = self._take(aims, progress.levels, progress.kept, moment)
        elif progress.completed and aims == (self._intention,):
            self._note_carried_out()
        return tuple(selection.failures)

    # What to do next, when nothing is under way.

    def _choose(self, moment: Moment, failures: tuple[Failure, ...]) -> Choice:
        """Go on with path or plan; or find a path; or, on an impasse, ask for a plan."""
        while self._path is None and self._intention is not None:
            if not self._repertoire.is_met(self._intention, moment.facts):
                break
            self._note_carried_out()
        if self._is_all_done(moment):
            self._path, self._plan = None, ()
            self._experience.forget_beginnings()
            return Choice(DecisionKind.ACHIEVED, self._achieved(), failures=failures)
        after = f" after a failure ({failures[0].text})" if failures else ""
        if self._path is not None:
            reason = f"{self._path}{after}"
            return self._choice(DecisionKind.ACT, reason, self._path.step, failures)
        if self._plan:
            step = self._again(self._plan[0], moment)
            if step is not None:
                self._plan = (step, *self._plan[1:])
                reason = f"next step of the plan, {len(self._plan)} to go"
                return self._choice(DecisionKind.ACT, reason, step, failures)
        self._plan = ()
        selection = Selection(self._repertoire, moment, self._experience)
        path = self._path = self._find_path(selection, moment)
        if path is None:
            return self._ask_planning(selection, moment, failures, after)
        choice = self._choice(DecisionKind.ACT, f"{path}{after}", path.step, failures)
        return replace(choice, candidates=(Candidate(str(path.step.action), chosen=True),))

    def _find_path(self, selection: Selection, moment: Moment) -> SkillPath | None:
        if self._intention is not None:
            levels = path_to_skill(selection, self._intention)
            return None if levels is None else self._take((self._intention,), levels, 0, moment)
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
        intention, goals = self._intention, self._goals
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
            found = find_plan(self._domain, moment.imagination, goals, excluded=list(given_up))
        considered += tuple(candidates(self._domain, moment.imagination, goals, found))
        if isinstance(found, NoPlan):
            no_plan = Failure(found.failure, found.reason)
            reasons = [*map(str, failures[:1] if intention else ()), found.reason]
            reasons += [f"{a} failed {MAX_ATTEMPTS} times: {why}" for a, why in given_up.items()]
            failures = (no_plan, *failures) if intention is None else (*failures, no_plan)
            return Choice(
                DecisionKind.IMPASSE, "; ".join(reasons), candidates=considered, failures=failures
            )
        self._plan, self._planned_in = found.steps, moment.scene
        reason = f"first of {len(found.steps)} steps to the goal{after}"
        choice = self._choice(DecisionKind.ACT, reason, found.steps[0], failures)
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

    @property
    def _intention(self) -> Atom | None:
        """The skill to be carried out next, or under way; None if all have been."""
        waiting = self._intentions[self._carried_out :]
        return waiting[0] if waiting else None

    def _note_carried_out(self) -> None:
        self._carried_out += 1
        self._plan = ()
        self._experience.forget_beginnings()

    def _is_all_done(self, moment: Moment) -> bool:
        return self._intention is None and moment.believes(self._goals)

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
        aims = self._goals if self._intention is None else (self._intention,)
        path = SkillPath(aims, (Level(step.clause, step.bindings),), step)
        return Choice(kind, reason, self._plan, step, path, failures=failures)
