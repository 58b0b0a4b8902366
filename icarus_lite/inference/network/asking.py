"""What a network is asked: what it believes, what it believed before, and why."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from icarus_lite.inference.facts import Bindings, match, resolve
from icarus_lite.inference.network.base import Base
from icarus_lite.inference.network.history import History, Kind, belief_of, key_of
from icarus_lite.inference.network.proofs import Prover
from icarus_lite.inference.network.running import Running
from icarus_lite.inference.supports import Derivation, Support
from icarus_lite.language.syntax import Atom
from icarus_lite.symbols import Belief, Percept, Value


class Asking:
    """The questions to a network. Those about the past reach as far back as its log.

    Args:
        base: Percepts and assertions.
        running: What follows from them.
        history: The log of changes.
    """

    __slots__ = ("_base", "_history", "_prover", "_running")

    def __init__(self, base: Base, running: Running, history: History) -> None:
        self._base, self._running, self._history = base, running, history
        self._prover = Prover(running)

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
        return self._proving().derivations(belief)

    def support(self, belief: Belief) -> Derivation | None:
        """Give the first derivation of a belief alone, found without looking for all."""
        return self._proving().first(belief)

    def reasons(
        self, given: Mapping[Belief, Sequence[Support]]
    ) -> Callable[[Belief], Support | Percept | None]:
        """Give what gives the first reason for a fact: while the network stands in this cycle.

        Args:
            given: What gave each of the beliefs that are asserted now.
        """
        asserted, percepts, first = self._base.asserted, self._base.percept, self._proving().first

        def reason(fact: Belief) -> Support | Percept | None:
            args = fact.args
            count = len(args)
            known = asserted.get((fact.predicate, count))
            if known and (args[0] if count == 1 else args) in known:
                return given[fact][0]
            found = first(fact)
            return percepts(fact.predicate, args[0]) if found is None and count == 1 else found

        return reason

    def _proving(self) -> Prover:
        if self._prover.running is not self._running:
            self._prover = Prover(self._running)
        return self._prover

    @property
    def first_cycle(self) -> int:
        """The first cycle on record: how far `held_at`, `recall` and `intervals` look back."""
        return self._history.first

    def intervals(self, belief: Belief) -> list[tuple[int, int | None]]:
        """Give each stretch of cycles on record in which a belief was held.

        Returns:
            Its first cycle, and the first one after it; None for the one that goes on.
        """
        return self._history.intervals(belief, held=self.holds(belief))

    def held_at(self, cycle: int) -> frozenset[Belief]:
        """Give all that was believed in a cycle.

        Raises:
            ForgottenError: there was no such cycle, or it is no longer on record.
        """
        self._history.check(cycle)
        held = self._held()
        self._history.roll_back(held, cycle)
        return frozenset(held.values())

    def percept(self, type_: str, name: Value) -> Percept | None:
        """Give what is perceived now of an object, by one of the types that it belongs to."""
        return self._base.percept(type_, name)

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
