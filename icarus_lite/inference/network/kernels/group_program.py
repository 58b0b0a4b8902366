"""A group of pair rules compiled, once a domain."""

from __future__ import annotations

import linecache
from collections.abc import Sequence
from hashlib import blake2b
from types import CodeType

from icarus_lite.inference.network.kernels.costs import GroupCosts, OneGroupWay
from icarus_lite.inference.network.kernels.group_members import Member, is_groupable
from icarus_lite.inference.network.kernels.group_source import GroupSource, write_group
from icarus_lite.records import dataclass, replace


@dataclass(frozen=True, slots=True)
class GroupProgram:
    """The compiled code of a group, once a domain.

    Args:
        type: The type of the objects that move.
        members: The rules that see them.
        source: What is generated, with the text for a person to read.
        code: The same, compiled.
        costs: What it costs to run it.
    """

    type: str
    members: tuple[Member, ...]
    source: GroupSource
    code: CodeType
    costs: GroupCosts

    def only_by(self, way: str) -> GroupProgram:
        """Give a program that always goes one way, where it can: see `OneGroupWay`."""
        costs = self.costs
        forced = OneGroupWay(costs.operations, costs.rules, costs.boxed, way)
        return replace(self, costs=forced)


def compile_group(type_: str, members: Sequence[Member]) -> GroupProgram | None:
    """Compile the rules that see objects of one type.

    Args:
        type_: The type.
        members: The rules, in the order in which they are followed.

    Returns:
        The program, over those of the rules that can be followed together; None if none can.
    """
    fit = tuple(
        member
        for member in members
        if is_groupable(member.kernel)
        # Objects of two types may share a name; that they are then no pair, the relation sees to.
        and (member.left == member.right or not member.kernel.distinct)
    )
    if not fit:
        return None
    source = write_group(type_, fit)
    path = f"<pair group {blake2b(source.text.encode(), digest_size=6).hexdigest()}>"
    lines = source.text.splitlines(keepends=True)
    linecache.cache[path] = (len(source.text), None, lines, path)
    code = compile(source.text, path, "exec")
    kernels = [member.kernel.plan.costs for member in fit if member.matrix is not None]
    return GroupProgram(type_, fit, source, code, GroupCosts.of(kernels, boxed=bool(source.box)))
