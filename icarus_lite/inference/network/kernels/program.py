"""The generated code of a pair rule, put together so that a person can read it."""

from __future__ import annotations

import linecache
import math
from collections.abc import Callable, Sequence
from hashlib import blake2b
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from icarus_lite.inference.network.kernels.array_source import ArrayWriter, NotVectorizableError
from icarus_lite.inference.network.kernels.python_source import (
    HELPERS,
    PythonWriter,
    identifiers,
)
from icarus_lite.inference.network.kernels.ranges import MOST
from icarus_lite.language.functions import FUNCTIONS
from icarus_lite.language.syntax import Call, Expression, Variable
from icarus_lite.records import dataclass

RowsFunction: TypeAlias = Callable[
    [Sequence[int], Sequence[int], Sequence[list[Any]], Sequence[list[Any]], bytearray, int],
    list[tuple[int, bytes]],
]
"""Tests objects against all of the other side, given what is stored; gives the rows that differ.

Each object comes with the slot that it has itself on the other side, or -1: no pair is found there.
"""

AmongFunction: TypeAlias = Callable[
    [int, Sequence[list[Any]], Sequence[list[Any]], Sequence[int]], list[int]
]
"""Tests one object against some of the other side; gives those with which it holds."""

RowFunction: TypeAlias = Callable[[int, Sequence[list[Any]], Sequence[list[Any]]], bytes]
"""Tests one object against all of the other side: its slot, its inputs, theirs -> one byte each."""

MaskFunction: TypeAlias = Callable[..., tuple[NDArray[np.bool_], NDArray[np.bool_] | None]]
"""Tests pairs given by the inputs of both sides, which broadcast: what holds, what is in doubt."""

DeriveFunction: TypeAlias = Callable[
    [Sequence[int], Sequence[list[Any]], Sequence[list[Any]]], None
]
"""Computes the derived inputs of some objects: their slots, the attributes, the lists to fill."""

DeriveArrays: TypeAlias = Callable[..., tuple[tuple[NDArray[np.float64], ...], Any]]
"""Computes the derived inputs of all objects from arrays: the arrays, and which are in doubt."""


_SIDES = ("left", "right")
_OTHER = {"left": "right", "right": "left"}


class UnusualError(ArithmeticError):
    """A result that only `evaluate` knows how to treat."""


def checked(number: float) -> float:
    """Give back a number that is finite.

    Raises:
        UnusualError: it is not.
    """
    if -MOST <= number <= MOST:
        return number
    raise UnusualError


@dataclass(frozen=True, slots=True)
class Inputs:
    """What the kernels of a rule take of one side.

    Args:
        terms: The largest parts of the tests that are about this side alone: attributes first,
            then what is derived from them.
        variables: The variables the derived ones need, those of the attributes included.
    """

    terms: tuple[Expression, ...]
    variables: tuple[str, ...]

    @property
    def plain(self) -> tuple[Variable, ...]:
        """The terms that are attributes as they are."""
        return tuple(term for term in self.terms if isinstance(term, Variable))

    @property
    def derived(self) -> tuple[Call, ...]:
        """The terms that are computed once an object instead of once a pair."""
        return tuple(term for term in self.terms if isinstance(term, Call))


@dataclass(frozen=True, slots=True)
class SidePrograms:
    """The generated functions about one side.

    Args:
        rows: Tests some of its objects against all of the other side.
        row: Tests one of them.
        among: Tests one of them against some.
        derive: Computes its derived inputs object by object; None if there are none.
        derive_arrays: The same for all objects at once; None where Python has to do it.
    """

    rows: RowsFunction
    row: RowFunction
    among: AmongFunction
    derive: DeriveFunction | None
    derive_arrays: DeriveArrays | None


@dataclass(frozen=True, slots=True)
class Program:
    """All generated functions of a pair rule.

    Args:
        source: Their text.
        left: Those about the left side.
        right: Those about the right side.
        mask: Tests any pairs with arrays; None where Python has to do it.
    """

    source: str
    left: SidePrograms
    right: SidePrograms
    mask: MaskFunction | None


def write_program(
    tests: Sequence[Call], left: Inputs, right: Inputs, limit: float, title: str
) -> Program:
    """Generate and compile the code of a pair rule.

    Args:
        tests: The tests that are about both objects, in the order written.
        left: What it takes of the left object.
        right: What it takes of the right one.
        limit: The greatest magnitude of an attribute.
        title: One line that says what this is.
    """
    taken: set[str] = set()
    names = [
        identifiers(inputs.terms, side, taken)
        for inputs, side in ((left, "left"), (right, "right"))
    ]
    named = dict(zip((*left.terms, *right.terms), (*names[0], *names[1]), strict=True))
    blocks = [f"# {title}", *(f"#   {test}" for test in tests), "", ""]
    # The names of lists: those of their values, in the plural.
    lists = [
        identifiers([Variable(f"?{name}s") for name in words], side, taken)
        for words, side in zip(names, _SIDES, strict=True)
    ]
    for number, side in enumerate(_SIDES):
        own, others = names[number], names[1 - number]
        condition = PythonWriter(named, limit).condition(tests)
        blocks += _rows(side, (own, lists[number]), others, condition)
        blocks += _row(side, own, others, condition)
        terms, listed = (left, right)[1 - number].terms, lists[1 - number]
        picked = {term: f"{word}[other]" for term, word in zip(terms, listed, strict=True)}
        blocks += _among(side, own, listed, PythonWriter(named | picked, limit).condition(tests))
    blocks += _mask(tests, names, named, limit)
    for inputs, words, side in ((left, names[0], "left"), (right, names[1], "right")):
        blocks += _derive(inputs, words, side, limit)
        blocks += _derive_arrays(inputs, side, limit)
    source = "\n".join(blocks).rstrip() + "\n"
    found = _execute(source)
    made = [
        SidePrograms(
            found[f"{side}_rows"],
            found[f"{side}_row"],
            found[f"{side}_among"],
            found.get(f"derive_{side}"),
            found.get(f"derive_{side}_arrays"),
        )
        for side in _SIDES
    ]
    return Program(source, made[0], made[1], found.get("mask"))


def helpers() -> dict[str, Any]:
    """Give what generated code calls, by name."""
    return {
        "np": np,
        "dist": math.dist,
        "sqrt": math.sqrt,
        "checked": checked,
        **{name: FUNCTIONS[word].implementation for word, name in HELPERS.items()},
    }


def _execute(source: str) -> dict[str, Any]:
    """Run generated definitions; a traceback or profiler finds their lines by `linecache`."""
    filename = f"<pair kernel {blake2b(source.encode(), digest_size=6).hexdigest()}>"
    linecache.cache[filename] = (len(source), None, source.splitlines(keepends=True), filename)
    space = helpers()
    exec(compile(source, filename, "exec"), space)  # noqa: S102 # the text is generated here
    return space


def _each(condition: str, others: list[str]) -> str:
    """Write a comprehension over the inputs of the other side."""
    if len(others) == 1:
        return f"[{condition} for {others[0]} in others[0]]"
    return f"[{condition} for {', '.join(others)} in zip(*others)]"


def _rows(
    side: str, own: tuple[list[str], list[str]], others: list[str], condition: str
) -> list[str]:
    other, (names, lists) = _OTHER[side], own
    length = "slot * stride : slot * stride + len(row)"
    if side == "right":
        length = "slot : slot + len(row) * stride : stride"
    return [
        f"def {side}_rows(slots, twins, own, others, bits, stride):",
        f'    """Test {side} objects against all {other} ones; give the rows that have changed."""',
        *(f"    {name} = own[{place}]" for place, name in enumerate(lists)),
        "    found = []",
        "    for slot, twin in zip(slots, twins):",
        *(f"        {name} = {word}[slot]" for name, word in zip(names, lists, strict=True)),
        f"        row = {_each(condition, others)}",
        "        if twin >= 0:",
        "            row[twin] = False",
        "        row = bytes(row)",
        f"        if row != bits[{length}]:",
        "            found.append((slot, row))",
        "    return found",
        "",
        "",
    ]


def _row(side: str, own: list[str], others: list[str], condition: str) -> list[str]:
    return [
        f"def {side}_row(slot, own, others):",
        f'    """Test one {side} object against every {_OTHER[side]} one: a byte each."""',
        *(f"    {name} = own[{place}][slot]" for place, name in enumerate(own)),
        f"    return bytes({_each(condition, others)})",
        "",
        "",
    ]


def _among(side: str, own: list[str], listed: list[str], condition: str) -> list[str]:
    return [
        f"def {side}_among(slot, own, others, among):",
        f'    """Test one {side} object against some {_OTHER[side]} ones; give those that hold."""',
        *(f"    {name} = own[{place}][slot]" for place, name in enumerate(own)),
        *(f"    {name} = others[{place}]" for place, name in enumerate(listed)),
        f"    return [other for other in among if {condition}]",
        "",
        "",
    ]


def _mask(
    tests: Sequence[Call], names: list[list[str]], named: dict[Expression, str], limit: float
) -> list[str]:
    try:
        statements = ArrayWriter(named, limit).statements(tests)
    except NotVectorizableError:
        return []
    return [
        f"def mask({', '.join(names[0] + names[1])}):",
        '    """Test pairs given as arrays: which hold, and which must be asked one by one."""',
        *(f"    {line}" for line in statements),
        "",
        "",
    ]


def _derive(inputs: Inputs, words: list[str], side: str, limit: float) -> list[str]:
    if not inputs.derived:
        return []
    variables = [Variable(name) for name in inputs.variables]
    own = identifiers(variables, side, set())
    writer_names = dict(zip(map(_as_expression, variables), own, strict=True))
    derived = dict(zip(inputs.terms, words, strict=True))
    lines = [
        f"def derive_{side}(slots, attributes, derived):",
        f'    """Compute what the tests need of each {side} object, once an object."""',
        "    for slot in slots:",
    ]
    lines += [f"        {name} = attributes[{place}][slot]" for place, name in enumerate(own)]
    for place, term in enumerate(inputs.derived):
        text = PythonWriter(writer_names, limit).number(term)
        lines.append(f"        derived[{place}][slot] = {text}  # {derived[term]}")
    return [*lines, "", ""]


def _derive_arrays(inputs: Inputs, side: str, limit: float) -> list[str]:
    if not inputs.derived:
        return []
    variables = [Variable(name) for name in inputs.variables]
    own = identifiers(variables, side, set())
    writer = ArrayWriter(dict(zip(map(_as_expression, variables), own, strict=True)), limit)
    try:
        statements = writer.numbers(inputs.derived)
    except NotVectorizableError:
        return []
    return [
        f"def derive_{side}_arrays({', '.join(own)}):",
        f'    """Compute what the tests need of all {side} objects, and where it is in doubt."""',
        *(f"    {line}" for line in statements),
        "",
        "",
    ]


def _as_expression(variable: Variable) -> Expression:
    return variable
