"""How a pattern looks at the facts of a predicate, and the hash index behind it.

The cells of a fact are its arguments, then the attributes that the pattern names. When a pattern
is reached in a join, some cells are known: they are the key of the index. The others are what a
fact found there binds.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from operator import itemgetter

from icarus_lite.language.syntax import Atom, Constant, Term
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any, TypeAlias

Cells = tuple[Value, ...]
"""The arguments of a fact, or some of its cells."""

Attributes = tuple[tuple[str, Value], ...]
"""The attributes of a fact, sorted by name."""

Index: TypeAlias = "dict[Any, list[Any]]"
"""What is found under a key. Of a fact with a number: the number, or a tuple that begins with it
and goes on with what the fact binds. Of a static fact: what it binds, bare where that is one."""


@dataclass(frozen=True, slots=True)
class View:
    """One way to look at the facts of a predicate; patterns that look alike share one.

    Args:
        predicate: Whose facts.
        arity: How many arguments they must have.
        attributes: The attributes that they must have.
        key: The cells they are looked up by.
        values: The cells that bind variables.
        equal: Pairs of cells that must agree: a variable repeated inside one pattern.
        serial: Tells apart views that must not share an index.
    """

    predicate: str
    arity: int
    attributes: tuple[str, ...]
    key: tuple[int, ...]
    values: tuple[int, ...]
    equal: tuple[tuple[int, int], ...] = ()
    serial: int = 0

    def inserter(self, index: Index, *, numbered: bool) -> Callable[[int, Cells, Attributes], None]:
        """Give a function that puts a fact into an index, unless this view does not see it."""
        key = _picker(self.key)
        entry = _numbered(self.values) if numbered else _bare(self.values)

        def insert(number: int, args: Cells, attributes: Attributes) -> None:
            if len(args) != self.arity:
                return
            cells = args
            if self.attributes:
                known = dict(attributes)
                if not all(name in known for name in self.attributes):
                    return
                cells = args + tuple([known[name] for name in self.attributes])
            for one, other in self.equal:
                if cells[one] != cells[other]:
                    return
            found = key(cells)
            entries = index.get(found)
            if entries is None:
                index[found] = [entry(number, cells)]
            else:
                entries.append(entry(number, cells))

        return insert


def terms_of(atom: Atom) -> tuple[Term, ...]:
    """Give the cells of a pattern: its arguments, then its attributes in the order of names."""
    return (*atom.args, *(term for _, term in sorted(atom.attributes, key=itemgetter(0))))


def names_of(atom: Atom) -> tuple[str, ...]:
    """Give the attributes that a pattern names, sorted."""
    return tuple(sorted(name for name, _ in atom.attributes))


def view_of(
    atom: Atom, bound: Collection[str], *, binding: bool = True, serial: int = 0
) -> tuple[View, tuple[Term, ...], tuple[str, ...]]:
    """Give how a pattern looks for its facts once some variables are bound.

    Args:
        atom: The pattern.
        bound: Names of the variables that are bound.
        binding: Whether the values of the other variables are wanted.
        serial: Tells apart views that must not share an index.

    Returns:
        The view, the terms that make its key, and the variables that it binds.
    """
    key, key_terms, values, fresh = [], [], [], dict[str, int]()
    equal: list[tuple[int, int]] = []
    for cell, term in enumerate(terms_of(atom)):
        if isinstance(term, Constant) or term.name in bound:
            key.append(cell)
            key_terms.append(term)
        elif term.name in fresh:
            equal.append((fresh[term.name], cell))
        else:
            fresh[term.name] = cell
            values.append(cell)
    view = View(
        atom.predicate,
        len(atom.args),
        names_of(atom),
        tuple(key),
        tuple(values) if binding else (),
        tuple(equal),
        serial,
    )
    return view, tuple(key_terms), tuple(fresh) if binding else ()


def sorted_attributes(attributes: Mapping[str, Value]) -> Attributes:
    """Give the attributes of a fact, sorted by name."""
    return tuple(sorted(attributes.items(), key=itemgetter(0))) if attributes else ()


def _picker(places: tuple[int, ...]) -> Callable[[Cells], Any]:
    """Give a function that picks cells: as a tuple, but one cell bare."""
    if not places:
        return lambda _: ()
    return itemgetter(*places)


def _numbered(values: tuple[int, ...]) -> Callable[[int, Cells], Any]:
    if not values:
        return lambda number, _: number
    if len(values) == 1:
        (only,) = values
        return lambda number, cells: (number, cells[only])
    pick = itemgetter(*values)
    return lambda number, cells: (number, *pick(cells))


def _bare(values: tuple[int, ...]) -> Callable[[int, Cells], Any]:
    pick = _picker(values)
    return lambda _, cells: pick(cells)
