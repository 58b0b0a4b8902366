"""The chronicle: when each belief was held, what was done meanwhile, and what ended it."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterable, Iterator, Sequence

from icarus_lite.inference.contradictions import Withdrawal
from icarus_lite.inference.facts import Bindings, match, resolve, unify
from icarus_lite.inference.supports import bind_pattern
from icarus_lite.language.syntax import Atom, AttachmentRule, Domain
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Action, Belief, Value, format_value


@dataclass(frozen=True, slots=True)
class Period:
    """A stretch of cycles in which a belief was held without a break.

    Args:
        first: Its first cycle.
        last: Its last cycle; None while it lasts.
    """

    first: int
    last: int | None = None

    def __str__(self) -> str:
        if self.last is None:
            return f"from cycle {self.first} on"
        if self.last == self.first:
            return f"in cycle {self.first}"
        return f"in cycles {self.first} to {self.last}"


class Chronicle:
    """A record of net changes, cycle by cycle. It grows with what changes, not with what holds.

    Args:
        changes_kept: How many things that are over to keep, the oldest are forgotten: beliefs that
            ended, objects that vanished, actions. None keeps all.

    Attributes:
        first: What was over before this cycle is forgotten.
        cycle: The last cycle recorded.
    """

    __slots__ = (
        "_actions", "_gone", "_last_seen", "_most", "_over", "_periods", "_present", "_size",
        "_withdrawn", "cycle", "first",
    )  # fmt: skip

    def __init__(self, changes_kept: int | None = None) -> None:
        self.cycle = -1
        self.first = 0
        self._most = changes_kept
        self._over: deque[tuple[int, tuple[Belief, ...], int]] = deque()
        self._size = 0
        self._periods: dict[str, dict[Belief, list[Period]]] = {}
        self._actions: dict[int, tuple[Outcome, ...]] = {}
        self._present: frozenset[str] = frozenset()
        self._last_seen: dict[str, int] = {}
        self._gone: dict[int, frozenset[str]] = {}
        self._withdrawn: dict[int, tuple[Withdrawal, ...]] = {}

    def record(
        self,
        cycle: int,
        added: Iterable[Belief],
        removed: Iterable[Belief],
        outcomes: Sequence[Outcome] = (),
        present: Collection[str] = (),
        withdrawn: Sequence[Withdrawal] = (),
    ) -> None:
        """Add a cycle.

        Args:
            cycle: Its number, greater than the one before.
            added: Beliefs that were not held in the cycle before.
            removed: Beliefs that are no longer held.
            outcomes: What became of actions since the cycle before.
            present: The names of all objects perceived.
            withdrawn: What was withdrawn, for something contradicts it.
        """
        ended = tuple(removed)
        for belief in ended:
            held = self._periods.setdefault(belief.predicate, {})
            periods = held.setdefault(belief, [Period(self.cycle)])
            periods[-1] = Period(periods[-1].first, self.cycle)
        for belief in added:
            held = self._periods.setdefault(belief.predicate, {})
            held.setdefault(belief, []).append(Period(cycle))
        if outcomes:
            self._actions[cycle] = tuple(outcomes)
        if withdrawn:
            self._withdrawn[cycle] = tuple(withdrawn)
        now = frozenset(present)
        gone = self._present - now
        if gone:
            self._gone[cycle] = gone
            self._last_seen.update(dict.fromkeys(gone, self.cycle))
        self._present = now
        self.cycle = cycle
        size = len(ended) + len(outcomes) + len(gone) + len(withdrawn)
        if size:
            self._over.append((cycle, ended, size))
            self._size += size
            while self._most is not None and self._size > self._most and len(self._over) > 1:
                self._forget(*self._over.popleft())

    def _forget(self, cycle: int, ended: tuple[Belief, ...], size: int) -> None:
        """Forget what was over in a cycle, the oldest on record."""
        for belief in ended:
            held = self._periods[belief.predicate]
            del held[belief][0]
            if not held[belief]:
                del held[belief]
        self._actions.pop(cycle, None)
        self._gone.pop(cycle, None)
        self._withdrawn.pop(cycle, None)
        self._size -= size
        self.first = cycle + 1

    def periods(self, belief: Belief) -> tuple[Period, ...]:
        """Give the periods in which a belief was held, oldest first."""
        return tuple(self._periods.get(belief.predicate, {}).get(belief, ()))

    def held(self, *predicates: str) -> Iterator[tuple[Belief, tuple[Period, ...]]]:
        """Give each belief on record with its periods; of some predicates, or of all."""
        for predicate in predicates or tuple(self._periods):
            for belief, periods in self._periods.get(predicate, {}).items():
                yield belief, tuple(periods)

    def matching(self, pattern: Atom) -> Iterator[tuple[Belief, tuple[Period, ...]]]:
        """Give each belief ever held that matches a pattern, in the order of first being held."""
        for belief, periods in self._periods.get(pattern.predicate, {}).items():
            if match(pattern, belief, {}) is not None:
                yield belief, tuple(periods)

    def outcomes(self, cycle: int) -> tuple[Outcome, ...]:
        """Give what became of actions just before a cycle."""
        return self._actions.get(cycle, ())

    def reports(self) -> Iterator[tuple[int, Outcome]]:
        """Give all outcomes with their cycles, latest first."""
        for cycle in sorted(self._actions, reverse=True):
            for outcome in reversed(self._actions[cycle]):
                yield cycle, outcome

    def gone(self, cycle: int) -> frozenset[str]:
        """Give the names of the objects that were perceived until just before a cycle."""
        return self._gone.get(cycle, frozenset())

    def withdrawals(self) -> Iterator[tuple[int, Withdrawal]]:
        """Give all that was withdrawn, with the cycles in which it was, earliest first."""
        for cycle, found in self._withdrawn.items():
            for each in found:
                yield cycle, each

    def last_perceived(self, name: str) -> int | None:
        """Give the last cycle in which an object was perceived; None if it is, or never was."""
        return None if name in self._present else self._last_seen.get(name)


def what_ended(belief: Belief, period: Period, chronicle: Chronicle, domain: Domain) -> str:
    """Say what ended a belief: a contradiction, or an action that had succeeded when it was gone.

    Effects do not end what concepts define, so that no action is blamed for that. Empty where no
    action and no vanished object accounts for it, as with a derived belief whose reasons no
    longer hold.
    """
    if period.last is None:
        return ""
    cycle = period.last + 1
    for when, each in chronicle.withdrawals():
        if when == cycle and each.belief == belief:
            return f"withdrawn in cycle {cycle}, because {each.reason}"
    derived = any(clause.head.predicate == belief.predicate for clause in domain.concepts)
    for outcome in chronicle.outcomes(cycle):
        if outcome.status is Status.SUCCEEDED and (not derived or belief.predicate == ATTACHED):
            how = _removal(belief, outcome.action, domain)
            if how:
                return f"{outcome.action} {how}, reported in cycle {cycle}"
    vanished = chronicle.gone(cycle)
    gone = next((arg for arg in belief.args if arg in vanished), None)
    return "" if gone is None else f"{format_value(gone)} was no longer perceived in cycle {cycle}"


def _removal(belief: Belief, action: Action, domain: Domain) -> str:
    """Say how an action ended a belief; empty if it did not."""
    for clause in domain.skills:
        bound = unify_call(clause.head, action)
        if bound is None:
            continue
        for effect in clause.effects:
            pattern = bind_pattern(effect.atom, bound)
            if effect.negated and match(pattern, belief, {}) is not None:
                return "removed it"
            if not effect.negated and _moves(belief, pattern, {}):
                return "attached it elsewhere"
    if belief.predicate == ATTACHED:
        for rule in domain.attachments:
            how = _detachment(belief, action, rule)
            if how:
                return how
    return ""


def _moves(belief: Belief, pattern: Atom, bound: Bindings) -> bool:
    """Tell whether an `(attached child …)` effect gives a child another parent."""
    if belief.predicate != ATTACHED or pattern.predicate != ATTACHED:
        return False
    child, parent = (resolve(term, bound) for term in pattern.args)
    return child == belief.args[0] and parent != belief.args[1]


def _detachment(belief: Belief, action: Action, rule: AttachmentRule) -> str:
    child, parent = belief.args
    bound = unify_call(rule.attach, action)
    if bound is not None:
        new = resolve(rule.parent, bound)
        moved = resolve(rule.child, bound) == child and new != parent and new is not None
        return f"attached it to {format_value(new)} instead" if moved and new is not None else ""
    bound = None if rule.until is None else unify_call(rule.until, action)
    if bound is not None:
        ends = resolve(rule.child, bound) in (None, child)
        if ends and resolve(rule.parent, bound) in (None, parent):
            return "detached it"
    return ""


def unify_call(pattern: Atom, action: Action) -> dict[str, Value] | None:
    """Match the head of a skill or attachment with an action; give the bindings, or None."""
    if pattern.predicate != action.name or len(pattern.args) != len(action.args):
        return None
    return unify(zip(pattern.args, action.args, strict=True))
