"""Where a run is to stop: typed in the REPL, or declared in the domain."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from icarus_lite.inference import match
from icarus_lite.language.breakpoint import Moment
from icarus_lite.language.syntax import Atom, Domain
from icarus_lite.symbols import Belief
from icarus_lite.trace import matching, parse_action, pattern_of
from runtime.repl.command import CommandError

if TYPE_CHECKING:
    from runtime.repl.session import Session

WORDS: Final = {
    "gained": Moment.GAIN,
    "lost": Moment.LOSS,
    "started": Moment.START,
    "succeeded": Moment.SUCCESS,
    "failed": Moment.FAILURE,
}
"""What may stand before a pattern, and the moment that it means."""

EVENTS: Final = ("goal", "impasse", "failure")
"""What a run may stop at without a pattern."""


@dataclass(frozen=True, slots=True)
class Stop:
    """Where a run stops.

    Args:
        event: A word of `EVENTS`, or empty.
        moment: When, for a pattern.
        pattern: The belief or skill.
        condition: What must be believed or perceived besides, if anything.
        place: Where it is declared, if it is.
    """

    event: str = ""
    moment: Moment = Moment.GAIN
    pattern: Atom | None = None
    condition: Atom | None = None
    place: str = ""

    def __str__(self) -> str:
        word = next(word for word, moment in WORDS.items() if moment is self.moment)
        text = self.event or f"{word} {self.pattern}"
        condition = "" if self.condition is None else f" if {self.condition}"
        return f"{text}{condition}" + (f"  ({self.place})" if self.place else "")


def declared(domain: Domain) -> Iterator[Stop]:
    """Give the breakpoints that a domain declares."""
    for each in domain.breakpoints:
        moment = each.moment
        if each.condition.negated and moment is Moment.GAIN:
            moment = Moment.LOSS
        yield Stop(moment=moment, pattern=each.condition.atom, place=each.span.in_line)


def read(text: str, domain: Domain) -> Stop:
    """Read a breakpoint as it is typed: `lost (free ?h) if (holding ?h plug)`, `goal`, ….

    Raises:
        CommandError: it is none.
        DomainError: a pattern in it does not parse.
    """
    body, found, condition = text.partition(" if ")
    wanted = pattern_of(condition) if found else None
    word, _, rest = body.strip().partition(" ")
    if word in EVENTS and not rest:
        return Stop(word, condition=wanted)
    if word.startswith("("):
        pattern = pattern_of(body)
        done = {each.predicate for skill in domain.skills for each in (skill.head, *skill.actions)}
        moment = Moment.START if pattern.predicate in done else Moment.GAIN
        return Stop(moment=moment, pattern=pattern, condition=wanted)
    if word in WORDS and rest.strip():
        return Stop(moment=WORDS[word], pattern=pattern_of(rest), condition=wanted)
    events, words = ", ".join(EVENTS), ", ".join(WORDS)
    raise CommandError(
        f"expected {events}, or a pattern, with one of {words} before it; got `{text}`"
    )


def reached(stop: Stop, session: Session) -> str:
    """Say why the cycle that is being looked at is one to stop at; empty if it is not."""
    why = _event(stop.event, session.record) if stop.event else _moment(stop, session)
    if why and stop.condition is not None and not matching(stop.condition, session.instant):
        return ""
    return why


def _event(event: str, record: Mapping[str, object]) -> str:
    decision = record.get("decision")
    kind = decision.get("kind") if isinstance(decision, dict) else None
    if event == "goal" and kind == "achieved":
        return "all goals are believed"
    if event == "impasse" and kind == "impasse" and isinstance(decision, dict):
        return f"impasse: {decision.get('reason')}"
    if event == "failure":
        outcomes = record.get("outcomes")
        for row in outcomes if isinstance(outcomes, list) else ():
            if row["status"] == "failed":
                return f"({' '.join(map(str, (row['name'], *row['args'])))}) failed"
    return ""


def _moment(stop: Stop, session: Session) -> str:
    if stop.pattern is None:
        return ""
    added, removed = session.recording.changes(session.cycle)
    if stop.moment is Moment.GAIN:
        return _first(stop.pattern, added, "is believed now")
    if stop.moment is Moment.LOSS:
        return _first(stop.pattern, removed, "is no longer believed")
    if stop.moment is Moment.START:
        return _first(stop.pattern, _started(session.record), "is started")
    status = "succeeded" if stop.moment is Moment.SUCCESS else "failed"
    ended = [
        Belief(outcome.action.name, outcome.action.args)
        for _, outcome in session.recording.reports(session.cycle, session.cycle)
        if outcome.status == status
    ]
    return _first(stop.pattern, tuple(ended), status)


def _first(pattern: Atom, facts: tuple[Belief, ...], what: str) -> str:
    for fact in facts:
        if fact.predicate == pattern.predicate and match(pattern, fact, {}) is not None:
            return f"{fact} {what}"
    return ""


def _started(record: Mapping[str, object]) -> tuple[Belief, ...]:
    """Give the skill that is started in a cycle, and the commands that the driver is given."""
    decision = record.get("decision")
    if not isinstance(decision, dict) or decision.get("kind") != "act":
        return ()
    commands = decision.get("commands")
    texts = [decision["action"], *(commands if isinstance(commands, list) else ())]
    actions = [parse_action(str(text)) for text in texts]
    return tuple(Belief(action.name, action.args) for action in actions)
