"""The agent: one cycle, from percepts to a decision."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.errors import FrameError
from icarus_lite.execution import (
    MAX_ATTEMPTS,
    ActionReason,
    Decision,
    DecisionKind,
    Executor,
    GoalChange,
    GoalReport,
    GoalStatus,
    IntentionStatus,
    Moment,
    PlanCounts,
    Request,
    Standing,
    action_reason,
)
from icarus_lite.goals import (
    SWITCHING_MARGIN,
    Agenda,
    Goal,
    Management,
    Nominator,
    name_of,
)
from icarus_lite.inference import (
    BeliefState,
    Budget,
    Change,
    Chronicle,
    Context,
    Explanation,
    Functions,
    InferenceEngine,
    Memory,
    WhyNot,
    carried_over,
    explain,
    given_memory,
    why_not,
)
from icarus_lite.language.diagnostics import DomainError
from icarus_lite.language.fragments import parse_atom, parse_conditions
from icarus_lite.language.syntax import Atom, Condition, Constant, Domain
from icarus_lite.language.teams import domain_of
from icarus_lite.language.wording import closest, listing
from icarus_lite.outcomes import Outcome
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import Belief, Percept, is_number

__all__ = [
    "MAX_ATTEMPTS",
    "Agent",
    "Decision",
    "DecisionKind",
    "GoalReport",
    "GoalStatus",
    "IntentionStatus",
    "Request",
    "Standing",
]


class Agent:
    """Infers, watches its goals and chooses the next skill, once per cycle.

    It is told what to achieve (`goals`, states of the world), what to do (`intentions`, skills to
    be carried out), or both: then the intentions come first.

    Args:
        domain: A checked domain.
        goals: Literals as text or syntax, all to be achieved: `["(attached hubcover case)"]`.
        intentions: Skills as text or syntax, to be carried out one after the other, each to its
            end: `["(make-clear a)"]`. An argument may be a variable; the skill binds it.
        functions: Python predicates that `:tests` may call by name. They must be pure.
        given: Facts that are believed from the start, as in a task's `:init`. Percepts among
            them are left out: perception reports those itself.
        budget: What one cycle of inference may cost, and how much to remember of past ones.
        me: The agent's name, where skills are given to it by name (`:agent arm-1`).
        others: The other agents that take part, and may be asked; None for all that the domain
            names.
        long_term: Whether the domain's long-term goals are pursued as well.
        margin: By how much the priority of another goal must be greater for the one that is being
            pursued to be left for it.

    Raises:
        DomainError: a goal or an intention given as text does not parse.
        FrameError: the domain has no skill of that name and number of arguments.

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
        intentions: Iterable[str | Atom] = (),
        functions: Functions | None = None,
        given: Iterable[Atom] = (),
        budget: Budget | None = None,
        me: str | None = None,
        others: Iterable[str] | None = None,
        long_term: bool = True,
        margin: float = SWITCHING_MARGIN,
    ) -> None:
        self._agenda = Agenda()
        self._told: list[GoalChange] = []
        stated = tuple(condition for goal in goals for condition in _as_conditions(goal))
        if stated:
            self._agenda.add(Goal(name_of(stated), stated, maintain=True))
        self._settings = _Settings(
            functions, budget, me, None if others is None else tuple(others), long_term, margin
        )
        self._memory = given_memory(domain, given)
        self._decision: Decision | None = None
        self._chronicle = Chronicle((budget or Budget()).changes_kept)
        self._live_by(domain, tuple(_as_call(each, domain) for each in intentions))

    def _live_by(self, domain: Domain, intentions: tuple[Atom, ...]) -> None:
        """Make what works by the rules of a domain."""
        chosen = self._settings
        self.domain = domain
        self.intentions = intentions
        self._engine = InferenceEngine(domain, chosen.functions, chosen.budget)
        evaluator = self._engine.evaluator
        view = domain_of(domain, chosen.me, chosen.others)
        self._executor = Executor(view, evaluator, (), intentions)
        lasting = Nominator(domain.long_term_goals, evaluator) if chosen.long_term else None
        self._management = Management(self._executor, view, self._agenda, lasting, chosen.margin)

    def reload(self, domain: Domain) -> None:
        """Go on by the rules of an edited domain, from the next cycle on.

        What actions have asserted stays asserted, goals stay goals, and what was believed when is
        still known; contradictions that the new rules still have go on counting. Plans and what was
        learnt from failures belong to the old rules and are dropped; an action under way is no
        longer watched, but its outcome still counts.

        Args:
            domain: A checked domain.

        Raises:
            FrameError: it has no skill for an intention that is still to be carried out; then
                nothing has changed.
        """
        left = self.intentions[self._executor.carried_out :]
        state, old = self._memory.state, self.domain.contradictions
        self._live_by(domain, tuple(_as_call(each, domain) for each in left))
        doubts = carried_over(state.doubts, old, domain.contradictions)
        self._memory = replace(self._memory, state=replace(state, doubts=doubts))

    def take_up(self, memory: Memory, chronicle: Chronicle) -> None:
        """Go on from what was believed before: see `icarus_lite.trace.resumed_agent`.

        What was planned, and what was learnt from failures, is not taken up.

        Args:
            memory: Of the last cycle, made by the engine of the same domain.
            chronicle: What was believed when, up to that cycle.
        """
        self._memory = memory
        self._chronicle = chronicle

    @property
    def state(self) -> BeliefState:
        """The beliefs of the last cycle."""
        return self._memory.state

    @property
    def goals(self) -> tuple[Condition, ...]:
        """The literals of all goals, in the order in which they came to be goals."""
        return tuple(condition for entry in self._agenda for condition in entry.goal.conditions)

    @property
    def goal_names(self) -> tuple[str, ...]:
        """The names of all goals, in the same order."""
        return tuple(entry.name for entry in self._agenda)

    def add_goal(
        self,
        goal: str | Condition,
        *,
        priority: float = 0.0,
        maintain: bool = False,
        name: str | None = None,
    ) -> str:
        """Add a top-level goal; a goal of the same name is replaced by it.

        Args:
            goal: What is to hold: one literal, or several that must all hold together,
                `"((on a b) (on b c))"`.
            priority: How much it matters; the goals given to begin with have 0.
            maintain: Whether it is kept up once it is reached; otherwise it is dropped then.
            name: What to call it; None for the literals themselves.

        Returns:
            Its name.

        Raises:
            DomainError: the text does not parse.
            FrameError: the priority is not a finite number.
        """
        if not is_number(priority):
            raise FrameError(f"the priority of a goal is a number, not {priority!r}")
        conditions = _as_conditions(goal)
        name = name_of(conditions) if name is None else name
        self._agenda.add(Goal(name, conditions, float(priority), maintain))
        self._told.append(GoalChange(name, conditions, float(priority), maintain))
        return name

    def remove_goal(self, name: str) -> None:
        """Drop a goal, as soon as nothing is under way for it.

        Args:
            name: Its name, or its literals.

        Raises:
            FrameError: there is no such goal.
        """
        for each in (name, _canonical(name)):
            if self._agenda.remove(each):
                self._told.append(GoalChange(each))
                return
        names = [entry.name for entry in self._agenda]
        meant = closest(name, names)
        hint = f"did you mean {meant}?" if meant else f"the goals are {listing(names) or 'none'}"
        raise FrameError(f"there is no goal {name} to remove; {hint}")

    def cycle(
        self,
        percepts: Iterable[Percept],
        last_outcome: Outcome | Sequence[Outcome] | None = None,
        *,
        time_s: float | None = None,
    ) -> Decision:
        """Run one recognise-act cycle.

        Args:
            percepts: Everything perceived now, anchored objects that are hidden included.
            last_outcome: What became of the action decided on before (and of other agents'
                actions, in order); None if nothing is known of any. Of a body that reports
                nothing, beliefs tell when an action has had its effects; those of its effects
                that no percept shows are then never believed.
            time_s: The time in s on any clock, if `:timeout` is to be watched here; None where
                the body sees to it.

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
        added, removed = state.since(before)
        present = [percept.name for percept in state.percepts]
        self._chronicle.record(state.cycle, added, removed, outcomes, present, state.withdrawn)
        moment = Moment(self._engine, self._memory, time_s)
        choice, agenda = self._management.decide(moment, outcomes)
        told, self._told = tuple(self._told), []
        done = self._executor.carried_out
        self._decision = Decision(
            state.cycle,
            choice.kind,
            state,
            added,
            removed,
            tuple(
                GoalStatus(each, moment.believes([each])) for goal in agenda for each in goal.goals
            ),
            choice.plan,
            choice.step,
            choice.reason,
            choice.candidates,
            choice.skill_path,
            tuple(IntentionStatus(call, i < done) for i, call in enumerate(self.intentions)),
            choice.failures,
            choice.plan_status,
            agenda,
            choice.request,
            told,
        )
        return self._decision

    def why_action(self) -> ActionReason:
        """Say what the action of the last cycle is for, down to the goal.

        Of the step of a plan that is: which conditions of which later steps, or which goals, wait
        for what it brings about; of a skill on a path, the skills and the goal above it.

        Raises:
            FrameError: there has been no cycle yet.
        """
        if self._decision is None:
            raise FrameError("there is no action yet: run a cycle first")
        return action_reason(self._decision)

    @property
    def plan_counts(self) -> PlanCounts:
        """What has become of plans: how many were made, and kept or not after surprises."""
        return self._executor.plan_counts

    def why(
        self, belief: str | Belief, *, alternatives: bool = False, cycle: int | None = None
    ) -> Explanation:
        """Explain why a belief is held, down to percepts and actions.

        Args:
            belief: The belief.
            alternatives: Whether to give all other reasons for it as well.
            cycle: An earlier cycle, to explain why it was held then; None for now.

        Raises:
            FrameError: the text is not one belief without variables.
            ForgottenError: there was no such cycle, or it is no longer on record.
        """
        state = self.state if cycle is None else self._engine.look_back(cycle)
        return explain(
            _as_belief(belief), state, alternatives=alternatives, chronicle=self._chronicle
        )

    def why_not(self, asked: str | Belief) -> WhyNot:
        """Say why a belief is not held now, or why a skill cannot start.

        Args:
            asked: A belief such as `(near ?x case)` or a skill such as `(pick-up hand1 plug)`;
                variables stand for anything.

        Raises:
            DomainError: the text does not parse.
            FrameError: the text is not one literal.
        """
        context = Context(
            self.domain, self.state, self._engine.evaluator, self._chronicle, self._memory.known
        )
        return why_not(asked, context)

    def _planned_changes(self, outcomes: Sequence[Outcome]) -> dict[int, Change]:
        """Give the exact effects of our own action, whose clause and bindings we know."""
        running = self._executor.running
        if running is None:
            return {}
        return {i: running.change for i, o in enumerate(outcomes) if o.action == running.action}


def _as_conditions(given: str | Condition) -> tuple[Condition, ...]:
    return parse_conditions(given) if isinstance(given, str) else (given,)


def _canonical(goal: str) -> str:
    """Write the literals of a goal as its name has them; a text that has none stays as it is."""
    try:
        return name_of(parse_conditions(goal))
    except DomainError:
        return goal


@dataclass(frozen=True, slots=True)
class _Settings:
    """What an agent was made with, besides its domain: see `Agent`."""

    functions: Functions | None
    budget: Budget | None
    me: str | None
    others: tuple[str, ...] | None
    long_term: bool
    margin: float


def _as_outcomes(given: Outcome | Sequence[Outcome] | None) -> tuple[Outcome, ...]:
    if given is None:
        return ()
    return (given,) if isinstance(given, Outcome) else tuple(given)


def _as_call(given: str | Atom, domain: Domain) -> Atom:
    """Read a skill call, and see that the domain has such a skill."""
    call = parse_atom(given, "<intention>") if isinstance(given, str) else given
    named = [clause.head for clause in domain.skills if clause.head.predicate == call.predicate]
    if not named:
        meant = closest(call.predicate, [clause.head.predicate for clause in domain.skills])
        hint = f"; did you mean `{meant}`?" if meant else ""
        raise FrameError(f"the domain has no skill called `{call.predicate}`{hint}")
    if all(len(head.args) != len(call.args) for head in named):
        raise FrameError(f"{call} has {len(call.args)} arguments; the skill is {named[0]}")
    return call


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
