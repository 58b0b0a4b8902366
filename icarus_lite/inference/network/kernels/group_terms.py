"""What the rules of a group compute, under names that are alike in all of them.

So that what two rules have in common can be computed once.
"""

from __future__ import annotations

from icarus_lite.inference.network.kernels.array_source import ArrayWriter, NotVectorizableError
from icarus_lite.inference.network.kernels.columns import PLAIN
from icarus_lite.inference.network.kernels.exact import PairSide
from icarus_lite.inference.network.kernels.group_members import GroupNames, Member
from icarus_lite.inference.network.kernels.ranges import is_guarded
from icarus_lite.language.syntax import Call, Expression, Variable
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Derived:
    """What is computed once an object, as statements over arrays.

    Args:
        lines: The statements.
        names: What they assign in the end.
        given: The arrays that they read.
    """

    lines: tuple[str, ...]
    names: tuple[str, ...]
    given: tuple[str, ...]


def derived_of(names: GroupNames, constants: dict[str, str]) -> Derived:
    """Write what is computed once an object.

    Args:
        names: The identifiers of the group.
        constants: See `ArrayWriter`.

    Raises:
        NotVectorizableError: it must be computed in Python.
    """
    columns: dict[Expression, str] = {}
    derived: dict[str, Expression] = {}
    for number, member in enumerate(names.members):
        for word, side, _, type_ in member.sides():
            of_side = {v: names.column(type_, a) for v, a in side.attributes}
            for term, name in names.terms(number, word):
                if isinstance(term, Call) and not (member.mirrored and word == "right"):
                    if is_guarded(term, PLAIN):
                        raise NotVectorizableError
                    derived[name] = renamed(term, of_side)
                    used = [of_side[v] for v in _inside(term)]
                    columns |= {Variable(each): each for each in used}
    writer = ArrayWriter(columns, PLAIN, constants)
    writer.share(list(derived.values()))
    lines: list[str] = []
    written = 0
    for name, term in derived.items():
        text = writer.number(term)
        lines += writer.lines[written:]
        written = len(writer.lines)
        lines.append(f"{name} = {text}")
    return Derived(tuple(lines), tuple(derived), tuple(sorted(columns.values())))


def canonical(side: PairSide, type_: str, word: str) -> dict[str, str]:
    """Give each variable of a side a name by what it stands for, alike in all rules."""
    return {variable: f"?{type_} {attribute} {word}" for variable, attribute in side.attributes}


def renamed(expression: Expression, names: dict[str, str]) -> Expression:
    """Write an expression with other names for its variables."""
    if isinstance(expression, Variable):
        return Variable(names.get(expression.name, expression.name))
    if isinstance(expression, Call):
        return Call(expression.function, tuple(renamed(each, names) for each in expression.args))
    return expression


def renamed_tests(member: Member) -> list[Call]:
    """Give the tests of a rule about a pair, with names that are alike in all rules."""
    names: dict[str, str] = {}
    for word, side, _, type_ in reversed(member.sides()):
        names |= canonical(side, type_, word)
    found = [renamed(test, names) for test in member.kernel.paired]
    return [test for test in found if isinstance(test, Call)]


def _inside(expression: Expression) -> list[str]:
    """Give the variables in an expression."""
    if isinstance(expression, Variable):
        return [expression.name]
    if isinstance(expression, Call):
        return [name for each in expression.args for name in _inside(each)]
    return []
