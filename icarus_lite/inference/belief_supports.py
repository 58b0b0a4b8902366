"""The beliefs of one cycle with their supports, read from the network when somebody asks.

As long as the network stands in that cycle, it answers. Once it has gone on, another one is told
what was perceived and given then, and answers in its place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from icarus_lite.inference.canonical import canonical
from icarus_lite.inference.facts import FactStore, Lineages, percept_facts
from icarus_lite.inference.supports import Support
from icarus_lite.inference.views import Entry, Key
from icarus_lite.symbols import Belief, Percept, Value

if TYPE_CHECKING:
    from icarus_lite.inference.network import Changes, Network


class BeliefSupports(Mapping[Belief, tuple[Support, ...]]):
    """Each belief of a cycle with all its supports: what gave it first, then its derivations.

    Beliefs come in an order that does not depend on history: those that are given, as they were
    given, then concept by concept, bottom first, each sorted by its arguments.

    Args:
        network: Stands in the cycle in question now.
        order: The concepts, bottom first.
        given: The beliefs that are asserted, with what asserted them.
        percepts: What is perceived in the cycle.
        changes: What the cycle has changed; None if that is not known.
    """

    __slots__ = (
        "_changes", "_concepts", "_cycle", "_given", "_network", "_order", "_percepts", "_sorted",
        "_then",
    )  # fmt: skip

    def __init__(
        self,
        network: Network,
        order: Sequence[str],
        given: Mapping[Belief, tuple[Support, ...]],
        percepts: tuple[Percept, ...],
        changes: Changes | None = None,
    ) -> None:
        self._changes = changes
        self._network, self._order = network, order
        self._concepts = frozenset(order)
        self._cycle = network.cycle
        self._given, self._percepts = given, percepts
        self._sorted: tuple[Belief, ...] | None = None
        self._then: Network | None = None

    @property
    def given(self) -> Mapping[Belief, tuple[Support, ...]]:
        """The beliefs that rest on actions, each with what asserted it."""
        return self._given

    @property
    def is_current(self) -> bool:
        """Whether the network still stands in this cycle."""
        return self._network.cycle == self._cycle

    def changes_since(self, before: BeliefSupports) -> Changes | None:
        """Give the changes since another cycle, if that was the network's last one."""
        follows = before._network is self._network and before._cycle + 1 == self._cycle
        return self._changes if follows else None

    def __contains__(self, belief: object) -> bool:
        if belief in self._given:
            return True
        if not isinstance(belief, Belief):
            return False
        if self.is_current or self._cycle < self._network.first_cycle:
            return self._standing().holds(belief)
        return any(
            start <= self._cycle and (end is None or self._cycle < end)
            for start, end in self._network.intervals(belief)
        )

    def __getitem__(self, belief: Belief) -> tuple[Support, ...]:
        found = self._given.get(belief, ()) + self._standing().supports(belief)
        if not found:
            raise KeyError(belief)
        return found

    def reasons(self) -> Callable[[Belief], Support | Percept | None]:
        """Give what gives the first support of a belief, or the percept that a fact stands for.

        It looks for no other supports. It is good as long as nothing is inferred.
        """
        return self._standing().reasons(self._given)

    def percept(self, fact: Belief) -> Percept | None:
        """Give the percept that a fact stands for: of that type, or of one that is a kind of it."""
        if len(fact.args) != 1:
            return None
        return self._standing().percept(fact.predicate, fact.args[0])

    def __iter__(self) -> Iterator[Belief]:
        return iter(self._in_order())

    def __repr__(self) -> str:
        return repr(dict(self))

    def __len__(self) -> int:
        return len(self._in_order())

    def of(self, predicate: str) -> Iterator[Belief]:
        """Give the beliefs of one predicate, in order."""
        if self._sorted is None:
            yield from [belief for belief in self._given if belief.predicate == predicate]
            yield from self._concluded(predicate)
        else:
            yield from (each for each in self._sorted if each.predicate == predicate)

    def count(self, predicate: str) -> int:
        """Count the beliefs of a predicate."""
        if self._sorted is not None:
            return sum(1 for _ in self.of(predicate))
        given = [belief for belief in self._given if belief.predicate == predicate]
        if predicate not in self._concepts:
            return len(given)
        network = self._standing()
        both = sum(network.holds(belief) for belief in given)
        return len(given) + network.count(predicate) - both

    def like(self, predicate: str, arity: int, known: Mapping[int, Value]) -> list[Belief]:
        """Give the beliefs of a predicate that have these values among their arguments, in order.

        Args:
            predicate: The predicate.
            arity: How many arguments they have.
            known: Some of these, by place from 0.
        """

        def fits(belief: Belief) -> bool:
            return len(belief.args) == arity and all(
                belief.args[place] == value for place, value in known.items()
            )

        if predicate not in self._concepts:
            return [belief for belief in self.of(predicate) if fits(belief)]
        given = [each for each in self._given if each.predicate == predicate and fits(each)]
        network = self._standing()
        concluded = [
            each for each in network.like(predicate, arity, known) if each not in self._given
        ]
        return given + sorted(concluded, key=_rank)

    def _standing(self) -> Network:
        """Give the network that stands in this cycle, or one that is told it again."""
        network = self._network
        if network.cycle == self._cycle:
            return network
        if self._then is None:
            self._then = network.compiled.network()
            self._then.update_snapshot(self._percepts, self._given)
        return self._then

    def _in_order(self) -> tuple[Belief, ...]:
        if self._sorted is None:
            found = list(self._given)
            for concept in self._order:
                found += self._concluded(concept)
            self._sorted = tuple(found)
        return self._sorted

    def _concluded(self, concept: str) -> list[Belief]:
        if concept not in self._concepts:
            return []
        held = [each for each in self._standing().facts(concept) if each not in self._given]
        return sorted(held, key=_rank)


class LazyFacts(FactStore):
    """The percepts and beliefs of a cycle, taken in predicate by predicate as they are asked for.

    Args:
        percepts: What is perceived.
        lineages: Each percept type with all types that its percepts belong to.
        beliefs: The beliefs of the same cycle.
    """

    __slots__ = ("_beliefs", "_known", "_perceived")

    def __init__(
        self, percepts: Sequence[Percept], lineages: Lineages, beliefs: BeliefSupports
    ) -> None:
        super().__init__()
        self._beliefs = beliefs
        self._known: set[str] = set()
        self._perceived: dict[str, list[Belief]] = {}
        for fact in percept_facts(percepts, lineages):
            self._perceived.setdefault(fact.predicate, []).append(fact)

    def add(self, fact: Belief) -> bool:
        """Add a fact; tell whether it is new."""
        self._take_in(fact.predicate)
        return super().add(fact)

    def __contains__(self, fact: Belief) -> bool:
        self._take_in(fact.predicate)
        return super().__contains__(fact)

    def __iter__(self) -> Iterator[Belief]:
        beliefs = dict.fromkeys(belief.predicate for belief in self._beliefs)
        for predicate in dict.fromkeys((*self._perceived, *beliefs, *self._facts)):
            for ((_, fact, _),) in self.rows(predicate).values():
                yield fact

    def rows(self, predicate: str) -> Mapping[Key, Sequence[Entry]]:
        """Give the facts of a predicate by all their arguments, as entries that bind nothing."""
        self._take_in(predicate)
        return super().rows(predicate)

    def _take_in(self, predicate: str) -> None:
        if predicate in self._known:
            return
        self._known.add(predicate)
        for fact in self._perceived.get(predicate, ()):
            super().add(fact)
        for belief in self._beliefs.of(predicate):
            super().add(belief)


def _rank(belief: Belief) -> tuple[int, object]:
    return len(belief.args), canonical(belief.args)
