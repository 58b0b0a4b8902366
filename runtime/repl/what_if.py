"""Commands that suppose something: what would be believed, and what would be done."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import RenderableType

from icarus_lite.inference import InferenceEngine, Memory, ground
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.syntax import Condition
from icarus_lite.outcomes import Outcome
from icarus_lite.planning import Imagination, Plan, find_plan
from icarus_lite.symbols import Action
from icarus_lite.trace import pattern_of
from runtime.repl.command import Command, CommandError, Takes, no_words
from runtime.repl.session import Session
from runtime.repl.showing import line, lines
from runtime.repl.supposing import Supposition, differences, read_edit, supposed_instant


def assume(session: Session, text: str) -> Iterator[RenderableType]:
    """Suppose a fact."""
    yield from _suppose(session, text, assumed=True)


def retract(session: Session, text: str) -> Iterator[RenderableType]:
    """Suppose that a fact were not so."""
    yield from _suppose(session, text, assumed=False)


def _suppose(session: Session, text: str, *, assumed: bool) -> Iterator[RenderableType]:
    if not text:
        raise CommandError(f"{'assume' if assumed else 'retract'} what? for example: (free hand1)")
    before = supposed_instant(session).memory
    edit = read_edit(text, session, assumed=assumed)
    session.supposed = session.supposed.and_also(edit)
    after = supposed_instant(session).memory
    told = list(differences(before, after))
    yield lines([str(edit), *(f"  {change}" for change in told)])


def forget(session: Session, text: str) -> Iterator[RenderableType]:
    """Suppose nothing any more."""
    no_words(text, "forget")
    count = len(session.supposed.edits)
    session.supposed = Supposition()
    what = "1 supposition" if count == 1 else f"{count} suppositions"
    yield line(f"{what} dropped; the record was never touched")


def what_if(session: Session, text: str) -> Iterator[RenderableType]:
    """Say what would be believed and planned as things are supposed, or after an action."""
    actual = session.instant.memory
    memory, told = supposed_instant(session).memory, [str(e) for e in session.supposed.edits]
    engine = session.recording.engine
    if text:
        action = _action(session, text)
        memory = _after(memory, action, engine)
        told.append(f"if {action} succeeded:")
    elif not session.supposed:
        raise CommandError(
            "what if what? an action, as in what-if (insert plug case), or first `assume` something"
        )
    changes = [f"  {change}" for change in differences(actual, memory)]
    yield lines([*told, *(changes or ["  nothing else would be believed"])])
    yield lines(_plan(session, memory, engine))


def _action(session: Session, text: str) -> Action:
    pattern = pattern_of(text)
    skills = {skill.head.predicate for skill in session.domain.skills}
    if pattern.predicate not in skills:
        known = ", ".join(sorted(skills)) or "none"
        raise CommandError(f"`{pattern.predicate}` is no skill; the skills are {known}")
    action = ground(pattern, {})
    if action is None:
        raise CommandError(f"{pattern} has variables; say which instance is meant")
    return Action(action.predicate, action.args)


def _after(memory: Memory, action: Action, engine: InferenceEngine) -> Memory:
    """Give the memory after an action's success, percepts as they are."""
    return engine.step(memory, memory.state.percepts, [Outcome(action)])


def _plan(session: Session, memory: Memory, engine: InferenceEngine) -> Iterator[str]:
    goals: tuple[Condition, ...] = tuple(
        goal for text in session.recording.goals for goal in parse_conditions(text)
    )
    if not goals:
        yield "the agent has no goal to plan for"
        return
    imagination = Imagination(session.domain, memory, engine.closure, engine.evaluator)
    found = find_plan(session.domain, imagination, goals)
    if not isinstance(found, Plan):
        yield f"then there would be no plan: {found.reason}"
    elif not found.steps:
        yield "then the goals would be achieved"
    else:
        yield "then the plan would be:"
        yield from (f"{number:>3}  {step.action}" for number, step in enumerate(found.steps, 1))


WHAT_IF = (
    Command(
        "assume",
        "FACT",
        "Suppose a fact: a percept with attributes, an attachment, an effect.",
        "assume (object plug ^seen yes)",
        assume,
        Takes.PATTERN,
    ),
    Command(
        "retract",
        "FACT",
        "Suppose that a fact were not so.",
        "retract (attached hubcover case)",
        retract,
        Takes.PATTERN,
    ),
    Command(
        "what-if",
        "[ACTION]",
        "Say what would be believed and planned as things are supposed, or after an action.",
        "what-if (insert hubcover case)",
        what_if,
        Takes.PATTERN,
    ),
    Command("forget", "", "Drop all suppositions.", "forget", forget),
)
