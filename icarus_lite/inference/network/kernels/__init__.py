"""Numeric pair rules: which pairs of objects meet arithmetic tests, cycle after cycle.

A *pair rule* begins with two percept patterns and tests over their numeric attributes, such as
`near` or `left_of`. `compile_pair` compiles it once a domain, `PairKernel.instance` makes a
`PairRelation` over the `Columns` that hold the objects, and `PairRelation.update` gives the net
change whenever some of them have moved. Rules that see the same objects are followed together by a
`PairGroup` as long as nothing about them is unusual.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from icarus_lite._on_use import imported_on_use

if TYPE_CHECKING:
    from icarus_lite.inference.network.kernels.columns import Columns
    from icarus_lite.inference.network.kernels.exact import PairSide
    from icarus_lite.inference.network.kernels.group import PairGroup
    from icarus_lite.inference.network.kernels.group_members import Member
    from icarus_lite.inference.network.kernels.group_program import GroupProgram, compile_group
    from icarus_lite.inference.network.kernels.kernel import PairKernel, compile_pair
    from icarus_lite.inference.network.kernels.matrix import MatrixRelation
    from icarus_lite.inference.network.kernels.order import OrderRelation
    from icarus_lite.inference.network.kernels.relation import Change, Pair, PairRelation

_HOMES = {
    "Change": "relation",
    "Columns": "columns",
    "GroupProgram": "group_program",
    "MatrixRelation": "matrix",
    "Member": "group_members",
    "OrderRelation": "order",
    "Pair": "relation",
    "PairGroup": "group",
    "PairKernel": "kernel",
    "PairRelation": "relation",
    "PairSide": "exact",
    "compile_group": "group_program",
    "compile_pair": "kernel",
}

__all__ = [
    "Change", "Columns", "GroupProgram", "MatrixRelation", "Member", "OrderRelation", "Pair",
    "PairGroup", "PairKernel", "PairRelation", "PairSide", "compile_group", "compile_pair",
]  # fmt: skip

__getattr__ = imported_on_use(__name__, _HOMES)
