"""The inference engine: percepts and the last actions in, beliefs with their supports out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from icarus_lite.errors import FrameError
from icarus_lite.inference.attachment import Hierarchy, advance
from icarus_lite.inference.belief_supports import BeliefSupports, LazyFacts
from icarus_lite.inference.causes import Causes
from icarus_lite.inference.closure import Closure
from icarus_lite.inference.contradictions import Doubt, Judgement, Withdrawal, judge
from icarus_lite.inference.effects import Change, change_by_action
from icarus_lite.inference.evaluator import Evaluator, Functions
from icarus_lite.inference.facts import (
    FactStore,
    Lineages,
    check_arguments,
    check_values,
    percept_facts,
)
from icarus_lite.inference.lasting import Given, Lasting, hierarchy_of
from icarus_lite.inference.present import PresentFacts
from icarus_lite.inference.supports import Assertion, Support
from icarus_lite.language.checking.stratification import strata
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Domain
from icarus_lite.outcomes import Outcome, Status
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import ATTACHED, Belief, Percept

if TYPE_CHECKING:
    from icarus_lite.inference.network import Budget, Changes, Network


@dataclass(frozen=True, slots=True)
class BeliefState:
    """What is believed in one cycle.

    Args:
        cycle: Its number, from 0.
        percepts: The percepts, as they came.
        supports: Each belief (percepts left out) with all its supports, never empty.
        hierarchy: The attachment hierarchy behind the `attached` beliefs.
        notes: What the person should know, such as an attachment refused as circular, or a belief
            withdrawn.
        lineages: Each percept type with all types that its percepts belong to, its own first.
        withdrawn: What persisted up to now and was withdrawn, for what contradicts it.
        doubts: What persists although something contradicts it, for that has not held for long.
    """

    cycle: int = -1
    percepts: tuple[Percept, ...] = ()
    supports: Mapping[Belief, tuple[Support, ...]] = field(default_factory=dict)
    hierarchy: Hierarchy = field(default_factory=Hierarchy)
    notes: tuple[str, ...] = ()
    lineages: Lineages = field(default_factory=dict)
    withdrawn: tuple[Withdrawal, ...] = ()
    doubts: tuple[Doubt, ...] = ()

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

    An effect of an action that succeeded is asserted and persists until an effect removes it, a
    contradiction of the domain withdraws it, or an object in it is no longer perceived; asserted
    anew it has the attributes it comes with now. Unless concepts define its predicate: then
    perception decides, each cycle, whether it holds.
    `attached` follows Algorithm 1. An action that failed or still runs asserts nothing.

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
        "_budget", "_causes", "_doubtful", "_network", "_order", "_past", "closure", "domain",
        "evaluator", "lineages",
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
        self._doubtful = frozenset(each.head.predicate for each in domain.contradictions)

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
        lasting, notes = self._after(memory, cycle, outcomes, changes or {})
        lasting = lasting.without_objects(known - present)
        net, judgement = self._follow(cycle, seen, lasting.given, memory.state.doubts)
        lasting = lasting.without(each.belief for each in judgement.withdrawn)
        notes += tuple(map(str, judgement.withdrawn))
        state = self._state(cycle, seen, lasting, notes, judgement, net)
        return Memory(state, lasting.asserted, known)

    def recall(
        self,
        cycle: int,
        percepts: Iterable[Percept],
        asserted: Mapping[Belief, Assertion],
        hierarchy: Hierarchy,
        known: Iterable[str] = (),
        notes: tuple[str, ...] = (),
        judgement: Judgement | None = None,
    ) -> Memory:
        """Give the memory of a cycle from what was recorded of it, and derive its beliefs anew.

        Args:
            cycle: Its number.
            percepts: What was perceived in it.
            asserted: The effects that persisted then, `attached` left out.
            hierarchy: The attachments of then.
            known: The names of all objects perceived up to then; those of now are added.
            notes: What the person should know.
            judgement: What was in doubt and was withdrawn in it; None for nothing. It is not
                judged again.

        Raises:
            FrameError: as for `step`.
            InferenceError: as for `step`.
        """
        seen = _checked(percepts, self.lineages)
        lasting = Lasting(asserted, hierarchy)
        net, _ = self._follow(cycle, seen, lasting.given)
        state = self._state(cycle, seen, lasting, notes, judgement or Judgement(), net)
        return Memory(state, asserted, frozenset(known) | {percept.name for percept in seen})

    def step_once(self, memory: Memory, percepts: Iterable[Percept]) -> Memory:
        """Infer the beliefs of a cycle that probably no other will follow, as `step` would.

        There will be no network to keep up to date, which takes longer to compile than to ask
        once. But what tests compare the numbers of many objects, a network finds faster.

        Raises:
            FrameError: as for `step`.
            InferenceError: as for `step`.
        """
        lasting = Lasting(memory.asserted, memory.state.hierarchy)
        given = lasting.given
        if self._network is not None or any(each.predicate in self._doubtful for each in given):
            return self.step(memory, percepts)
        seen = _checked(percepts, self.lineages)
        present = frozenset(percept.name for percept in seen)
        if memory.known - present:
            return self.step(memory, seen)
        facts = FactStore(percept_facts(seen, self.lineages))
        for belief in given:
            facts.add(belief)
        supports = dict(given)
        for belief, derivations in self.closure.derive(facts).items():
            supports[belief] = (*given.get(belief, ()), *derivations)
        cycle, hierarchy = memory.state.cycle + 1, memory.state.hierarchy
        state = BeliefState(cycle, seen, supports, hierarchy, (), self.lineages)
        return Memory(state, memory.asserted, memory.known | present)

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
            hierarchy = hierarchy_of(given)
            self._past = BeliefState(cycle, percepts, supports, hierarchy, (), self.lineages)
        return self._past

    def _after(
        self,
        memory: Memory,
        cycle: int,
        outcomes: Sequence[Outcome],
        changes: Mapping[int, Change],
    ) -> tuple[Lasting, tuple[str, ...]]:
        """Give what persists after some outcomes, and what a person should know of it."""
        asserted, hierarchy = dict(memory.asserted), memory.state.hierarchy
        notes: list[str] = []
        before: FactStore | None = memory.state.facts() if outcomes else None
        for number, outcome in enumerate(outcomes):
            check_arguments(outcome.action)
            if outcome.status is not Status.SUCCEEDED:
                continue
            change = changes.get(number)
            if change is None:
                if before is None:  # what the outcomes so far have left, as far as was perceived
                    percepts_then = memory.state.percepts
                    before = self._imagine(percepts_then, Lasting(asserted, hierarchy))
                change = change_by_action(
                    self.domain.skills, outcome.action, before, self.evaluator
                )
            asserted = self._assert(asserted, change, Assertion(outcome.action, cycle))
            hierarchy, refused = hierarchy.with_change(change, outcome.action, cycle)
            notes.extend(refused)
            hierarchy, refused = advance(hierarchy, self.domain.attachments, outcome.action, cycle)
            notes.extend(refused)
            before = None
        return Lasting(asserted, hierarchy), tuple(notes)

    def _assert(
        self, asserted: Mapping[Belief, Assertion], change: Change, cause: Assertion
    ) -> dict[Belief, Assertion]:
        new = dict[Belief, Belief]()
        for each in change.added:
            if each.predicate != ATTACHED and each.predicate not in self.closure.concepts:
                new.setdefault(each, each)
        # What is asserted anew equals the old, but may come with other attributes.
        kept = {new.get(b, b): a for b, a in asserted.items() if not change.removes(b)}
        return kept | dict.fromkeys(new, cause)

    def _follow(
        self,
        cycle: int,
        percepts: tuple[Percept, ...],
        given: Given,
        doubts: Sequence[Doubt] | None = None,
    ) -> tuple[Changes, Judgement]:
        """Let the network follow to a cycle, and withdraw what does not stand up to it.

        Args:
            cycle: Its number.
            percepts: What is perceived.
            given: What persists up to then.
            doubts: Those of the cycle before; None if nothing is to be judged.
        """
        network, judgement = self._network, Judgement()
        if network is None:
            from icarus_lite.inference.network import compile_domain  # noqa: PLC0415 - if needed

            network = compile_domain(self.domain, self.evaluator.functions).network(self._budget)

        def review() -> Iterator[Belief]:
            nonlocal judgement
            beliefs = BeliefSupports(network, self._order, given, percepts)
            facts = PresentFacts(percepts, self.lineages, beliefs, self.closure.concepts)
            rules, before = self.domain.contradictions, doubts or ()
            judgement = judge(rules, given, facts, cycle, before, self.evaluator)
            return (each.belief for each in judgement.withdrawn)

        speak = doubts is not None and any(each.predicate in self._doubtful for each in given)
        changes = network.update_snapshot(percepts, given, review if speak else None)
        self._network, self._past = network, None
        return changes, judgement

    def _state(
        self,
        cycle: int,
        percepts: tuple[Percept, ...],
        lasting: Lasting,
        notes: tuple[str, ...],
        judgement: Judgement,
        changes: Changes,
    ) -> BeliefState:
        """Give the beliefs of the cycle in which the network stands."""
        network, given = self._network, lasting.given
        assert network is not None
        self._causes.note(cycle, network.cycle, given, network.first_cycle)
        return BeliefState(
            cycle,
            percepts,
            BeliefSupports(network, self._order, given, percepts, changes),
            lasting.hierarchy,
            notes,
            self.lineages,
            judgement.withdrawn,
            judgement.doubts,
        )

    def _imagine(self, percepts: tuple[Percept, ...], lasting: Lasting) -> FactStore:
        """Give all that would be believed, without saying that it is."""
        facts = FactStore(percept_facts(percepts, self.lineages))
        for belief in lasting.given:
            facts.add(belief)
        self.closure.derive(facts)
        return facts


def _checked(percepts: Iterable[Percept], lineages: Lineages) -> tuple[Percept, ...]:
    seen = tuple(percepts)
    counts = Counter((fact.predicate, fact.args[0]) for fact in percept_facts(seen, lineages))
    for (kind, name), count in counts.items():
        if count > 1:
            raise FrameError(f"{count} percepts of type {kind} are named {name}; names are unique")
    for percept in seen:
        check_values(percept)
    return seen
