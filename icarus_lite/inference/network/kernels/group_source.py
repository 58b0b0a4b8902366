"""The generated code of a group: all pair rules that see the objects of one type.

`follow` is for a few objects that have moved, `whole` and `near_pairs` are for many, `flat` is for
as many as there are where there are few.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference.network.kernels.columns import PLAIN
from icarus_lite.inference.network.kernels.group_all_source import write_all
from icarus_lite.inference.network.kernels.group_few_source import write_few
from icarus_lite.inference.network.kernels.group_flat_source import FlatSource, write_flat
from icarus_lite.inference.network.kernels.group_members import Bound, GroupNames, Member, box_of
from icarus_lite.inference.network.kernels.ranges import is_guarded
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class GroupSource:
    """What is generated for a group.

    Args:
        text: The source.
        columns: The identifier of each list or array of an attribute: type and attribute.
        derived: The identifier of each derived input: member, side and place among its own.
        box: The attributes that bound where partners are, at most two.
        boxed: The members they bound.
        arrays: The parameters of `whole` and `near_pairs`, which are among the columns; None where
            arrays will not do.
        flat: What is generated for all pairs laid out one after the other, likewise.
        may_warn: Whether `whole` may meet quotients or roots that do not exist.
    """

    text: str
    columns: dict[str, tuple[str, str]]
    derived: dict[str, tuple[int, str, int]]
    box: tuple[Bound, ...]
    boxed: frozenset[int]
    arrays: tuple[str, ...] | None
    flat: FlatSource | None
    may_warn: bool


def write_group(type_: str, members: Sequence[Member]) -> GroupSource:
    """Write the functions of a group.

    Args:
        type_: The type of the objects that move.
        members: The rules that see them, on either side or on both.
    """
    names = GroupNames(members)
    box, boxed = box_of(type_, members)
    lines = [
        f"# Pair rules that see objects of type {type_}:",
        *(f"#   {each.name}: {' '.join(map(str, each.kernel.tests))}" for each in members),
        "",
        "",
    ]
    constants: dict[str, str] = {}
    lines += write_few(type_, names, box, boxed)
    together, parameters = write_all(names, boxed, constants)
    flat = write_flat(names, constants)
    lines += [f"{name} = np.array({text})" for text, name in constants.items()]
    lines += ["", "", *together, "", "", *(flat.lines if flat else ())]
    return GroupSource(
        "\n".join(lines).rstrip() + "\n",
        {name: place for place, name in names.columns.items()},
        {name: place for place, name in names.inputs.items()},
        box,
        boxed,
        parameters,
        flat,
        any(is_guarded(test, PLAIN) for each in members for test in each.kernel.paired),
    )
