"""The agent: one cycle, from percepts to a decision."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.errors import FrameError
from icarus_lite.execution import (
    MAX_ATTEMPTS,
    Decision,
    DecisionKind,
    Executor,
    GoalStatus,
    IntentionStatus,
    Moment,
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
    WhyNot,
    explain,
    given_memory,
    why_not,
)
from icarus_lite.language.fragments import parse_atom, parse_conditions
from icarus_lite.language.reading.explanations import closest
from icarus_lite.language.syntax import Atom, Condition, Constant, Domain
from icarus_lite.symbols import Belief, Outcome, Percept

__all__ = [
    "MAX_ATTEMPTS",
    "Agent",
    "Decision",
    "DecisionKind",
    "GoalStatus",
    "IntentionStatus",
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
        budget: What one cycle of inference may cost.

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
    ) -> None:
        self.domain = domain
        self.goals: tuple[Condition, ...] = tuple(
            condition
            for goal in goals
            for condition in (parse_conditions(goal) if isinstance(goal, str) else (goal,))
        )
        self.intentions: tuple[Atom, ...] = tuple(_as_call(each, domain) for each in intentions)
        self._engine = InferenceEngine(domain, functions, budget)
        self._memory = given_memory(domain, given)
        self._executor = Executor(domain, self._engine.evaluator, self.goals, self.intentions)
        self._chronicle = Chronicle()

    @property
    def state(self) -> BeliefState:
        """The beliefs of the last cycle."""
        return self._memory.state

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
        self._chronicle.record(state.cycle, added, removed, outcomes, present)
        moment = Moment(self._engine, self._memory, time_s)
        choice = self._executor.decide(moment, outcomes)
        done = self._executor.carried_out
        return Decision(
            state.cycle,
            choice.kind,
            state,
            added,
            removed,
            tuple(GoalStatus(goal, moment.believes([goal])) for goal in self.goals),
            choice.plan,
            choice.step,
            choice.reason,
            choice.candidates,
            choice.skill_path,
            tuple(IntentionStatus(call, i < done) for i, call in enumerate(self.intentions)),
            choice.failures,
        )

    def why(self, belief: str | Belief, *, alternatives: bool = False) -> Explanation:
        """Explain why a belief is held now, down to percepts and actions.

        Args:
            belief: The belief.
            alternatives: Whether to give all other reasons for it as well.

        Raises:
            FrameError: the text is not one belief without variables.
        """
        return explain(
            _as_belief(belief), self.state, alternatives=alternatives, chronicle=self._chronicle
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
