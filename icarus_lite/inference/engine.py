"""The inference engine: percepts and the last actions in, beliefs with their supports out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from icarus_lite.errors import FrameError
from icarus_lite.inference.attachment import ATTACHED, Hierarchy, Link, advance
from icarus_lite.inference.belief_supports import BeliefSupports, LazyFacts
from icarus_lite.inference.causes import Causes
from icarus_lite.inference.closure import Closure
from icarus_lite.inference.effects import Change, change_by_action
from icarus_lite.inference.facts import (
    FactStore,
    Lineages,
    check_arguments,
    check_values,
    percept_facts,
)
from icarus_lite.inference.matching import Evaluator, Functions
from icarus_lite.inference.network import Budget, Network, compile_domain
from icarus_lite.inference.supports import Assertion, Support
from icarus_lite.language.checking.stratification import strata
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Domain
from icarus_lite.symbols import Belief, Outcome, Percept, Status, Value


@dataclass(frozen=True, slots=True)
class BeliefState:
    """What is believed in one cycle.

    Args:
        cycle: Its number, from 0.
        percepts: The percepts, as they came.
        supports: Each belief (percepts left out) with all its supports, never empty.
        hierarchy: The attachment hierarchy behind the `attached` beliefs.
        notes: What the person should know, such as an attachment refused as circular.
        lineages: Each percept type with all types that its percepts belong to, its own first.
    """

    cycle: int = -1
    percepts: tuple[Percept, ...] = ()
    supports: Mapping[Belief, tuple[Support, ...]] = field(default_factory=dict)
    hierarchy: Hierarchy = field(default_factory=Hierarchy)
    notes: tuple[str, ...] = ()
    lineages: Lineages = field(default_factory=dict)

    def __contains__(self, belief: Belief) -> bool:
        return belief in self.supports

    @property
    def beliefs(self) -> tuple[Belief, ...]:
        """All beliefs, percepts left out, sorted as they are written."""
        return tuple(sorted(self.supports, key=str))

    def asserted(self) -> Iterator[tuple[Belief, Assertion]]:
        """Give the beliefs that rest on actions, with what asserted each; attachments last."""
        supports = self.supports
        rows = supports.given if isinstance(supports, BeliefSupports) else supports
        for belief, (first, *_) in rows.items():
            if isinstance(first, Assertion):
                yield belief, first

    def reasons(self) -> Callable[[Belief], Support | Percept | None]:
        """Give what gives the first support of a belief, or the percept that a fact stands for.

        None for what is neither. It is good until the next cycle is inferred.
        """
        if isinstance(self.supports, BeliefSupports):
            return self.supports.reasons()
        first, percept = self.supports.get, self.percept
        return lambda fact: next(iter(first(fact, ())), None) or percept(fact)

    def percept(self, fact: Belief) -> Percept | None:
        """Give the percept that a fact stands for: of that type, or of one that is a kind of it."""
        if isinstance(self.supports, BeliefSupports):
            return self.supports.percept(fact)
        named = (each for each in self.percepts if fact.args == (each.name,))
        types = ((each, self.lineages.get(each.type, (each.type,))) for each in named)
        return next((each for each, lineage in types if fact.predicate in lineage), None)

    def since(self, before: BeliefState) -> tuple[tuple[Belief, ...], tuple[Belief, ...]]:
        """Give the beliefs added and removed since another cycle, each sorted as written."""
        mine, theirs = self.supports, before.supports
        if isinstance(mine, BeliefSupports) and isinstance(theirs, BeliefSupports):
            changes = mine.changes_since(theirs)
            if changes is not None:
                return changes.added, changes.removed
        added = tuple(belief for belief in self.beliefs if belief not in before)
        return added, tuple(belief for belief in before.beliefs if belief not in self)

    def facts(self) -> FactStore:
        """Give percepts and beliefs together, to match patterns against."""
        if isinstance(self.supports, BeliefSupports):
            return LazyFacts(self.percepts, self.lineages, self.supports)
        store = FactStore(percept_facts(self.percepts, self.lineages))
        for belief in self.supports:
            store.add(belief)
        return store


@dataclass(frozen=True, slots=True)
class Memory:
    """What the engine carries from one cycle to the next.

    Args:
        state: The beliefs of the last cycle.
        asserted: Persisting effects, each with the action and cycle that asserted it.
        known: Names of all objects ever perceived; one of them that is gone takes its facts along.
    """

    state: BeliefState = field(default_factory=BeliefState)
    asserted: Mapping[Belief, Assertion] = field(default_factory=dict)
    known: frozenset[str] = frozenset()


class InferenceEngine:
    """Derives the beliefs of each cycle from percepts and the last actions.

    An effect of an action that succeeded is asserted and persists until an effect removes it or
    an object in it is no longer perceived, unless concepts define its predicate: then perception
    decides, each cycle, whether it holds. `attached` follows Algorithm 1. An action that failed
    or still runs asserts nothing.

    What is believed lies in the memory that `step` takes and gives. The engine keeps a network
    that stands where the last step ended, so that the next one costs what has changed; from
    another memory it goes there first.

    Args:
        domain: A checked domain.
        functions: Python predicates that `:tests` may call by name. They must be pure.
        budget: What one cycle may cost in beliefs and in time; a cycle that would cost more is an
            InferenceError that names the clause. And how many changes of past cycles to keep.
    """

    __slots__ = (
        "_budget", "_causes", "_network", "_order", "_past", "closure", "domain", "evaluator",
        "lineages",
    )  # fmt: skip

    def __init__(
        self, domain: Domain, functions: Functions | None = None, budget: Budget | None = None
    ) -> None:
        self.domain = domain
        self._budget = budget
        self.lineages = lineages(domain.percepts)
        self.evaluator = Evaluator(functions or {}, domain.source.path)
        self.closure = Closure(domain.concepts, self.evaluator)
        self._order = tuple(concept for layer in strata(domain.concepts) for concept in layer)
        self._network: Network | None = None
        self._causes = Causes()
        self._past: BeliefState | None = None

    def step(
        self,
        memory: Memory,
        percepts: Iterable[Percept],
        outcomes: Sequence[Outcome] = (),
        changes: Mapping[int, Change] | None = None,
    ) -> Memory:
        """Infer the beliefs of the next cycle.

        Args:
            memory: What was carried over from the last cycle; `Memory()` at the start.
            percepts: Everything perceived now (anchored objects, seen or hidden).
            outcomes: The actions that ended (or still run) since the last cycle, in order. Each is
                judged by the state that those before it have left.
            changes: For outcome number i, its exact effects where they are known (the agent
                planned them); otherwise they are worked out from the skill's clauses.

        Raises:
            FrameError: two percepts of one type, or of a type and its subtype, share a name, or an
                attribute or an argument of an action is not finite.
            InferenceError: a test of the domain cannot be evaluated.
        """
        seen = _checked(percepts, self.lineages)
        cycle = memory.state.cycle + 1
        present = frozenset(percept.name for percept in seen)
        known = memory.known | present
        asserted, hierarchy = dict(memory.asserted), memory.state.hierarchy
        notes: list[str] = []
        before: FactStore | None = memory.state.facts() if outcomes else None
        for number, outcome in enumerate(outcomes):
            check_arguments(outcome.action)
            if outcome.status is not Status.SUCCEEDED:
                continue
            change = (changes or {}).get(number)
            if change is None:
                if before is None:  # what the outcomes so far have left, as far as was perceived
                    percepts_then = memory.state.percepts
                    before = self._imagine(percepts_then, asserted, hierarchy)
                change = change_by_action(
                    self.domain.skills, outcome.action, before, self.evaluator
                )
            cause = Assertion(outcome.action, cycle)
            asserted = self._assert(asserted, change, cause)
            hierarchy, refused = hierarchy.with_change(change, outcome.action, cycle)
            notes.extend(refused)
            hierarchy, refused = advance(hierarchy, self.domain.attachments, outcome.action, cycle)
            notes.extend(refused)
            before = None
        gone = known - present
        asserted = {b: a for b, a in asserted.items() if gone.isdisjoint(b.args)}
        hierarchy = hierarchy.without(p for p in hierarchy.pairs() if not gone.isdisjoint(p))
        state = self._infer(cycle, seen, asserted, hierarchy, tuple(notes))
        return Memory(state, asserted, known)

    def recall(
        self,
        cycle: int,
        percepts: Iterable[Percept],
        asserted: Mapping[Belief, Assertion],
        hierarchy: Hierarchy,
        known: Iterable[str] = (),
        notes: tuple[str, ...] = (),
    ) -> Memory:
        """Give the memory of a cycle from what was recorded of it, and derive its beliefs anew.

        Args:
            cycle: Its number.
            percepts: What was perceived in it.
            asserted: The effects that persisted then, `attached` left out.
            hierarchy: The attachments of then.
            known: The names of all objects perceived up to then; those of now are added.
            notes: What the person should know.

        Raises:
            FrameError: as for `step`.
            InferenceError: as for `step`.
        """
        seen = _checked(percepts, self.lineages)
        state = self._infer(cycle, seen, asserted, hierarchy, notes)
        return Memory(state, asserted, frozenset(known) | {percept.name for percept in seen})

    def look_back(self, cycle: int) -> BeliefState:
        """Give what was believed in a cycle of the run that the last step belongs to.

        Percepts and assertions are taken back by the log of changes, and what follows from them
        is derived again. Notes are not kept.

        Raises:
            ForgottenError: there was no such cycle, or it is no longer on record.
        """
        number = self._causes.number(cycle)
        assert self._network is not None  # there has been a cycle
        if self._past is None or self._past.cycle != cycle:
            then = self._network.recall(number)
            given, percepts = self._causes.at(cycle), then.percepts()
            supports = BeliefSupports(then, self._order, given, percepts)
            hierarchy = _hierarchy(given)
            self._past = BeliefState(cycle, percepts, supports, hierarchy, (), self.lineages)
        return self._past

    def _assert(
        self, asserted: Mapping[Belief, Assertion], change: Change, cause: Assertion
    ) -> dict[Belief, Assertion]:
        kept = {b: a for b, a in asserted.items() if not change.removes(b)}
        for belief in change.added:
            if belief.predicate != ATTACHED and belief.predicate not in self.closure.concepts:
                kept[belief] = cause
        return kept

    def _infer(
        self,
        cycle: int,
        percepts: tuple[Percept, ...],
        asserted: Mapping[Belief, Assertion],
        hierarchy: Hierarchy,
        notes: tuple[str, ...],
    ) -> BeliefState:
        given = _given(asserted, hierarchy)
        network = self._network
        if network is None:
            network = compile_domain(self.domain, self.evaluator.functions).network(self._budget)
        changes = network.update_snapshot(percepts, given)
        self._network, self._past = network, None
        self._causes.note(cycle, network.cycle, given, network.first_cycle)
        supports = BeliefSupports(network, self._order, given, percepts, changes)
        return BeliefState(cycle, percepts, supports, hierarchy, notes, self.lineages)

    def _imagine(
        self,
        percepts: tuple[Percept, ...],
        asserted: Mapping[Belief, Assertion],
        hierarchy: Hierarchy,
    ) -> FactStore:
        """Give all that would be believed, without saying that it is."""
        facts = FactStore(percept_facts(percepts, self.lineages))
        for belief in _given(asserted, hierarchy):
            facts.add(belief)
        self.closure.derive(facts)
        return facts


def _given(
    asserted: Mapping[Belief, Assertion], hierarchy: Hierarchy
) -> dict[Belief, tuple[Support, ...]]:
    """Give the beliefs that rest on actions, each with the one that asserted it."""
    given: dict[Belief, tuple[Support, ...]] = {b: (cause,) for b, cause in asserted.items()}
    for belief, link in hierarchy.beliefs():
        given[belief] = (Assertion(link.action, link.cycle),)
    return given


def _hierarchy(given: Mapping[Belief, tuple[Support, ...]]) -> Hierarchy:
    """Give the attachments among the beliefs that rest on actions."""
    links: dict[Value, Link] = {}
    for belief, (cause, *_) in given.items():
        if belief.predicate == ATTACHED and isinstance(cause, Assertion):
            child, parent = belief.args
            links[child] = Link(parent, cause.action, cause.cycle)
    return Hierarchy(links)


def _checked(percepts: Iterable[Percept], lineages: Lineages) -> tuple[Percept, ...]:
    seen = tuple(percepts)
    counts = Counter((fact.predicate, fact.args[0]) for fact in percept_facts(seen, lineages))
    for (kind, name), count in counts.items():
        if count > 1:
            raise FrameError(f"{count} percepts of type {kind} are named {name}; names are unique")
    for percept in seen:
        check_values(percept)
    return seen
