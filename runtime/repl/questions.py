"""Commands that ask: why, why not, when, what is different, what an action is for."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import RenderableType

from icarus_lite.inference import match
from icarus_lite.language.syntax import Atom
from icarus_lite.symbols import Belief
from icarus_lite.trace import compare, matching, parse_action, pattern_of, serves
from icarus_lite.trace import when as times_of
from runtime.repl.command import Command, CommandError, Takes, number
from runtime.repl.session import Session
from runtime.repl.showing import line, lines, rows
from runtime.repl.supposing import supposed_instant

_MOST = 10
"""Explanations given at once."""


def why(session: Session, text: str) -> Iterator[RenderableType]:
    """Say why something is believed."""
    wanted, alternatives = text.removeprefix("all ").strip(), text.startswith("all ")
    if not wanted:
        raise CommandError("why what? for example: why (attached hubcover case)")
    instant = supposed_instant(session)
    found = matching(pattern_of(wanted), instant)
    if not found:
        yield lines(instant.why_not(wanted).lines(""))
        return
    for fact, _ in found[:_MOST]:
        yield lines(instant.why(fact, alternatives=alternatives).lines())
    if len(found) > _MOST:
        yield line(f"and {len(found) - _MOST} more; `beliefs {wanted}` lists them")


def why_not(session: Session, text: str) -> Iterator[RenderableType]:
    """Say why something is not believed, or why a skill cannot start."""
    if not text:
        raise CommandError("why not what? for example: why-not (holding hand1 ?any)")
    yield lines(supposed_instant(session).why_not(text).lines(""))


def when(session: Session, text: str) -> Iterator[RenderableType]:
    """Say when something was believed or perceived."""
    if not text:
        raise CommandError("when what? for example: when (attached ?part case)")
    pattern = pattern_of(text)
    found = times_of(pattern, session.recording)
    yield lines(map(str, found)) if found else line(f"nothing that matches {pattern} ever was")


def diff(session: Session, text: str) -> Iterator[RenderableType]:
    """Say what is different between two cycles."""
    words = text.split()
    if len(words) not in (1, 2):
        raise CommandError("diff takes one cycle or two: diff 40 120")
    first = number(words[0], "a cycle")
    second = number(words[1], "a cycle") if len(words) == 2 else session.cycle
    recording = session.recording
    yield lines(compare(recording.at(first), recording.at(second), recording).lines())


def explain(session: Session, text: str) -> Iterator[RenderableType]:
    """Say what an action is, or was, for."""
    pattern = pattern_of(text) if text else None
    found = None
    for cycle in reversed([c for c in session.recording.cycles if c <= session.cycle]):
        record = session.recording.record(cycle)
        decision, skills = record.get("decision"), record.get("skills")
        if not isinstance(decision, dict) or decision.get("kind") != "act":
            continue
        if pattern is None or _is_meant(pattern, str(decision["action"])):
            found = cycle, record, decision, skills
            break
    if found is None:
        what = "no action" if pattern is None else f"nothing that matches {pattern}"
        raise CommandError(f"{what} was started up to cycle {session.cycle}")
    cycle, record, decision, skills = found
    told = [f"{decision['action']} was started in cycle {cycle}: {decision['reason']}"]
    if isinstance(skills, dict):
        told.append(f"  for {' '.join(map(str, skills.get('aims', ())))}")
        told += [f"    through {level['skill']}" for level in skills.get("levels", ())[:-1]]
    told += [f"  {text}" for text in serves(session.recording, cycle)]
    plan = record.get("path")
    if isinstance(plan, list) and len(plan) > 1:
        told.append(f"  then {', '.join(map(str, plan[1:]))}")
    others = [row for row in rows(record, "candidates") if not row["chosen"]]
    told += [f"  not {row['skill']}: {row['why_not']}" for row in others]
    told += [f"  {text}" for text in _effects(session, str(decision["action"]), cycle)]
    yield lines(told)


def _is_meant(pattern: Atom, action: str) -> bool:
    started = parse_action(action)
    fact = Belief(started.name, started.args)
    return fact.predicate == pattern.predicate and match(pattern, fact, {}) is not None


def _effects(session: Session, action: str, cycle: int) -> Iterator[str]:
    """Say what came of an action: how it ended, and what its success brought about."""
    for later, outcome in session.recording.reports(cycle + 1, session.recording.cycles[-1]):
        if str(outcome.action) != action or outcome.status == "running":
            continue
        reason = f": {outcome.reason}" if outcome.reason else ""
        yield f"it {outcome.status} in cycle {later}{reason}"
        added, removed = session.recording.changes(later)
        if outcome.status == "succeeded":
            yield from (f"  + {belief}" for belief in added)
            yield from (f"  - {belief}" for belief in removed)
        return
    yield "nothing is on record of how it ended"


QUESTIONS = (
    Command(
        "why",
        "[all] PATTERN",
        "Say why something is believed, down to percepts and actions; `all`: every derivation.",
        "why (attached hubcover case)",
        why,
        Takes.PATTERN,
    ),
    Command(
        "why-not",
        "PATTERN|SKILL",
        "Say what keeps something from being believed, or a skill from starting.",
        "why-not (insert hubcover case)",
        why_not,
        Takes.PATTERN,
    ),
    Command(
        "when",
        "PATTERN",
        "Say in which cycles something was believed or perceived, and what ended it.",
        "when (object plug ^seen no)",
        when,
        Takes.PATTERN,
    ),
    Command(
        "diff",
        "A [B]",
        "Say what is different between two cycles, or between one and the present.",
        "diff 40 120",
        diff,
        Takes.CYCLE,
    ),
    Command(
        "explain",
        "[ACTION]",
        "Say what the last action, or the last one that matches, was for, and what came of it.",
        "explain (pick-up hand1 ?part)",
        explain,
        Takes.PATTERN,
    ),
)
