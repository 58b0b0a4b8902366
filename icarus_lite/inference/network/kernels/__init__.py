"""Numeric pair rules: which pairs of objects meet arithmetic tests, cycle after cycle.

A *pair rule* begins with two percept patterns and tests over their numeric attributes, such as
`near` or `left_of`. `compile_pair` compiles it once a domain, `PairKernel.instance` makes a
`PairRelation` over the `Columns` that hold the objects, and `PairRelation.update` gives the net
change whenever some of them have moved. Rules that see the same objects are followed together by a
`PairGroup` as long as nothing about them is unusual.
"""

from icarus_lite.inference.network.kernels.columns import Columns
from icarus_lite.inference.network.kernels.exact import PairSide
from icarus_lite.inference.network.kernels.group import PairGroup
from icarus_lite.inference.network.kernels.group_members import Member
from icarus_lite.inference.network.kernels.group_program import GroupProgram, compile_group
from icarus_lite.inference.network.kernels.kernel import PairKernel, compile_pair
from icarus_lite.inference.network.kernels.relation import Change, Pair, PairRelation

__all__ = [
    "Change", "Columns", "GroupProgram", "Member", "Pair", "PairGroup", "PairKernel",
    "PairRelation", "PairSide", "compile_group", "compile_pair",
]  # fmt: skip
