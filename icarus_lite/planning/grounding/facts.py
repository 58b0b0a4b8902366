"""The facts that grounding reaches: those that may come to hold, numbered, and those that stay."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from icarus_lite.planning.grounding.views import Attributes, Cells, Index, View
from icarus_lite.symbols import Belief

GIVEN = "given "
"""Before the predicate of a concept: the belief as an effect asserted it. No name has a space."""

HELD = "held "
"""Before `attached` where concepts define that as well: the pair as the hierarchy has it."""

_Inserter = Callable[[int, Cells, Attributes], None]


class Numbers(dict[object, int]):
    """The numbers of a predicate's facts by their arguments, or by arguments and attributes.

    Arguments that are looked up with `[...]` for the first time are noted: they get the next
    number, and wait to be taken in.
    """

    __slots__ = ("_atoms", "_predicate", "_waiting")

    def __init__(
        self, predicate: str, atoms: list[tuple[str, Cells, Attributes]], waiting: list[int]
    ) -> None:
        super().__init__()
        self._predicate, self._atoms, self._waiting = predicate, atoms, waiting

    def __missing__(self, args: Cells) -> int:
        """Note a fact without attributes."""
        number = self[args] = len(self._atoms)
        self._atoms.append((self._predicate, args, ()))
        self._waiting.append(number)
        return number


class FactBase:
    """Facts, each with a number if its truth may change, in the indexes that joins look into.

    A fact that may change is *noted* when something is found to bring it about, and *taken in*,
    so that joins see it, together with all others of its predicate noted so far.
    """

    __slots__ = ("_feeds", "_indexes", "_waiting", "atoms", "numbers")

    def __init__(self) -> None:
        self.atoms: list[tuple[str, Cells, Attributes]] = []
        self.numbers: dict[str, Numbers] = {}
        self._waiting: dict[str, list[int]] = {}
        self._indexes: dict[View, Index] = {}
        self._feeds: dict[str, list[_Inserter]] = {}

    def index(self, view: View) -> Index:
        """Give the index of a view on numbered facts; facts taken in later go into it as well."""
        index = self._indexes.get(view)
        if index is None:
            index = self._indexes[view] = {}
            insert = view.inserter(index, numbered=True)
            for number, (predicate, args, attributes) in enumerate(self.atoms):
                if predicate == view.predicate and number not in self._waiting.get(predicate, ()):
                    insert(number, args, attributes)
            self._feeds.setdefault(view.predicate, []).append(insert)
        return index

    def numbers_of(self, predicate: str) -> Numbers:
        """Give the numbers of a predicate's facts."""
        numbers = self.numbers.get(predicate)
        if numbers is None:
            waiting = self._waiting.setdefault(predicate, [])
            numbers = self.numbers[predicate] = Numbers(predicate, self.atoms, waiting)
        return numbers

    def note(self, predicate: str, args: Cells, attributes: Attributes = ()) -> int:
        """Give the number of a fact; a new one waits to be taken in."""
        numbers = self.numbers_of(predicate)
        if not attributes:
            return numbers[args]
        key = args, attributes
        number = numbers.get(key)
        if number is None:
            number = numbers[key] = len(self.atoms)
            self.atoms.append((predicate, args, attributes))
            self._waiting[predicate].append(number)
        return number

    def noter(self, predicate: str) -> Callable[[Cells, Attributes], int]:
        """Give what notes facts of a predicate with attributes."""
        return lambda args, attributes: self.note(predicate, args, attributes)

    def take_in(self) -> tuple[str, list[int]] | None:
        """Let joins see what waits of one predicate; give it, or None if nothing waits."""
        for predicate, waiting in self._waiting.items():
            if waiting:
                taken = list(waiting)
                waiting.clear()
                for insert in self._feeds.get(predicate, ()):
                    for number in taken:
                        _, args, attributes = self.atoms[number]
                        insert(number, args, attributes)
                return predicate, taken
        return None

    def belief(self, number: int) -> Belief:
        """Give a numbered fact as a belief."""
        predicate, args, attributes = self.atoms[number]
        return Belief(plain(predicate), args, dict(attributes))


def static_index(view: View, facts: Iterable[tuple[Cells, Attributes]]) -> Index:
    """Give an index of facts that do not change."""
    index: Index = {}
    insert = view.inserter(index, numbered=False)
    for args, attributes in facts:
        insert(0, args, attributes)
    return index


def plain(predicate: str) -> str:
    """Give the predicate that people know."""
    return predicate.removeprefix(GIVEN).removeprefix(HELD)
