"""Questions over the cycles of a recorded run: when something was so, and what has changed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby

from icarus_lite.errors import FrameError
from icarus_lite.inference import Period, Withdrawal, match, percept_facts, what_ended
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Atom, Condition, Constant
from icarus_lite.outcomes import Status
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import Belief, Percept, Value, format_value
from icarus_lite.trace.recording import Instant, Recording


@dataclass(frozen=True, slots=True)
class Times:
    """When something was so.

    Args:
        fact: The belief or percept, with the values of the attributes that were asked for.
        periods: The stretches of cycles, oldest first.
        ended: What ended the last of them, in words; empty where it lasts or nothing is known.
    """

    fact: str
    periods: tuple[Period, ...]
    ended: str = ""

    def __str__(self) -> str:
        held = ", ".join(map(str, self.periods))
        return f"{self.fact}  {held}" + (f"; {self.ended}" if self.ended else "")

    def as_document(self) -> dict[str, object]:
        """Give it as plain data; the last cycle of a period that lasts is null."""
        periods = [[period.first, period.last] for period in self.periods]
        return {"fact": self.fact, "periods": periods, "ended": self.ended}


@dataclass(frozen=True, slots=True)
class Changed:
    """An attribute of what is perceived, or believed, in both of two cycles.

    Args:
        name: The object, or the belief as it is written.
        attribute: The attribute.
        before: Its value in the first; None where it had none.
        after: Its value in the second; None where it has none.
    """

    name: str
    attribute: str
    before: Value | None
    after: Value | None

    def __str__(self) -> str:
        old, new = ("nothing" if v is None else format_value(v) for v in (self.before, self.after))
        return f"^{self.attribute} {old} -> {new}"


@dataclass(frozen=True, slots=True)
class Comparison:
    """What is different between two cycles.

    Args:
        first: The one.
        second: The other.
        added: Beliefs of the second alone.
        removed: Beliefs of the first alone.
        appeared: Objects perceived in the second alone.
        vanished: Objects perceived in the first alone.
        changed: Attributes of objects that are perceived in both, and of beliefs held in both.
        actions: What was reported of actions after the first, up to the second.
        withdrawn: What was withdrawn in these cycles, with the cycle.
    """

    first: int
    second: int
    added: tuple[Belief, ...]
    removed: tuple[Belief, ...]
    appeared: tuple[Percept, ...]
    vanished: tuple[Percept, ...]
    changed: tuple[Changed, ...]
    actions: tuple[tuple[int, str], ...]
    withdrawn: tuple[tuple[int, Withdrawal], ...] = ()

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def lines(self) -> Iterator[str]:
        """Give its text, a line at a time."""
        yield f"from cycle {self.first} to cycle {self.second}"
        told = [*self.actions, *((cycle, str(each)) for cycle, each in self.withdrawn)]
        told.sort(key=lambda each: each[0])
        yield from (f"  cycle {cycle}: {text}" for cycle, text in told)
        yield from (f"  - {belief}" for belief in self.removed)
        yield from (f"  + {belief}" for belief in self.added)
        yield from (f"  no longer perceived: {percept}" for percept in self.vanished)
        yield from (f"  newly perceived: {percept}" for percept in self.appeared)
        for name, changes in groupby(self.changed, key=lambda change: change.name):
            yield f"  {name}: {', '.join(map(str, changes))}"
        if not self.is_different:
            yield "  nothing has changed"

    @property
    def is_different(self) -> bool:
        """Whether anything differs at all, actions left aside."""
        return any((self.added, self.removed, self.appeared, self.vanished, self.changed))

    def as_document(self) -> dict[str, object]:
        """Give it as plain data."""
        withdrawn = [
            {"cycle": cycle, "belief": str(each.belief)}
            | {"because": list(each.because), "cycles": each.cycles}
            for cycle, each in self.withdrawn
        ]
        return {
            "from": self.first,
            "to": self.second,
            "actions": [{"cycle": cycle, "report": report} for cycle, report in self.actions],
            **({"withdrawn": withdrawn} if withdrawn else {}),
            "added": list(map(str, self.added)),
            "removed": list(map(str, self.removed)),
            "appeared": list(map(str, self.appeared)),
            "vanished": list(map(str, self.vanished)),
            "changed": [
                {"name": c.name, "attribute": c.attribute, "before": c.before, "after": c.after}
                for c in self.changed
            ],
        }


def pattern_of(text: str) -> Atom:
    """Read what is asked for: one literal, `(attached ?x case)`; variables stand for anything.

    Raises:
        DomainError: the text does not parse; the message points at the place.
        FrameError: it is several literals, or a negated one.
    """
    conditions = parse_conditions(text, "<question>")
    if len(conditions) != 1 or conditions[0].negated:
        raise FrameError(f"expected one pattern such as (attached ?part case), got {text}")
    return conditions[0].atom


def condition_of(text: str) -> Condition:
    """Read what is asked for, which may be negated. Raises as `pattern_of` does."""
    conditions = parse_conditions(text, "<question>")
    if len(conditions) != 1:
        raise FrameError(f"expected one literal such as (attached ?part case), got {text}")
    return conditions[0]


def matching(pattern: Atom, instant: Instant) -> tuple[tuple[Belief, Mapping[str, Value]], ...]:
    """Give the percepts and beliefs of a cycle that match, each with its bindings, in order."""
    found = {fact: bound for bound, fact in instant.context.facts.matches(pattern, {})}
    return tuple(sorted(found.items(), key=lambda each: str(each[0])))


def when(pattern: Atom, recording: Recording) -> tuple[Times, ...]:
    """Say when anything that matches a pattern was believed or perceived.

    Attributes may be asked for as well: `(object plug ^seen no)`. Of percepts each line of the
    trace is looked at, of beliefs with attributes each cycle in which there is one.
    """
    if any(percept.name == pattern.predicate for percept in recording.domain.percepts):
        return _in_order(_periods(pattern, _perceived(pattern, recording)))
    chronicle, domain = recording.chronicle(), recording.domain
    if pattern.attributes:
        return _in_order(_periods(pattern, _with_attributes(pattern, recording)))
    found = (
        Times(str(belief), periods, what_ended(belief, periods[-1], chronicle, domain))
        for belief, periods in chronicle.matching(pattern)
    )
    return _in_order(found)


def _in_order(found: Iterable[Times]) -> tuple[Times, ...]:
    return tuple(sorted(found, key=lambda each: (each.periods[0].first, each.fact)))


def compare(first: Instant, second: Instant, recording: Recording) -> Comparison:
    """Say what is different between two cycles of a run."""
    old, new = first.state, second.state
    before = {(each.type, each.name): each for each in old.percepts}
    after = {(each.type, each.name): each for each in new.percepts}
    kept = {belief: belief for belief in new.beliefs}
    return Comparison(
        first.cycle,
        second.cycle,
        tuple(belief for belief in new.beliefs if belief not in old),
        tuple(belief for belief in old.beliefs if belief not in new),
        tuple(percept for key, percept in after.items() if key not in before),
        tuple(percept for key, percept in before.items() if key not in after),
        (
            *_changed((each.name, each, after.get(key)) for key, each in before.items()),
            *_changed((str(each), each, kept.get(each)) for each in old.beliefs),
        ),
        tuple(_reported(first.cycle, second.cycle, recording)),
        tuple(_withdrawn(first.cycle, second.cycle, recording)),
    )


def _changed(
    pairs: Iterable[tuple[str, Percept | Belief, Percept | Belief | None]],
) -> Iterator[Changed]:
    """Give the attributes that differ, of what there is before and after, by its name."""
    for name, old, new in pairs:
        if new is None:
            continue
        for attribute in dict.fromkeys((*old.attributes, *new.attributes)):
            was, now = old.attributes.get(attribute), new.attributes.get(attribute)
            if was != now:
                yield Changed(name, attribute, was, now)


def _reported(first: int, second: int, recording: Recording) -> Iterator[tuple[int, str]]:
    """Give what was reported of actions that ended between two cycles."""
    for cycle, outcome in recording.reports(min(first, second) + 1, max(first, second)):
        if outcome.status is not Status.RUNNING:
            reason = f": {outcome.reason}" if outcome.reason else ""
            yield cycle, f"{outcome.action} {outcome.status}{reason}"


def _withdrawn(first: int, second: int, recording: Recording) -> Iterator[tuple[int, Withdrawal]]:
    """Give what was withdrawn after the earlier of two cycles, up to the later one."""
    low, high = min(first, second), max(first, second)
    for cycle, each in recording.chronicle().withdrawals():
        if low < cycle <= high:
            yield cycle, each


def _perceived(pattern: Atom, recording: Recording) -> Iterator[tuple[int, list[Belief]]]:
    """Give what matches of the percepts of each cycle."""
    families = lineages(recording.domain.percepts)
    names = {str(t.value) for t in pattern.args[:1] if isinstance(t, Constant)}
    for cycle, percepts in recording.percepts():
        wanted = tuple(each for each in percepts if not names or each.name in names)
        yield cycle, list(_matches(pattern, percept_facts(wanted, families)))


def _with_attributes(pattern: Atom, recording: Recording) -> Iterator[tuple[int, list[Belief]]]:
    """Give what matches of the beliefs of each cycle, derived anew where there may be some."""
    bare = replace(pattern, attributes=())
    believed = [period for _, each in recording.chronicle().matching(bare) for period in each]
    for cycle in recording.cycles:
        possible = any(p.first <= cycle and (p.last is None or cycle <= p.last) for p in believed)
        yield cycle, [f for f, _ in matching(pattern, recording.at(cycle))] if possible else []


def _periods(pattern: Atom, found: Iterable[tuple[int, list[Belief]]]) -> Iterator[Times]:
    """Put the cycles in which the same was so together."""
    periods: dict[str, list[Period]] = {}
    since: dict[str, int] = {}
    last = -1
    for cycle, facts in found:
        now = [_shown(pattern, fact) for fact in facts]
        for fact in [fact for fact in since if fact not in now]:
            periods[fact].append(Period(since.pop(fact), last))
        for fact in now:
            periods.setdefault(fact, [])
            since.setdefault(fact, cycle)
        last = cycle
    for fact, first in since.items():
        periods[fact].append(Period(first))
    yield from (Times(fact, tuple(held)) for fact, held in periods.items())


def _matches(pattern: Atom, facts: Iterable[Belief]) -> Iterator[Belief]:
    for fact in facts:
        if fact.predicate == pattern.predicate and match(pattern, fact, {}) is not None:
            yield fact


def _shown(pattern: Atom, fact: Belief) -> str:
    """Write a fact with the attributes that a pattern names."""
    named = (f" ^{name} {format_value(fact.attributes[name])}" for name, _ in pattern.attributes)
    return f"{str(fact)[:-1]}{''.join(named)})"
