"""Relations: what the conditions of compiled clauses look their rows up in.

A row is made of *key* cells and of *value* cells that the key determines: the name of an object
and the attributes a pattern asks for, or the arguments of a belief. Each relation is kept in a
dictionary from key to values, but for the pairs that a numeric kernel keeps.
"""

from __future__ import annotations

from typing import TypeAlias

from icarus_lite.inference.network import kernels
from icarus_lite.language.syntax import Call
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Value


@dataclass(frozen=True, slots=True)
class View:
    """The objects of a percept type as some pattern sees them: key the name, values attributes.

    Args:
        type: The percept type.
        cells: The attributes that are the values of a row.
        required: Further attributes that an object must have.
        constants: Attributes with the value that they must have.
        tests: Tests over the object's own attributes that it must meet, in the order asked.
        variables: For each variable of the tests its attribute; the empty text is the name.
        name: Its identifier in the generated source.
    """

    type: str
    cells: tuple[str, ...]
    required: tuple[str, ...] = ()
    constants: tuple[tuple[str, Value], ...] = ()
    tests: tuple[Call, ...] = ()
    variables: tuple[tuple[str, str], ...] = ()
    name: str = field(default="", compare=False)

    @property
    def keys(self) -> int:
        """How many cells the key has."""
        return 1

    @property
    def values(self) -> int:
        """How many value cells there are."""
        return len(self.cells)

    @property
    def attributes(self) -> tuple[str, ...]:
        """Every attribute that it depends on, each once."""
        tested = tuple(attribute for _, attribute in self.variables if attribute)
        constants = tuple(attribute for attribute, _ in self.constants)
        return tuple(dict.fromkeys((*self.cells, *self.required, *constants, *tested)))


@dataclass(frozen=True, slots=True)
class Pairs:
    """The pairs of objects that meet numeric tests, kept by a kernel; key both names.

    Args:
        left: The pattern that the left objects meet; its `cells` are what the tests read.
        right: Likewise on the right.
        tests: The tests, in the order asked; with `(/= left right)` left to `distinct`.
        distinct: Whether an object is no pair with itself.
        kernel: The compiled tests.
        name: Its identifier in the generated source.
    """

    left: View
    right: View
    tests: tuple[Call, ...]
    distinct: bool
    kernel: kernels.PairKernel = field(compare=False)
    name: str = field(default="", compare=False)

    @property
    def keys(self) -> int:
        """How many cells the key has."""
        return 2

    @property
    def values(self) -> int:
        """How many value cells there are."""
        return 0


@dataclass(frozen=True, slots=True)
class Facts:
    """The beliefs of a predicate with a number of arguments; key the arguments.

    Args:
        predicate: The predicate.
        arity: The number of arguments.
        cells: The attributes that are the values of a row; a belief without one is no row.
        name: Its identifier in the generated source.
    """

    predicate: str
    arity: int
    cells: tuple[str, ...] = ()
    name: str = field(default="", compare=False)

    @property
    def keys(self) -> int:
        """How many cells the key has."""
        return self.arity

    @property
    def values(self) -> int:
        """How many value cells there are."""
        return len(self.cells)


Relation: TypeAlias = View | Pairs | Facts
