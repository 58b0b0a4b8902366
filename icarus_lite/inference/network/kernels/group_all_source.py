"""The generated code of a group for all objects: every pair of every rule at once, with arrays.

What two rules compute alike is computed once. `whole` tests all pairs there are; `near_pairs`
tests, for the rules with a bound on the distance, only given ones.
"""

from __future__ import annotations

from icarus_lite.inference.network.kernels.array_source import ArrayWriter, NotVectorizableError
from icarus_lite.inference.network.kernels.columns import PLAIN
from icarus_lite.inference.network.kernels.group_members import GroupNames
from icarus_lite.inference.network.kernels.group_terms import (
    canonical,
    derived_of,
    renamed,
    renamed_tests,
)
from icarus_lite.language.syntax import Expression, Variable
from icarus_lite.records import dataclass, field


def write_all(
    names: GroupNames, boxed: frozenset[int], constants: dict[str, str]
) -> tuple[list[str], tuple[str, ...] | None]:
    """Write the functions that test all pairs.

    Args:
        names: The identifiers of the group.
        boxed: The members that are bounded: `near_pairs` tests these on given pairs.
        constants: See `ArrayWriter`.

    Returns:
        The lines, and the parameters of the functions; none where arrays will not do.
    """
    try:
        whole = _All(names, frozenset(), constants).write()
        near = _All(names, boxed, constants).write() if boxed else None
    except NotVectorizableError:
        return [], None
    parameters = tuple(sorted(whole.used))
    lines = [
        f"def whole({', '.join(parameters)}):",
        '    """Give of every pair whether each rule holds, and which must be asked alone."""',
        *(f"    {line}" for line in whole.lines),
    ]
    if near is not None:
        lines += [
            "",
            "",
            f"def near_pairs(left, right, {', '.join(parameters)}):",
            '    """Give the same, for the bounded rules only of some pairs."""',
            *(f"    {line}" for line in near.lines),
        ]
    return lines, parameters


@dataclass(slots=True)
class _All:
    """Writes the body of one function.

    Args:
        names: The identifiers of the group.
        paired: The members that are tested on given pairs only.
        constants: See `ArrayWriter`.
        lines: What has been written.
        used: The parameters.
    """

    names: GroupNames
    paired: frozenset[int]
    constants: dict[str, str]
    lines: list[str] = field(default_factory=list)
    used: set[str] = field(default_factory=set)

    def write(self) -> _All:
        """Write it.

        Raises:
            NotVectorizableError: the tests must be computed in Python.
        """
        results: dict[int, str] = {}
        derived = derived_of(self.names, self.constants)
        self.lines += derived.lines
        self.used.update(derived.given)
        known: tuple[dict[Expression, str], dict[Expression, str]] = ({}, {})
        views: dict[str, None] = {}
        for number, member in enumerate(self.names.members):
            is_paired = number in self.paired
            given = [self._input(number, side, known[is_paired], views) for side in range(2)]
            if member.order is not None:
                results[number] = f"({', '.join(name for each in given for name in each)})"
        self.lines += views
        for is_paired in (False, True):
            tests = {
                number: renamed_tests(member)
                for number, member in enumerate(self.names.members)
                if member.order is None and (number in self.paired) is is_paired
            }
            writer = ArrayWriter(known[is_paired], PLAIN, self.constants)
            writer.share([test for each in tests.values() for test in each])
            found = {number: writer.conjunction(each) for number, each in tests.items()}
            self.lines += writer.lines
            for number, (hold, doubt) in found.items():
                self.lines.append(f"hold_of_{number} = {hold}")
                if doubt:
                    self.lines.append(f"doubt_of_{number} = {doubt}")
                results[number] = f"(hold_of_{number}, {f'doubt_of_{number}' if doubt else None})"
        self.lines.append(f"return ({', '.join(results[n] for n in range(len(results)))},)")
        return self

    def _input(
        self, number: int, place: int, known: dict[Expression, str], views: dict[str, None]
    ) -> list[str]:
        """Name the inputs of one side as tests read them."""
        member = self.names.members[number]
        word, side, _, type_ = member.sides()[place]
        of_side = canonical(side, type_, word)
        found = []
        for term, name in self.names.terms(number, word):
            if isinstance(term, Variable):
                self.used.add(name)
            text = name
            if number in self.paired:
                text = f"{name}_{word}"
                views[f"{text} = {name}.take({word})"] = None
            elif word == "left" and member.order is None:
                text = f"{name}_upright"
                views[f"{text} = {name}[:, None]"] = None
            known[renamed(term, of_side)] = text
            found.append(text)
        return found
