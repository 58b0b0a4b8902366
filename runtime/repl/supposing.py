"""What if: another state than the recorded one, made of it by assuming and retracting."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from icarus_lite.inference import Assertion, Derivation, Hierarchy, InferenceEngine, Memory, ground
from icarus_lite.language.checking.vocabulary import Origin
from icarus_lite.language.syntax import Atom, Domain
from icarus_lite.symbols import ATTACHED, Action, Belief, Percept
from icarus_lite.trace import Instant, pattern_of
from runtime.repl.command import CommandError

if TYPE_CHECKING:
    from runtime.repl.session import Session

ASSUMED = Action("assumed")
"""Stands for the action behind a belief that is assumed."""


@dataclass(frozen=True, slots=True)
class Edit:
    """One thing assumed, or retracted."""

    fact: Belief
    assumed: bool

    def __str__(self) -> str:
        return f"{'assumed' if self.assumed else 'retracted'} {self.fact}"


@dataclass(frozen=True, slots=True)
class Supposition:
    """What is supposed to be otherwise, in the order in which it was said."""

    edits: tuple[Edit, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.edits)

    def and_also(self, edit: Edit) -> Supposition:
        """Suppose one thing more; what was said of the same fact before no longer counts."""
        kept = tuple(each for each in self.edits if each.fact != edit.fact)
        return Supposition((*kept, edit))

    def applied(self, memory: Memory, engine: InferenceEngine) -> Memory:
        """Give the memory of a cycle as it would be; what it was made of stays as it is."""
        percepts = {(each.type, each.name): each for each in memory.state.percepts}
        types = {each.name for each in engine.domain.percepts}
        asserted, hierarchy = dict(memory.asserted), memory.state.hierarchy
        cycle, notes = memory.state.cycle, list[str]()
        for edit in self.edits:
            fact = edit.fact
            if fact.predicate in types:
                key = (fact.predicate, str(fact.args[0]))
                before = percepts.pop(key, None)
                if edit.assumed:
                    old = {} if before is None else before.attributes
                    percepts[key] = Percept(*key, {**old, **fact.attributes})
            elif fact.predicate == ATTACHED:
                hierarchy, refused = _attached(hierarchy, edit, cycle)
                notes += refused
            elif edit.assumed:
                asserted.pop(fact, None)  # it may have had other attributes
                asserted[fact] = Assertion(ASSUMED, cycle)
            else:
                asserted.pop(fact, None)
        return engine.recall(
            cycle, percepts.values(), asserted, hierarchy, memory.known, tuple(notes)
        )


def _attached(hierarchy: Hierarchy, edit: Edit, cycle: int) -> tuple[Hierarchy, tuple[str, ...]]:
    child, parent = edit.fact.args
    if edit.assumed:
        return hierarchy.attach(child, parent, ASSUMED, cycle)
    return hierarchy.without([(child, parent)]), ()


def read_edit(text: str, session: Session, *, assumed: bool) -> Edit:
    """Read a fact that is to be assumed or retracted.

    Raises:
        CommandError: it has variables; it is concluded from others; it does not hold anyway.
        DomainError: it does not parse.
    """
    pattern = pattern_of(text)
    fact = ground(pattern, {})
    if fact is None:
        raise CommandError(f"{pattern} has variables; say which one is meant")
    instant = supposed_instant(session)
    _check_arguments(pattern, instant, session.domain)
    if Origin.CONCEPT in instant.context.origins(fact.predicate):
        raise CommandError(
            f"{fact} is concluded, by the concept `{fact.predicate}`; "
            f"{_hint(fact, instant, assumed=assumed)}"
        )
    if not assumed and not any(True for _ in instant.context.facts.matches(pattern, {})):
        raise CommandError(f"{pattern} does not hold in cycle {instant.cycle} anyway")
    return Edit(fact, assumed)


def _check_arguments(pattern: Atom, instant: Instant, domain: Domain) -> None:
    origins = instant.context.origins(pattern.predicate)
    if not origins and pattern.predicate != ATTACHED:
        known = ", ".join(sorted(instant.context.names.predicates))
        raise CommandError(f"the domain knows no `{pattern.predicate}`; it knows {known}")
    wanted = 2 if pattern.predicate == ATTACHED else None
    if any(each.name == pattern.predicate for each in domain.percepts):
        wanted = 1
    if wanted is not None and len(pattern.args) != wanted:
        things = "argument" if wanted == 1 else "arguments"
        raise CommandError(f"`{pattern.predicate}` takes {wanted} {things}: {pattern}")


def _hint(fact: Belief, instant: Instant, *, assumed: bool) -> str:
    if assumed:
        return "assume what it follows from; `why-not` says what is missing"
    support = instant.context.support(fact)
    if isinstance(support, Derivation):
        return f"retract what it rests on: {' '.join(map(str, support.matched))}"
    return "it does not hold anyway"


def supposed_instant(session: Session) -> Instant:
    """Give the cycle that is being looked at, with all that is supposed of it."""
    instant = session.instant
    if not session.supposed:
        return instant
    memory = session.supposed.applied(instant.memory, session.recording.engine)
    context = replace(instant.context, state=memory.state, known=memory.known)
    return Instant(instant.record, memory, context)


def differences(before: Memory, after: Memory) -> Iterator[str]:
    """Say which beliefs are held in one state alone."""
    old, new = before.state, after.state
    yield from (f"- {belief}" for belief in old.beliefs if belief not in new)
    yield from (f"+ {belief}" for belief in new.beliefs if belief not in old)
    yield from (note for note in new.notes if note not in old.notes)
