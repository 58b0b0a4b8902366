"""`why-not`: what keeps a belief from being held, or a skill from starting."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Final

from icarus_lite.errors import FrameError
from icarus_lite.inference.contradictions import Withdrawal
from icarus_lite.inference.explaining.attempts import nearest_attempt
from icarus_lite.inference.explaining.chronicle import Period, unify_call, what_ended
from icarus_lite.inference.explaining.conjunctions import Attempt
from icarus_lite.inference.explaining.context import Context
from icarus_lite.inference.explaining.diagnosis import NEAREST, blocked, diagnose
from icarus_lite.inference.explaining.fitting import fit
from icarus_lite.inference.explaining.lookup import matching
from icarus_lite.inference.explaining.reasons import Blocked, Missing, Reason, because
from icarus_lite.inference.explaining.skills import Readiness, readiness
from icarus_lite.inference.explaining.sources import Source, impossible, sources
from icarus_lite.inference.facts import match
from icarus_lite.inference.supports import bind_pattern
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.syntax import Atom, ConceptClause, Condition, Constant, SkillClause
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief

DEPTH: Final = 2
"""How many steps down a missing belief is followed to what is missing for it."""


@dataclass(frozen=True, slots=True)
class ClauseVerdict:
    """How far one clause of a concept or skill gets.

    Args:
        clause: The clause.
        head: Its head under the nearest bindings: the instance that comes closest.
        attempt: The nearest attempt; None where the head cannot stand for what was asked.
        reason: Why it fails; None where all its conditions hold.
        deeper: Where a belief is missing, why that is not held.
        readiness: Of a skill, what its `:while` and its effects say.
    """

    clause: ConceptClause | SkillClause
    head: Atom
    attempt: Attempt | None = None
    reason: Reason | None = None
    deeper: WhyNot | None = None
    readiness: Readiness | None = None

    @property
    def fits(self) -> bool:
        """Whether the head can stand for what was asked at all."""
        return self.attempt is not None

    @property
    def holds(self) -> bool:
        """Whether all its conditions are met."""
        return self.attempt is not None and self.attempt.holds

    def __str__(self) -> str:
        return "\n".join(self.lines(""))

    def lines(self, indent: str) -> Iterator[str]:
        """Give its text, a line at a time."""
        span = self.clause.span
        place = f"{span.in_line}, {self.head}" if span.line else str(self.head)
        if self.attempt is None:
            yield f"{indent}{place}: its head cannot stand for this"
            return
        met, total = self.attempt.met, len(self.attempt.checked)
        if self.reason is None:
            other = "" if self.readiness else "; what else it follows from decides its attributes"
            yield f"{indent}{place}: all its conditions hold{other}"
        else:
            yield f"{indent}{place}: {met} of {total} conditions hold"
            yield f"{indent}  {self.reason}"
            if isinstance(self.reason, Blocked):
                for blocker in self.reason.blockers:
                    yield f"{indent}    {blocker.belief}  {blocker.because}"
        if not self.attempt.complete:
            yield f"{indent}  (the nearest of the first attempts; the search was cut off)"
        if self.deeper is not None:
            yield from self.deeper.lines(indent + "    ")
        if self.readiness is not None:
            if self.readiness.broken not in (None, self.reason):
                yield f"{indent}  by its :while it would be broken off: {self.readiness.broken}"
            if self.readiness.is_idle or (self.holds and self.readiness.believed):
                yield f"{indent}  {self.readiness}"


@dataclass(frozen=True, slots=True)
class Past:
    """A belief that was held before.

    Args:
        belief: The belief.
        periods: When, oldest first.
        ended: What ended it last, in words; empty where its reasons simply no longer held.
    """

    belief: Belief
    periods: tuple[Period, ...]
    ended: str = ""

    def __str__(self) -> str:
        held = ", ".join(str(period) for period in self.periods[-NEAREST:])
        earlier = f"{len(self.periods)} times, last " if len(self.periods) > NEAREST else ""
        return f"{self.belief} was believed {earlier}{held}" + (
            f"; {self.ended}" * bool(self.ended)
        )


@dataclass(frozen=True, slots=True)
class Report:
    """What became of an action that would have made the belief, or of the skill asked about."""

    cycle: int
    outcome: Outcome

    def __str__(self) -> str:
        action, status = self.outcome.action, self.outcome.status
        reason = f": {self.outcome.reason}" if self.outcome.reason else ""
        if status is Status.RUNNING:
            return f"{action} was still running in cycle {self.cycle}"
        return f"{action} was reported as {status} in cycle {self.cycle}{reason}"


@dataclass(frozen=True, slots=True)
class Refused:
    """A belief that was asserted and withdrawn in the same cycle, so that it was never held."""

    cycle: int
    withdrawal: Withdrawal

    def __str__(self) -> str:
        each = self.withdrawal
        return f"{each.belief} was asserted in cycle {self.cycle} but not believed: {each.reason}"


@dataclass(frozen=True, slots=True)
class WhyNot:
    """Why a belief is not held, or why a skill does not start.

    Args:
        asked: The literal that was asked about.
        cycle: The cycle.
        is_skill: Whether it is a skill.
        instances: What matches, at most three: then it is believed after all.
        supported: For each of these, why it is held.
        impossible: Why nothing could ever make it true; mostly a slip of the pen.
        absent: Of each object in it that is not perceived, since when.
        reason: Of a percept or a negated literal, why it fails.
        clauses: How far each clause gets.
        sources: The actions that have it among their effects.
        past: When it was believed before, and what ended that.
        refused: When it was asserted and withdrawn at once, latest first.
        reports: What became of actions that would have made it, latest first.
    """

    asked: Condition
    cycle: int
    is_skill: bool = False
    instances: tuple[Belief, ...] = ()
    supported: tuple[str, ...] = ()
    impossible: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()
    reason: Reason | None = None
    clauses: tuple[ClauseVerdict, ...] = ()
    sources: tuple[Source, ...] = ()
    past: tuple[Past, ...] = ()
    refused: tuple[Refused, ...] = ()
    reports: tuple[Report, ...] = ()

    @property
    def holds(self) -> bool:
        """Whether it is believed after all, or, of a skill, can start."""
        if self.is_skill:
            return any(verdict.holds for verdict in self.clauses)
        if self.asked.negated:
            return self.reason is None
        return bool(self.instances)

    def __str__(self) -> str:
        return "\n".join(self.lines(""))

    def lines(self, indent: str) -> Iterator[str]:
        """Give its text, a line at a time."""
        yield f"{indent}{self._opening()}"
        inner = indent + "  "
        yield from (f"{inner}{line}" for line in (*self.supported, *self.impossible, *self.absent))
        if self.reason is not None:
            yield f"{inner}{self.reason}"
            if isinstance(self.reason, Blocked):
                yield from (f"{inner}  {b.belief}  {b.because}" for b in self.reason.blockers)
        for verdict in self.clauses:
            yield from verdict.lines(inner)
        told = (*self.past, *self.refused)
        yield from (f"{inner}{line}" for line in (*self.sources, *told, *self.reports))

    def _opening(self) -> str:
        asked, when = self.asked, f"in cycle {self.cycle}"
        if self.is_skill:
            return f"{asked} {'can' if self.holds else 'cannot'} start {when}"
        if asked.negated:
            return f"{asked} {'holds' if self.holds else 'does not hold'} {when}"
        if self.instances:
            return f"{asked} is believed {when}"
        if self.impossible:
            return f"{asked} can never be believed"
        return f"{asked} is not believed {when}"


def why_not(asked: str | Atom | Condition | Belief, context: Context, depth: int = DEPTH) -> WhyNot:
    """Say why a belief is not held in a cycle, or why a skill cannot start.

    A name that is both a predicate and a skill is taken for the predicate. What matches is
    looked up through hash indexes, and each clause is searched for its nearest attempt within a
    fixed limit, so that the answer takes milliseconds in a scene of fifty objects.

    Args:
        asked: A literal such as `(near ?x case)` or `(not (holding hand1 ?any))`, or a skill such
            as `(pick-up hand1 plug)`; variables stand for anything.
        context: The cycle.
        depth: How many steps down a missing belief is followed.

    Raises:
        DomainError: the text does not parse.
        FrameError: the text is not one literal.
    """
    literal = as_literal(asked)
    names = context.names
    name = literal.atom.predicate
    if name in names.skills and name not in names.predicates and not literal.negated:
        return _skill(literal, context, depth)
    if literal.negated:
        found = matching(literal.atom, context.facts)
        reason = blocked(literal.atom, context) if found else None
        return WhyNot(literal, context.state.cycle, reason=reason)
    return _belief(literal, context, depth)


def as_literal(asked: str | Atom | Condition | Belief) -> Condition:
    """Read what is asked about. Raises DomainError, and FrameError unless it is one literal."""
    if isinstance(asked, Condition):
        return asked
    if isinstance(asked, Belief):
        return Condition(Atom(asked.predicate, tuple(map(Constant, asked.args))))
    if isinstance(asked, Atom):
        return Condition(asked)
    conditions = parse_conditions(asked)
    if len(conditions) != 1:
        raise FrameError(f"expected one literal such as (attached ?x case), got {asked}")
    return conditions[0]


def _belief(asked: Condition, context: Context, depth: int) -> WhyNot:
    atom, cycle = asked.atom, context.state.cycle
    found = sorted(matching(atom, context.facts), key=str)[:NEAREST]
    if found:
        supported = tuple(f"{fact}  {because(context.support(fact))}" for fact in found)
        return WhyNot(asked, cycle, instances=tuple(found), supported=supported)
    never = impossible(atom, context)
    if never:
        return WhyNot(asked, cycle, impossible=never, past=_past(atom, context))
    reason = None
    if context.is_perceived(atom.predicate) or atom.attributes:
        attempt = nearest_attempt([asked], [], context.facts, {}, context.evaluator)
        failure = attempt.failure
        reason = None if failure is None else diagnose(failure, attempt.bindings, context)
    origins = sources(atom, context)
    return WhyNot(
        asked,
        cycle,
        absent=() if reason is not None else tuple(_absent(atom, context)),
        reason=reason,
        clauses=tuple(_verdicts(atom, context.domain.concepts, context, depth)),
        sources=origins,
        past=_past(atom, context),
        refused=tuple(islice(_refused(atom, context), NEAREST)),
        reports=tuple(_reports([each.action for each in origins if each.asserts], context)),
    )


def _skill(asked: Condition, context: Context, depth: int) -> WhyNot:
    atom = asked.atom
    arity = context.names.skills[atom.predicate].arity
    never: tuple[str, ...] = ()
    if all(
        len(clause.head.args) != len(atom.args)
        for clause in context.domain.skills
        if clause.head.predicate == atom.predicate
    ):
        things = "argument" if arity == 1 else "arguments"
        never = (f"the skill `{atom.predicate}` takes {arity} {things}, not {len(atom.args)}",)
    return WhyNot(
        asked,
        context.state.cycle,
        is_skill=True,
        impossible=never,
        absent=tuple(_absent(atom, context)),
        clauses=() if never else tuple(_verdicts(atom, context.domain.skills, context, depth)),
        reports=tuple(_reports([atom], context)),
    )


def _absent(atom: Atom, context: Context) -> Iterator[str]:
    return (context.absence(name) for name in context.strangers(atom))


def _verdicts(
    asked: Atom, clauses: Iterable[ConceptClause | SkillClause], context: Context, depth: int
) -> Iterator[ClauseVerdict]:
    for clause in clauses:
        if clause.head.predicate == asked.predicate:
            yield _verdict(asked, clause, context, depth)


def _verdict(
    asked: Atom, clause: ConceptClause | SkillClause, context: Context, depth: int
) -> ClauseVerdict:
    binds = clause.binds if isinstance(clause, ConceptClause) else ()
    stands = fit(clause.head, asked, binds)
    if stands is None:
        return ClauseVerdict(clause, clause.head)
    tests = (*clause.tests, *stands.demands)
    attempt = nearest_attempt(
        clause.elements, tests, context.facts, stands.bindings, context.evaluator
    )
    head = bind_pattern(clause.head, attempt.bindings)
    failure = attempt.failure
    reason = None if failure is None else diagnose(failure, attempt.bindings, context)
    deeper = None
    if isinstance(reason, Missing) and depth > 0 and reason.pattern != asked:
        deeper = _deeper(reason, context, depth)
    ready = None
    if isinstance(clause, SkillClause):
        ready = readiness(clause, attempt.bindings, context)
    return ClauseVerdict(clause, head, attempt, reason, deeper, ready)


def _deeper(missing: Missing, context: Context, depth: int) -> WhyNot | None:
    """Follow a missing belief down to what is missing for it; None where nothing is to be said."""
    if context.is_perceived(missing.pattern.predicate):
        return None
    below = _belief(Condition(missing.pattern), context, depth - 1)
    worth_saying = below.impossible or below.clauses or below.sources or below.past
    return below if worth_saying else None


def _past(atom: Atom, context: Context) -> tuple[Past, ...]:
    """Give the beliefs that were held before and match, those that ended last first."""
    chronicle = context.chronicle
    ended = [
        (belief, periods)
        for belief, periods in chronicle.matching(atom)
        if periods[-1].last is not None
    ]
    ended.sort(key=lambda each: (-(each[1][-1].last or 0), str(each[0])))
    return tuple(
        Past(belief, periods, what_ended(belief, periods[-1], chronicle, context.domain))
        for belief, periods in ended[:NEAREST]
    )


def _refused(atom: Atom, context: Context) -> Iterator[Refused]:
    """Give what matches and was asserted, but withdrawn at once, latest first."""
    chronicle = context.chronicle
    for cycle, each in reversed(tuple(chronicle.withdrawals())):
        held = any(period.last == cycle - 1 for period in chronicle.periods(each.belief))
        if not held and match(atom, each.belief, {}) is not None:
            yield Refused(cycle, each)


def _reports(actions: list[Atom], context: Context) -> Iterator[Report]:
    """Give the latest report on actions that did not succeed, as far as any is known."""
    found = (
        Report(cycle, outcome)
        for cycle, outcome in context.chronicle.reports()
        if outcome.status is not Status.SUCCEEDED
        and any(unify_call(action, outcome.action) is not None for action in actions)
    )
    return islice(found, 1)
