"""Pair rules that see objects of one type, followed together when only these objects have moved.

In the usual cycle some objects move and nothing else is out of the ordinary. Then one generated
function does for all rules what each would do on its own (`group_source`): it finds what is gained
and lost without touching the relations, which take it over one after the other, as rules expect.
Whatever is out of the ordinary is left to the relations themselves.
"""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from icarus_lite.inference.network.kernels.columns import PLAIN, Columns, Numbers
from icarus_lite.inference.network.kernels.exact import variables_of
from icarus_lite.inference.network.kernels.flat import FlatPairs
from icarus_lite.inference.network.kernels.group_program import GroupProgram
from icarus_lite.inference.network.kernels.keys import Keys
from icarus_lite.inference.network.kernels.matrix import MatrixRelation
from icarus_lite.inference.network.kernels.neighbours import FEW_STRIPS
from icarus_lite.inference.network.kernels.notes import Notes
from icarus_lite.inference.network.kernels.order import OrderRelation
from icarus_lite.inference.network.kernels.program import helpers
from icarus_lite.inference.network.kernels.relation import Change
from icarus_lite.inference.network.kernels.sweep import Slots, Stretch, candidates

_WIDER = 1 + 1e-6
_SLACK = PLAIN * 2.0**-50  # of rounding: what is added to a place, and a difference of places
_HARDLY_MORE = 1.02

_MANY_PLACES = 100
"""From so many objects on, those near one are found in sorted places, else by looking at all."""

Found: TypeAlias = dict[int, Change | Slots]
"""What members of a group gain and lose, by their number, or all that they hold now."""


class PairGroup:
    """The relations of a group over the columns of one network.

    Args:
        program: The compiled group.
        relations: The relation of each member.
        columns: The objects that move.
    """

    __slots__ = (
        "_armed_for", "_arrays", "_choice", "_columns", "_derived", "_few", "_flat", "_found",
        "_given", "_is_behind", "_is_limiting", "_keys", "_limits", "_matrices", "_moving", "_near",
        "_program", "_reach", "_relations", "_rows", "_slots", "_way", "_whole", "_wholes",
    )  # fmt: skip

    def __init__(
        self,
        program: GroupProgram,
        relations: Sequence[MatrixRelation | OrderRelation],
        columns: Columns,
    ) -> None:
        self._program = program
        self._relations = tuple(relations)
        self._matrices = [
            (number, each)
            for number, each in enumerate(relations)
            if isinstance(each, MatrixRelation)
        ]
        self._columns = columns
        self._reach = [0.0] * len(program.source.box)
        self._rows: tuple[list[list[list[int] | None]], ...] = (
            [[] for _ in relations],
            [[] for _ in relations],
        )
        self._armed_for: tuple[str, ...] | None = None
        self._keys: Keys | None = None
        self._choice: tuple[int, int, str] = (-1, -1, "")
        self._is_behind = True
        self._is_limiting = False
        self._slots: Sequence[int] = ()
        self._wholes: Sequence[Any] = ()
        self._way = ""
        self._found: dict[int, Change] = {}
        space, given, self._flat = self._space()
        self._few: Callable[[Sequence[int], Keys | None], Found] = space["follow"]
        self._whole: Callable[..., Sequence[Any]] | None = space.get("whole")
        self._near: Callable[..., Sequence[Any]] = space.get("near_pairs", _no_arrays)
        self._given = given
        self._arrays: list[Numbers] | None = None  # what `whole` is given, once it has been
        self._moving: list[tuple[int, str]] = []
        self._derived = list(
            dict.fromkeys(
                s for r in relations for s in r.sides if s.derived and s.columns is columns
            )
        )
        self._limits = self._limiting_attributes()

    def _space(self) -> tuple[dict[str, Any], list[tuple[Columns, str]], FlatPairs | None]:
        """Run the generated definitions over the lists of this network."""
        source, columns_of = self._program.source, {}
        for relation, member in zip(self._relations, self._program.members, strict=True):
            for side, type_ in zip(relation.sides, (member.left, member.right), strict=True):
                columns_of[type_] = side.columns
        notes = Notes(self._program.members, *self._rows)
        space: dict[str, Any] = {
            **helpers(),
            "bisect_left": bisect_left,
            "bisect_right": bisect_right,
            "reach": self._reach,
            "note_mirrored": notes.mirrored,
            "note_on_left": notes.on_left,
            "note_on_right": notes.on_right,
        }
        for number, relation in enumerate(self._relations):
            space[f"left_rows_{number}"] = self._rows[0][number]
            space[f"right_rows_{number}"] = self._rows[1][number]
            space[f"of_left_{number}"] = relation.of_left
            space[f"of_right_{number}"] = relation.of_right
        for name, (type_, attribute) in source.columns.items():
            space[name] = columns_of[type_].column(attribute)
        for name, (number, word, place) in source.derived.items():
            space[name] = self._relations[number].sides[word == "right"].derived[place]
        exec(self._program.code, space)  # noqa: S102 - it was written here, from a checked domain
        every = {
            name: (columns_of[t], attribute) for name, (t, attribute) in source.columns.items()
        }
        flat = None
        if source.flat is not None:
            flat = FlatPairs(source.flat, space, every, columns_of, self._relations)
        return space, [every[name] for name in source.arrays or ()], flat

    def _limiting_attributes(self) -> frozenset[str]:
        """Give the attributes on which the reach of the rules depends."""
        found: set[str] = set()
        for bound in self._program.source.box:
            for number, axis in bound.axes:
                if isinstance(axis.limit, tuple):
                    _, side, plan, _ = self._program.members[number].sides()[axis.limit[0]]
                    of = dict(side.attributes)
                    found |= {of[v] for v in variables_of(plan.inputs.terms[axis.limit[1]])}
        return frozenset(found)

    # -- following -----------------------------------------------------------------------------

    def follow(self, slots: Sequence[int], attributes: tuple[str, ...]) -> Found | None:
        """Find out what the relations kept as matrices gain and lose; they are left as they were.

        Args:
            slots: The objects that have moved, each once; nothing else has changed.
            attributes: The attributes that have changed.

        Returns:
            For each member that changes the pairs gained and lost; None where the relations must
            follow by themselves. Those that are an order of keys are not in it: see `order`.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        moved, size = len(slots), self._columns.size
        if self._choice[0] != moved or self._choice[1] != size:
            self._choice = moved, size, self._choose(moved, size)
        way = self._choice[2]
        if way == "alone" or self._columns.unusual:
            return None
        if attributes is not self._armed_for and not self._arm(attributes):
            return None
        if self._is_limiting:
            self._set_reach()
        self._slots = slots
        if way != self._way:
            self._turn_to(way)
        if way == "few":
            return self._follow_few(slots)
        if way == "flat":
            return self._follow_flat()
        return (self._follow_near() if way == "near" else None) or self._follow_whole()

    def _choose(self, moved: int, size: int) -> str:
        costs, others = self._program.costs, size
        for relation in self._relations:
            others = max(others, *(side.size for side in relation.sides))
        way = costs.choose(moved, others, arrays=self._whole is not None)
        return "whole" if way == "flat" and self._flat is None else way

    def _turn_to(self, way: str) -> None:
        """Rely no longer on what another way has left behind."""
        if "flat" in (way, self._way):
            for _, matrix in self._matrices:
                matrix.forget()
            if self._flat is not None:
                self._flat.forget()
        self._way = way

    def _follow_flat(self) -> Found:
        assert self._flat is not None, "it was chosen"
        assert self._armed_for is not None, "it has been seen to"
        self._is_behind = True
        if not self._flat.is_armed:
            self._flat.arm(self._columns, self._armed_for)
        if self._program.source.may_warn:
            with np.errstate(all="ignore"):
                self._found = self._flat.follow()
        else:
            self._found = self._flat.follow()
        return {**self._found}

    def _follow_few(self, slots: Sequence[int]) -> Found | None:
        if self._is_behind:
            self._catch_up()
        try:
            return self._few(slots, self._keys)
        except (ArithmeticError, ValueError):  # the exact test tells which pair it is
            return None

    def _follow_whole(self) -> Found:
        assert self._whole is not None, "it was chosen"
        wholes = self._run(self._whole, self._ready_arrays())
        found: Found = {}
        for number, relation in self._matrices:
            change = relation.compare(*wholes[number])
            if change is not None:
                found[number] = change
        return found

    def _follow_near(self) -> Found | None:
        """Test the bounded rules on pairs from a grid; None where objects are too close for one."""
        source, arrays = self._program.source, self._ready_arrays()
        places = [self._columns.array(bound.attribute) for bound in source.box]
        axes = [Stretch(p, p, reach) for p, reach in zip(places, self._reach, strict=True)]
        pairs = candidates(axes, FEW_STRIPS, mirrored=True)
        if pairs is None:
            return None
        i, j = pairs
        apart = i != j
        left, right = np.concatenate([i, j[apart]]), np.concatenate([j, i[apart]])
        wholes = self._run(self._near, [left, right, *arrays])
        found: Found = {}
        for number, relation in self._matrices:
            if number in source.boxed:
                found[number] = relation.among(left, right, *wholes[number])
                continue
            change = relation.compare(*wholes[number])
            if change is not None:
                found[number] = change
        return found

    def _ready_arrays(self) -> list[Numbers]:
        """Give the arrays that the generated functions take."""
        self._is_behind = True
        arrays = self._arrays
        if arrays is None:
            arrays = self._arrays = [columns.array(name) for columns, name in self._given]
        for place, attribute in self._moving:
            arrays[place] = self._columns.array(attribute)
        return arrays

    def _run(
        self, function: Callable[..., Sequence[Any]], given: Sequence[Numbers | Slots]
    ) -> Sequence[Any]:
        if self._program.source.may_warn:
            with np.errstate(all="ignore"):
                self._wholes = function(*given)
        else:
            self._wholes = function(*given)
        return self._wholes

    def matrix(self, number: int, found: Change | Slots) -> Change:
        """Let a relation that is kept as a matrix take over what was found; give its change."""
        relation = self._relations[number]
        assert isinstance(relation, MatrixRelation), "only these are found beforehand"
        if isinstance(found, tuple):
            relation.apply(*found)
            return found
        return relation.replace(found)

    def order(self, number: int) -> Change:
        """Let a relation that is an order of keys follow; give what it gains and loses."""
        relation = self._relations[number]
        assert isinstance(relation, OrderRelation), "all others are found beforehand"
        if self._way == "flat":
            assert self._flat is not None, "it was chosen"
            return relation.taken(*self._flat.keys(number), self._found.get(number, ([], [])))
        if self._is_behind:
            return relation.replaced(*self._wholes[number])
        member = self._program.members[number]
        own = self._program.type
        return relation.moved(
            self._slots if member.left == own else (), self._slots if member.right == own else ()
        )

    # -- being ready ---------------------------------------------------------------------------

    def disarm(self) -> None:
        """Leave the next change to the relations themselves: something out of the ordinary."""
        if self._armed_for is not None:
            self._armed_for = None
            if self._is_behind:
                for side in self._derived:
                    side.derive_again()

    def _arm(self, attributes: tuple[str, ...]) -> bool:
        """Find out whether all is ordinary, and how far partners may be."""
        self.disarm()
        for relation in self._relations:
            if not relation.is_ordinary(self._columns):
                return False
        for _, matrix in self._matrices:
            matrix.forget()
        self._arrays = None
        self._moving = [
            (place, name)
            for place, (columns, name) in enumerate(self._given)
            if columns is self._columns and name in attributes
        ]
        for relation in self._relations:
            for side in relation.sides:  # those of partners too: they are read as well
                side.ready_lists()
        if self._flat is not None:
            self._flat.disarm()
        self._set_reach()
        self._is_behind = True
        self._is_limiting = not self._limits.isdisjoint(attributes)
        self._armed_for = attributes
        self._keys = None
        return True

    def _set_reach(self) -> None:
        for place, bound in enumerate(self._program.source.box):
            most = 0.0
            for number, axis in bound.axes:
                limit = axis.limit
                if isinstance(limit, tuple):
                    side = self._relations[number].sides[limit[0]]
                    limit = float(max(side.ready_lists()[limit[1]], default=0.0))
                most = max(most, axis.reach(limit))
            self._reach[place] = _rounded_up(most * _WIDER + _SLACK)

    def _catch_up(self) -> None:
        """Bring up to date what only the way for a few objects needs."""
        self._is_behind = False
        self._arrays = None
        for _, matrix in self._matrices:
            matrix.forget()
        for rows, place in ((self._rows[0], 0), (self._rows[1], 1)):
            for each, relation in zip(rows, self._relations, strict=True):
                each[:] = [None] * relation.sides[place].size
        for side in self._derived:
            side.derive_again()
        self._keys = None
        if self._program.source.box and self._columns.size >= _MANY_PLACES:
            self._keys = Keys(math.inf)
            self._keys.replace(self._columns.array(self._program.source.box[0].attribute).copy())
            self._keys.rank()


def _rounded_up(reach: float) -> float:
    """Give a reach that is a whole number, if that is hardly more.

    Where places are whole numbers their bounds are then too, and are compared in half the time.
    """
    if not reach < PLAIN:  # it may be infinite
        return reach
    whole = math.ceil(reach)
    return whole if whole <= reach * _HARDLY_MORE else reach


def _no_arrays(*_: object) -> Sequence[Any]:
    raise AssertionError("it is not chosen where arrays will not do")
