"""The generated code of a group for all objects: every pair of every rule at once, with arrays.

What two rules compute alike is computed once. `whole` tests all pairs there are; `near_pairs`
tests, for the rules with a bound on the distance, only given ones.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from icarus_lite.inference.network.kernels.array_source import ArrayWriter, NotVectorizableError
from icarus_lite.inference.network.kernels.columns import PLAIN
from icarus_lite.inference.network.kernels.exact import PairSide
from icarus_lite.inference.network.kernels.group_members import GroupNames, Member
from icarus_lite.inference.network.kernels.ranges import is_guarded
from icarus_lite.language.syntax import Call, Expression, Variable


def write_all(names: GroupNames, boxed: frozenset[int]) -> tuple[list[str], tuple[str, ...] | None]:
    """Write the functions that test all pairs.

    Args:
        names: The identifiers of the group.
        boxed: The members that are bounded: `near_pairs` tests these on given pairs.

    Returns:
        The lines, and the parameters of the functions; none where arrays will not do.
    """
    try:
        whole = _All(names, frozenset()).write()
        near = _All(names, boxed).write() if boxed else None
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
        lines: What has been written.
        used: The parameters.
    """

    names: GroupNames
    paired: frozenset[int]
    lines: list[str] = field(default_factory=list)
    used: set[str] = field(default_factory=set)

    def write(self) -> _All:
        """Write it.

        Raises:
            NotVectorizableError: the tests must be computed in Python.
        """
        results: dict[int, str] = {}
        self._derive()
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
                number: [_renamed_test(test, member) for test in member.kernel.paired]
                for number, member in enumerate(self.names.members)
                if member.order is None and (number in self.paired) is is_paired
            }
            writer = ArrayWriter(known[is_paired], PLAIN)
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

    def _derive(self) -> None:
        """Write what is computed once an object.

        Raises:
            NotVectorizableError: it must be computed in Python.
        """
        columns: dict[Expression, str] = {}
        derived: dict[str, Expression] = {}
        for number, member in enumerate(self.names.members):
            for word, side, _, type_ in member.sides():
                of_side = {v: self.names.column(type_, a) for v, a in side.attributes}
                for term, name in self.names.terms(number, word):
                    if isinstance(term, Call) and not (member.mirrored and word == "right"):
                        if is_guarded(term, PLAIN):
                            raise NotVectorizableError
                        derived[name] = _renamed(term, of_side)
                        used = [of_side[v] for v in _inside(term)]
                        columns |= {Variable(each): each for each in used}
                        self.used.update(used)
        writer = ArrayWriter(columns, PLAIN)
        writer.share(list(derived.values()))
        written = 0
        for name, term in derived.items():
            text = writer.number(term)
            self.lines += writer.lines[written:]
            written = len(writer.lines)
            self.lines.append(f"{name} = {text}")

    def _input(
        self, number: int, place: int, known: dict[Expression, str], views: dict[str, None]
    ) -> list[str]:
        """Name the inputs of one side as tests read them."""
        member = self.names.members[number]
        word, side, _, type_ = member.sides()[place]
        canonical = _canonical(side, type_, word)
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
            known[_renamed(term, canonical)] = text
            found.append(text)
        return found


def _canonical(side: PairSide, type_: str, word: str) -> dict[str, str]:
    """Give each variable of a side a name by what it stands for, alike in all rules."""
    return {variable: f"?{type_} {attribute} {word}" for variable, attribute in side.attributes}


def _renamed(expression: Expression, names: dict[str, str]) -> Expression:
    if isinstance(expression, Variable):
        return Variable(names.get(expression.name, expression.name))
    if isinstance(expression, Call):
        return Call(expression.function, tuple(_renamed(each, names) for each in expression.args))
    return expression


def _renamed_test(test: Call, member: Member) -> Call:
    names: dict[str, str] = {}
    for word, side, _, type_ in reversed(member.sides()):
        names |= _canonical(side, type_, word)
    found = _renamed(test, names)
    assert isinstance(found, Call), "a call stays one"
    return found


def _inside(expression: Expression) -> list[str]:
    """Give the variables in an expression."""
    if isinstance(expression, Variable):
        return [expression.name]
    if isinstance(expression, Call):
        return [name for each in expression.args for name in _inside(each)]
    return []
