"""Commands for a run that goes on: what is perceived, what became of actions, the edited domain."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from rich.console import RenderableType

from icarus_lite.inference import ground
from icarus_lite.language import diagnose_file
from icarus_lite.language.diagnostics import Severity, render
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.symbols import Action, Percept
from icarus_lite.trace import pattern_of
from runtime.repl.command import Command, CommandError, Takes, no_words
from runtime.repl.domain_changes import domain_changes
from runtime.repl.runs import TypedRun
from runtime.repl.session import Session
from runtime.repl.showing import line, lines
from runtime.repl.supposing import differences

_MOST_ERRORS = 5


def percept(session: Session, text: str) -> Iterator[RenderableType]:
    """Say that something is perceived from the next cycle on."""
    run = _typed(session)
    pattern = pattern_of(text)
    types = [each.name for each in session.domain.percepts]
    if pattern.predicate not in types:
        raise CommandError(
            f"`{pattern.predicate}` is no percept type; there are {', '.join(types)}"
        )
    fact = ground(pattern, {})
    if fact is None or len(fact.args) != 1:
        raise CommandError(f"a percept has one name and values: ({pattern.predicate} o1 ^x 0.3)")
    key = (fact.predicate, str(fact.args[0]))
    old = run.percepts[key].attributes if key in run.percepts else {}
    run.percepts[key] = Percept(*key, {**old, **fact.attributes})
    yield line(f"perceived from the next cycle on: {run.percepts[key]}")


def gone(session: Session, text: str) -> Iterator[RenderableType]:
    """Say that something is no longer perceived."""
    run = _typed(session)
    keys = [key for key in run.percepts if key[1] == text]
    if not keys:
        names = ", ".join(sorted(name for _, name in run.percepts)) or "nothing"
        raise CommandError(f"no `{text}` is perceived; perceived is {names}")
    for key in keys:
        del run.percepts[key]
    yield line(f"{text} is not perceived from the next cycle on")


def outcome(session: Session, text: str) -> Iterator[RenderableType]:
    """Say what became of an action."""
    run = _typed(session)
    word, _, rest = text.partition(" ")
    statuses = {str(status): status for status in Status}
    if word not in statuses:
        raise CommandError(f"expected one of {', '.join(statuses)} first; got `{text}`")
    action, reason = run.started, rest.strip()
    if reason.startswith("("):
        end = reason.rfind(")") + 1
        fact = ground(pattern_of(reason[:end]), {})
        if fact is None:
            raise CommandError("an action has no variables: outcome failed (pick-up hand1 plug)")
        action, reason = Action(fact.predicate, fact.args), reason[end:].strip()
    if action is None:
        raise CommandError("no action is under way; name one: outcome failed (pick-up hand1 plug)")
    run.outcomes.append(Outcome(action, statuses[word], reason))
    yield line(f"reported in the next cycle: {action} {word}" + (f": {reason}" if reason else ""))


def load(session: Session, text: str) -> Iterator[RenderableType]:
    """Take the percepts of the next cycles from a file."""
    if not text:
        raise CommandError("load which file of frames? for example: load recorded.jsonl")
    _typed(session).load(Path(text).expanduser())
    yield line(f"the next cycles take their percepts from {text}; `step` or `cont` runs them")


def reload(session: Session, text: str) -> Iterator[RenderableType]:
    """Read the domain file again."""
    file = Path(text).expanduser() if text else session.file
    if file is None:
        raise CommandError("reload which file? a trace holds its own domain: reload mine.icr")
    domain, source, diagnostics = diagnose_file(file)
    if domain is None:
        errors = [each for each in diagnostics if each.severity is Severity.ERROR]
        yield lines(render(each, source) for each in errors[:_MOST_ERRORS])
        if len(errors) > _MOST_ERRORS:
            yield line(
                f"and {len(errors) - _MOST_ERRORS} errors more; `icarus check` tells them all"
            )
        yield line("the domain that was running goes on", "yellow")
        return
    before = session.instant.memory if session.has_cycle else None
    told = list(domain_changes(session.domain, domain))
    session.use(domain)
    yield lines(told or [f"{file}: nothing has changed"])
    if before is not None:
        changes = [f"  {change}" for change in differences(before, session.instant.memory)]
        head = f"by the new rules, in cycle {session.cycle}:"
        yield lines([head, *(changes or ["  the same is believed"])])


def task(session: Session, text: str) -> Iterator[RenderableType]:
    """List the tasks of the domain."""
    no_words(text, "tasks")
    found = [
        f"{each.name}  {each.title}  {' '.join(map(str, each.goals))}"
        for each in session.domain.tasks
    ]
    yield lines(found or ["the domain has no tasks"])


def _typed(session: Session) -> TypedRun:
    if isinstance(session.live, TypedRun):
        return session.live
    if session.live is None:
        raise CommandError("this run is over: what was recorded stays; `assume` supposes something")
    raise CommandError("this run has a body of its own that perceives and reports")


LIVING = (
    Command(
        "percept",
        "FACT",
        "Say that something is perceived, from the next cycle on.",
        "percept (object plug ^type plug ^x 0.4 ^y 0.1 ^z 0.01 ^seen yes)",
        percept,
        Takes.PATTERN,
        live=True,
    ),
    Command(
        "gone",
        "NAME",
        "Say that something is no longer perceived.",
        "gone plug",
        gone,
        Takes.OBJECT,
        live=True,
    ),
    Command(
        "outcome",
        "STATUS [ACTION] [REASON]",
        "Say what became of the action under way, or of another agent's.",
        "outcome failed (pick-up hand1 plug) it slipped",
        outcome,
        live=True,
    ),
    Command(
        "load",
        "FILE",
        "Take the percepts of the next cycles from a file of frames.",
        "load recorded.jsonl",
        load,
        Takes.FILE,
        live=True,
    ),
    Command(
        "reload",
        "[FILE]",
        "Read the edited domain again, and say what is believed; a broken file changes nothing.",
        "reload",
        reload,
        Takes.FILE,
    ),
    Command("tasks", "", "List the tasks of the domain.", "tasks", task),
)
