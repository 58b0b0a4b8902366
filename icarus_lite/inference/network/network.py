"""A network: the beliefs of one domain, kept up to date from cycle to cycle."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from icarus_lite.errors import FrameError, InferenceError
from icarus_lite.inference.facts import Bindings, match, resolve
from icarus_lite.inference.network.attributed import ASSERTED, PERCEIVED
from icarus_lite.inference.network.base import Base, Entry
from icarus_lite.inference.network.changes import Budget, Changes, Delta
from icarus_lite.inference.network.events import difference, events_of_given
from icarus_lite.inference.network.history import Event, History, Kind, belief_of, key_of
from icarus_lite.inference.network.parts import Move
from icarus_lite.inference.network.proofs import Prover
from icarus_lite.inference.network.running import Running
from icarus_lite.inference.network.watch import BudgetError, Watch
from icarus_lite.inference.supports import Derivation
from icarus_lite.language.syntax import Atom
from icarus_lite.symbols import Belief, Percept, Value

if TYPE_CHECKING:
    from icarus_lite.inference.network.compiled import CompiledDomain


class Network:
    """The beliefs that follow from percepts and assertions, cycle after cycle.

    It is told what has changed and follows; what it costs depends on the change, not on how much
    is believed. An update that fails leaves everything as it was.

    Args:
        compiled: The compiled domain.
        budget: What one cycle may cost.
    """

    __slots__ = (
        "_base", "_form", "_history",
        "_prover", "_running", "_watch", "budget", "compiled", "cycle",
    )  # fmt: skip

    def __init__(self, compiled: CompiledDomain, budget: Budget | None = None) -> None:
        self.compiled = compiled
        self.budget = budget or Budget()
        self.cycle = -1
        self._form: frozenset[str] = frozenset()
        places = compiled.form(self._form).places
        self._watch = Watch(self.budget, places)
        self._history = History()
        self._base = Base(compiled.form(self._form).design.vocabulary.lineages)
        self._running = self._new_running()
        self._prover = Prover(self._running)

    # -- telling it what has changed -----------------------------------------------------------

    def update(self, delta: Delta) -> Changes:
        """Follow a change.

        Args:
            delta: What has changed since the last cycle.

        Returns:
            The net changes of the beliefs, derived and asserted.

        Raises:
            FrameError: a percept is not what a percept may be; nothing has changed then.
            InferenceError: a test cannot be evaluated, or the budget is spent; nothing has
                changed then.
        """
        try:
            self._base.take(delta)
        except FrameError:
            self._base.undo()
            raise
        return self._follow()

    def update_snapshot(self, percepts: Iterable[Percept], asserted: Iterable[Belief]) -> Changes:
        """Follow whatever is different from the last cycle, found here.

        Args:
            percepts: Everything perceived now.
            asserted: All beliefs given now.

        Raises:
            FrameError: see `update`.
            InferenceError: see `update`.
        """
        return self.update(self._base.difference(percepts, asserted))

    def move(
        self,
        type_: str,
        names: Sequence[str],
        columns: Mapping[str, Sequence[Value]],
        asserted: Sequence[Belief] = (),
        withdrawn: Sequence[Belief] = (),
    ) -> Changes:
        """Follow objects of one type of which some attributes have changed: the fast way.

        Args:
            type_: The percept type that they were perceived as.
            names: The objects, each once; all of them were perceived before.
            columns: For each attribute that has changed one value an object, in a list or array.
            asserted: Beliefs that are given from now on.
            withdrawn: Beliefs that are no longer given.

        Raises:
            FrameError: an object is not known, or a value is not finite.
            InferenceError: see `update`.
        """
        base = self._base
        try:
            lists = base.move(type_, names, columns)
            if asserted or withdrawn:
                base.give(asserted, withdrawn)
        except FrameError:
            base.undo()
            raise
        types = base.lineage(type_)
        if any(type_ in self._concepts for type_ in types):
            base.touch(type_, names)
            return self._follow()
        return self._follow((Move(types, names, lists),))

    @property
    def _concepts(self) -> Mapping[str, tuple[str, ...]]:
        return self._running.compiled.design.vocabulary.attributes

    def _follow(self, moves: Sequence[Move] = ()) -> Changes:
        base = self._base
        self._watch.start()
        form = self._needed_form() if base.touched else self._form
        if self.cycle < 0 or form != self._form:
            events = self._begin_in(form)
        else:
            events = self._go_on(moves)
        if base.touched:
            events += events_of_given(base, self._running.heads)
        self._history.cycles.append(events)
        base.settle()
        self.cycle += 1
        cycle = self.cycle
        return Changes(cycle, lambda: self._changes(cycle))

    def _go_on(self, moves: Sequence[Move]) -> list[Event]:
        """Let the network follow; begin from scratch where it meets what no cycle shows.

        While rules are told of changes one after the other, a test may be asked about a state
        that is neither that of before nor that of now. If it fails, the new state decides, loaded
        from scratch, whether that is a mistake.
        """
        objects: list[tuple[str, Value, Mapping[str, Value] | None]] = []
        given: list[tuple[Kind, Any, int, Mapping[str, Value] | None]] = []
        if self._base.touched:
            for entry in self._base.touched:
                if self._is_object(entry):
                    objects.append((entry[0], entry[2], self._base.effective(entry)))
                else:
                    given += self._ranks(entry)
        try:
            return self._running.update(objects, given, moves)
        except BudgetError:
            self._restore()
            raise
        except InferenceError:
            self._watch.rest()
            with self._base.undone():
                self._load()
            before = self._concluded()
            self._watch.start()
            self._load_or_restore()
            return difference(before, self._concluded())
        except BaseException:
            self._restore()
            raise

    def _begin_in(self, form: frozenset[str]) -> list[Event]:
        """Load everything into another form of the network, or for the first time."""
        before = None if self.cycle < 0 else self._concluded()
        earlier, self._form = self._form, form
        try:
            self._load_or_restore()
        except BaseException:
            self._form = earlier
            self._restore()
            raise
        return [] if before is None else difference(before, self._concluded())

    def _load_or_restore(self) -> None:
        try:
            self._load()
        except BaseException:
            self._restore()
            raise

    def _restore(self) -> None:
        """Take the change back and load what was there before it."""
        self._base.undo()
        self._watch.rest()
        if self.cycle < 0:
            self._running = self._new_running()
        else:
            self._load()

    def _load(self) -> None:
        """Load a network that believes nothing with what is there."""
        objects: list[tuple[str, Value, Mapping[str, Value]]] = []
        given: list[tuple[Kind, Any, int, Mapping[str, Value]]] = []
        running = self._running = self._new_running()
        for entry in self._base.all():
            if self._is_object(entry):
                attributes = self._base.effective(entry)
                if attributes is not None:
                    objects.append((entry[0], entry[2], attributes))
            else:
                given += [
                    (k, key, rank, a) for k, key, rank, a in self._ranks(entry) if a is not None
                ]
        running.load(objects, given)

    def _new_running(self) -> Running:
        return Running(self.compiled.form(self._form), self._watch)

    def _is_object(self, entry: Entry) -> bool:
        predicate, arity, _ = entry
        return arity == 1 and predicate not in self._concepts

    def _ranks(self, entry: Entry) -> list[tuple[Kind, Any, int, Mapping[str, Value] | None]]:
        kind, key = (entry[0], entry[1]), entry[2]
        return [
            (kind, key, PERCEIVED, self._base.perceived(entry)),
            (kind, key, ASSERTED, self._base.given(entry)),
        ]

    def _needed_form(self) -> frozenset[str]:
        """Give the concepts that are, or have once been, asserted as well."""
        vocabulary = self._running.compiled.design.vocabulary
        given = {
            entry[0]
            for entry in self._base.touched
            if entry[0] in vocabulary.attributes and self._base.given(entry) is not None
        }
        return self._form if given <= vocabulary.given else self._form | given

    def _concluded(self) -> dict[Kind, dict[Any, Mapping[str, Value]]]:
        running = self._running
        return {
            kind: {key: running.attributes_of(kind, key) for key in running.keys(kind)}
            for kind in running.heads
        }

    # -- asking --------------------------------------------------------------------------------

    def holds(self, belief: Belief) -> bool:
        """Tell whether a belief is held now; percepts are not beliefs."""
        kind = belief.predicate, len(belief.args)
        if kind in self._running.heads:
            return self._running.holds(kind, key_of(belief.args))
        kind_known = self._base.asserted.get(kind, {})
        return key_of(belief.args) in kind_known

    def matches(
        self, pattern: Atom, bindings: Bindings | None = None
    ) -> Iterator[dict[str, Value]]:
        """Give the bindings of each percept and belief that matches a pattern.

        Args:
            pattern: A condition, without its `not`.
            bindings: What its variables are bound to already.
        """
        given = bindings or {}
        args = tuple(resolve(term, given) for term in pattern.args)
        candidates: Iterable[Belief]
        if None not in args:
            fact = self._running.fact(pattern.predicate, args)  # type: ignore[arg-type] # checked
            candidates = () if fact is None else (fact,)
        else:
            candidates = self._running.facts((pattern.predicate, len(pattern.args)))
        for fact in candidates:
            extended = match(pattern, fact, given)
            if extended is not None:
                yield extended

    def facts(self, predicate: str) -> Iterator[Belief]:
        """Give the beliefs of a predicate as they are asked for, in no particular order."""
        for kind in self._kinds(predicate):
            if kind in self._running.heads:
                for key in self._running.keys(kind):
                    yield belief_of(kind, key, self._running.attributes_of(kind, key))
            else:
                yield from self._base.asserted.get(kind, {}).values()

    def like(self, predicate: str, arity: int, known: Mapping[int, Value]) -> Iterator[Belief]:
        """Give the beliefs that have these values at these places of their arguments.

        Args:
            predicate: Their predicate; not a percept type.
            arity: How many arguments they have.
            known: Some of these, by place from 0.
        """
        return self._running.like((predicate, arity), known)

    def count(self, predicate: str) -> int:
        """Count the beliefs of a predicate."""
        return sum(
            self._running.count(kind)
            if kind in self._running.heads
            else len(self._base.asserted.get(kind, {}))
            for kind in self._kinds(predicate)
        )

    def beliefs(self) -> tuple[Belief, ...]:
        """Give all beliefs, percepts left out, sorted as they are written."""
        return tuple(sorted(self._held().values(), key=str))

    def supports(self, belief: Belief) -> tuple[Derivation, ...]:
        """Give every derivation of a belief, found now: clauses as written, then by values.

        The first one never rests on the belief itself, so that following first derivations
        always ends at what is given. Empty for what is only asserted, or not believed.
        """
        if self._prover.running is not self._running:
            self._prover = Prover(self._running)
        return self._prover.derivations(belief)

    def intervals(self, belief: Belief) -> list[tuple[int, int | None]]:
        """Give each stretch of cycles in which a belief was held.

        Returns:
            Its first cycle, and the first one after it; None for the one that goes on.
        """
        return self._history.intervals(belief, held=self.holds(belief))

    def held_at(self, cycle: int) -> frozenset[Belief]:
        """Give all that was believed in a cycle.

        Raises:
            ValueError: there was no such cycle.
        """
        if not 0 <= cycle <= self.cycle:
            raise ValueError(f"there is no cycle {cycle}; the last one is {self.cycle}")
        held = self._held()
        self._history.roll_back(held, cycle)
        return frozenset(held.values())

    def percepts(self) -> tuple[Percept, ...]:
        """Give what is perceived now."""
        return tuple(
            Percept(type_, str(name), attributes)
            for type_, known in self._base.percepts.items()
            for name, attributes in known.items()
        )

    def asserted(self) -> tuple[Belief, ...]:
        """Give the beliefs that are given now, in the order in which they were asserted."""
        return tuple(self._base.assertions())

    def copy(self) -> Network:
        """Give a network in the same state that goes its own way, to try out a change."""
        other = Network(self.compiled, self.budget)
        other.cycle, other._form = self.cycle, self._form
        other._history, other._base = self._history.copy(), self._base.copy()
        if self.cycle >= 0:
            other._load()
        return other

    def _kinds(self, predicate: str) -> list[Kind]:
        kinds = dict.fromkeys(kind for kind in self._running.heads if kind[0] == predicate)
        kinds.update(dict.fromkeys(k for k in self._base.asserted if k[0] == predicate))
        return list(kinds)

    def _held(self) -> dict[Belief, Belief]:
        running = self._running
        held = {}
        for kind in running.heads:
            for key in running.keys(kind):
                belief = belief_of(kind, key, running.attributes_of(kind, key))
                held[belief] = belief
        for belief in self._base.assertions():
            held.setdefault(belief, belief)
        return held

    def _changes(self, cycle: int) -> tuple[Sequence[Belief], Sequence[Belief], Sequence[Belief]]:
        if cycle == 0:
            return tuple(self.held_at(0)), (), ()
        return self._history.changes(cycle)
