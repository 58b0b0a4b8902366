"""The generated code of a group for all pairs of a few objects, laid out one after the other.

Where there are few objects, what an operation on arrays costs is the call, and more so where a
column is to be combined with a row than where both are of one length. So the values of the left and
of the right object of every pair are laid out first, all of them at once (`flat`), and all
operations are on such rows of pairs; those that are alike become one call (see `stacking`).
"""

from __future__ import annotations

from icarus_lite.inference.network.kernels.array_source import ArrayWriter, NotVectorizableError
from icarus_lite.inference.network.kernels.columns import PLAIN
from icarus_lite.inference.network.kernels.group_members import GroupNames, Member
from icarus_lite.inference.network.kernels.group_terms import (
    canonical,
    derived_of,
    renamed,
    renamed_tests,
)
from icarus_lite.inference.network.kernels.stacking import Stacked, Stacking
from icarus_lite.language.syntax import Expression
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Plane:
    """All pairs of some objects with some others.

    Args:
        left: The type of the left objects.
        right: The type of the right objects.
        apart: Whether the pairs of an object with itself are left out.
    """

    left: str
    right: str
    apart: bool


@dataclass(frozen=True, slots=True)
class FlatSource:
    """What is generated to test all pairs laid out one after the other.

    Args:
        lines: The functions `derive` and `flat_over`.
        planes: The pairs that rules are about.
        plane_of: For each member its plane, by its number.
        operands: For each operand of the tests what is laid out, over which plane, for which side.
        stacked: The tests over stores of rows.
        given: The parameters of `derive`, which are among the columns.
        derived: What `derive` returns.
        keys: For each member that is an order of keys, these: of the left and of the right.
    """

    lines: tuple[str, ...]
    planes: tuple[Plane, ...]
    plane_of: tuple[int, ...]
    operands: dict[str, tuple[str, int, str]]
    stacked: Stacked
    given: tuple[str, ...]
    derived: tuple[str, ...]
    keys: dict[int, tuple[str, str]]


def write_flat(names: GroupNames, constants: dict[str, str]) -> FlatSource | None:
    """Write the functions; None where arrays will not do.

    Args:
        names: The identifiers of the group.
        constants: See `ArrayWriter`.
    """
    try:
        return _Flat(names, constants).write()
    except NotVectorizableError:
        return None


class _Flat:
    def __init__(self, names: GroupNames, constants: dict[str, str]) -> None:
        self._names, self._constants = names, constants
        every = [_plane_of(member) for member in names.members]
        self._planes = list(dict.fromkeys(every))
        self._plane_of = [self._planes.index(plane) for plane in every]
        self._operands: dict[tuple[str, int, str], str] = {}
        self._keys: dict[int, tuple[str, str]] = {}

    def write(self) -> FlatSource:
        """Write them.

        Raises:
            NotVectorizableError: the tests must be computed in Python.
        """
        derived = derived_of(self._names, self._constants)
        statements: list[str] = []
        results: dict[int, tuple[str, str]] = {}
        for number in range(len(self._planes)):
            statements += self._plane(number, results)
        operands = {text: key for key, text in self._operands.items()}
        planes = {text: plane for text, (_, plane, _) in operands.items()}
        every = [results[number] for number in range(len(results))]
        stacked = Stacking(planes, self._constants).write(statements, every)
        lines = [
            f"def derive({', '.join(derived.given)}):",
            '    """Give what is computed once an object."""',
            *(f"    {line}" for line in derived.lines),
            f"    return [{', '.join(derived.names)}]",
            "",
            "",
            *stacked.lines,
        ]
        return FlatSource(
            tuple(lines),
            tuple(self._planes),
            tuple(self._plane_of),
            operands,
            stacked,
            derived.given,
            derived.names,
            self._keys,
        )

    def _plane(self, plane: int, results: dict[int, tuple[str, str]]) -> list[str]:
        """Write the tests of all members that are about the pairs of a plane."""
        members = [
            (number, member)
            for number, member in enumerate(self._names.members)
            if self._plane_of[number] == plane
        ]
        known: dict[Expression, str] = {}
        orders: list[str] = []
        tests = {}
        for number, member in members:
            given = [self._input(number, place, plane, known) for place in range(2)]
            order = member.order
            if order is None:
                tests[number] = renamed_tests(member)
                continue
            ((left, of_left),), ((right, of_right),) = given
            sign = ("<" if order.ascending else ">") + ("" if order.strict else "=")
            orders.append(f"hold_of_{number} = {of_left} {sign} {of_right}")
            self._keys[number] = left, right
            results[number] = f"hold_of_{number}", "None"
        writer = ArrayWriter(known, PLAIN, self._constants)
        writer.share([test for each in tests.values() for test in each])
        found = {number: writer.conjunction(each) for number, each in tests.items()}
        lines = [*orders, *writer.lines]
        for number, (hold, doubt) in found.items():
            lines.append(f"hold_of_{number} = {hold}")
            if doubt:
                lines.append(f"doubt_of_{number} = {doubt}")
            results[number] = f"hold_of_{number}", f"doubt_of_{number}" if doubt else "None"
        return lines

    def _input(
        self, number: int, place: int, plane: int, known: dict[Expression, str]
    ) -> list[tuple[str, str]]:
        """Name the inputs of one side: the array of each, and the same laid out."""
        word, side, _, type_ = self._names.members[number].sides()[place]
        of_side = canonical(side, type_, word)
        found = []
        for term, name in self._names.terms(number, word):
            text = f"{name}_{word}" + (f"_{plane + 1}" if plane else "")
            self._operands[name, plane, word] = text
            known[renamed(term, of_side)] = text
            found.append((name, text))
        return found


def _plane_of(member: Member) -> Plane:
    apart = member.left == member.right and member.kernel.plan.distinct
    return Plane(member.left, member.right, apart)
