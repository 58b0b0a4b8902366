"""A network: the beliefs of one domain, kept up to date from cycle to cycle."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from icarus_lite.errors import FrameError, InferenceError
from icarus_lite.inference.network.asking import Asking
from icarus_lite.inference.network.attributed import ASSERTED, PERCEIVED
from icarus_lite.inference.network.base import Base, Entry
from icarus_lite.inference.network.changes import Budget, Changes, Delta
from icarus_lite.inference.network.events import difference, events_of_given, together
from icarus_lite.inference.network.history import Event, History, Kind
from icarus_lite.inference.network.parts import Move
from icarus_lite.inference.network.running import Running
from icarus_lite.inference.network.watch import BudgetError, Watch
from icarus_lite.symbols import Belief, Percept, Value

if TYPE_CHECKING:
    from icarus_lite.inference.network.compiled import CompiledDomain

Review: TypeAlias = Callable[[], Iterable[Belief]]
"""Looks at what would be believed in a cycle; gives those given beliefs that are to go."""


class Network(Asking):
    """The beliefs that follow from percepts and assertions, cycle after cycle.

    It is told what has changed and follows; what it costs depends on the change, not on how much
    is believed. An update that fails leaves everything as it was. What it is asked: see `Asking`.

    Args:
        compiled: The compiled domain.
        budget: What one cycle may cost, and how many changes of past cycles to keep.
    """

    __slots__ = ("_form", "_lineages", "_watch", "budget", "compiled", "cycle")

    def __init__(self, compiled: CompiledDomain, budget: Budget | None = None) -> None:
        self.compiled = compiled
        self.budget = budget or Budget()
        self.cycle = -1
        self._form: frozenset[str] = frozenset()
        self._lineages: dict[str, tuple[Sequence[str], bool]] = {}
        places = compiled.form(self._form).places
        self._watch = Watch(self.budget, places)
        base = Base(compiled.form(self._form).design.vocabulary.lineages)
        super().__init__(base, self._new_running(), History(self.budget.changes_kept))

    # -- telling it what has changed -----------------------------------------------------------

    def update(self, delta: Delta, review: Review | None = None) -> Changes:
        """Follow a change.

        Args:
            delta: What has changed since the last cycle.
            review: See `update_snapshot`.

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
        return self._follow(review=review)

    def update_snapshot(
        self,
        percepts: Iterable[Percept],
        asserted: Iterable[Belief],
        review: Review | None = None,
    ) -> Changes:
        """Follow whatever is different from the last cycle, found here.

        Args:
            percepts: Everything perceived now.
            asserted: All beliefs given now.
            review: Is called once all has been followed, when the network can be asked what would
                be believed. The given beliefs that it names are withdrawn within the same cycle.

        Raises:
            FrameError: see `update`.
            InferenceError: see `update`. What the review raises is raised; nothing has changed
                then.
        """
        return self.update(self._base.difference(percepts, asserted), review)

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
            values, plain = base.move(type_, names, columns)
            if asserted or withdrawn:
                base.give(asserted, withdrawn)
        except FrameError:
            base.undo()
            raise
        types, is_plain_type = self._lineages.get(type_) or self._lineage(type_)
        if not is_plain_type:
            base.touch(type_, names)
            return self._follow()
        return self._follow((Move(types, names, values, plain),))

    def _lineage(self, type_: str) -> tuple[Sequence[str], bool]:
        """Give all types of a percept, and whether none of them is a concept as well."""
        types = self._base.lineage(type_)
        found = types, not any(each in self._concepts for each in types)
        self._lineages[type_] = found
        return found

    @property
    def _concepts(self) -> Mapping[str, tuple[str, ...]]:
        return self._running.compiled.design.vocabulary.attributes

    def _follow(self, moves: Sequence[Move] = (), review: Review | None = None) -> Changes:
        base = self._base
        self._watch.start()
        form = self._needed_form() if base.touched else self._form
        if self.cycle < 0 or form != self._form:
            events = self._begin_in(form)
        else:
            events = self._go_on(moves)
        is_given = bool(base.touched)
        if review is not None:
            events = self._reviewed(review, events)
        if is_given or base.touched:
            events += events_of_given(base, self._running.heads)
        self._history.add(events, base.settle())
        self.cycle += 1
        return Changes(self.cycle, self._changes)

    def _reviewed(self, review: Review, events: list[Event]) -> list[Event]:
        """Let somebody look at what has been inferred, and take back what does not stand up."""
        try:
            withdrawn = tuple(review())
        except BaseException:
            self._restore()
            raise
        if not withdrawn:
            return events
        self._base.touched.clear()
        self._base.give((), withdrawn)
        found = self._go_on((), events)
        return [] if self.cycle < 0 else found

    def _go_on(self, moves: Sequence[Move], before: Sequence[Event] = ()) -> list[Event]:
        """Let the network follow; begin from scratch where it meets what no cycle shows.

        Args:
            moves: Objects of which only some attributes have changed.
            before: What has become of the beliefs in this cycle already.

        Returns:
            What has become of them in the whole cycle.

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
            found = self._running.update(objects, given, moves)
        except BudgetError:
            self._restore()
            raise
        except InferenceError:
            self._watch.rest()
            with self._base.undone():
                self._load()
            earlier = self._concluded()
            self._watch.start()
            self._load_or_restore()
            return difference(earlier, self._concluded())
        except BaseException:
            self._restore()
            raise
        return together(before, found) if before else found

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

    # -- other networks ------------------------------------------------------------------------

    def recall(self, cycle: int) -> Network:
        """Give a network that stands in an earlier cycle, to be asked as one would have then.

        Raises:
            ForgottenError: there was no such cycle, or it is no longer on record.
        """
        base = self._base.before(self._history.writes_after(cycle))
        return self._twin(cycle, base, self._history.until(cycle))

    def copy(self) -> Network:
        """Give a network in the same state that goes its own way, to try out a change."""
        return self._twin(self.cycle, self._base.copy(), self._history.until(self.cycle))

    def _twin(self, cycle: int, base: Base, history: History) -> Network:
        other = Network(self.compiled, self.budget)
        other.cycle, other._form = cycle, self._form
        other._history, other._base = history, base
        if cycle >= 0:
            other._watch.rest()
            other._load()
        return other
