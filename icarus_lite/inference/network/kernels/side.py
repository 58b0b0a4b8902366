"""One side of a pair relation: which objects take part, and what the kernels read of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from icarus_lite.inference.network.kernels.columns import PLAIN, Columns, Numbers, is_plain
from icarus_lite.inference.network.kernels.program import Inputs, SidePrograms
from icarus_lite.records import dataclass

Gate: TypeAlias = Callable[[int], bool | None]
"""Asks the tests about one object alone; None where only the exact test can tell."""

_FEW = 24
"""Up to so many changed objects are derived one by one, more of them all at once with arrays."""


@dataclass(frozen=True, slots=True)
class SidePlan:
    """What is known of one side once a domain is compiled.

    Args:
        attributes: The attributes that an object must have.
        inputs: What the kernels take of it.
        sources: For each variable that the inputs need, its attribute.
        programs: The generated functions.
        limit: The greatest magnitude of a number that the kernels take.
    """

    attributes: tuple[str, ...]
    inputs: Inputs
    sources: tuple[str, ...]
    programs: SidePrograms
    limit: float


class Side:
    """The objects of one side, as the kernels see them.

    An object is *present* if it is there, has the attributes and meets the tests about it alone.
    A present one is *odd* if the kernels cannot be trusted with it: an attribute is no number, or
    too large, or something derived from it has no value. Kernels read harmless numbers in its place
    and what they say about it is not used.

    Args:
        plan: What is known of the side.
        columns: Its objects.
        gate: Asks the tests about one object alone; None if there are none.

    Attributes:
        present: For each slot 1 or 0.
        absent: How many slots are not present.
        odd: The slots that only the exact test may judge.
        size: How many slots are known.
    """

    __slots__ = (
        "_arrays",
        "_attributes",
        "_derived",
        "_is_strict",
        "_lists_fresh",
        "_own",
        "_pending",
        "_plan",
        "absent",
        "columns",
        "gate",
        "lists",
        "odd",
        "present",
        "size",
    )

    def __init__(self, plan: SidePlan, columns: Columns, gate: Gate | None) -> None:
        self._plan = plan
        self._is_strict = plan.limit < PLAIN
        self.columns = columns
        self.gate = gate
        self.present = bytearray()
        self.absent = 0
        self.odd: set[int] = set()
        self.size = 0
        self._attributes: list[list[Any]] = [columns.column(name) for name in plan.sources]
        self._derived: list[list[float]] = [[] for _ in plan.inputs.derived]
        # Lists of its own, with a number in place of whatever is none; made when first needed.
        self._own = False
        places = [plan.inputs.variables.index(term.name) for term in plan.inputs.plain]
        self.lists: list[list[Any]] = [self._attributes[place] for place in places]
        self.lists += self._derived
        self._lists_fresh = True
        self._arrays: list[Numbers] = [np.zeros(0) for _ in plan.inputs.derived]
        self._pending: list[int] | None = None  # None: the arrays are to be made anew

    @property
    def derived(self) -> list[list[float]]:
        """The derived inputs as lists, one value a slot; `derive_again` where others write them."""
        return self._derived

    def is_ordinary(self, *, moving: bool) -> bool:
        """Whether nothing about its objects is unusual, so that moves may be followed elsewhere.

        Args:
            moving: Whether it is these objects that move.
        """
        if self.absent or self.odd or self._is_strict or self.gate is not None:
            return False
        if self._own and not self.columns.unusual:
            self._rejoin()
        behind = self.size != self.columns.size
        return not (behind or (moving and (self._own or self.columns.unusual)))

    def _rejoin(self) -> None:
        """Read attributes from the columns again, in which every value is a number now."""
        self._own = False
        for place, term in enumerate(self._plan.inputs.plain):
            source = self._attributes[self._plan.inputs.variables.index(term.name)]
            self.lists[place] = source

    def derive_again(self) -> None:
        """Compute all derived inputs anew: others have followed moves in its place."""
        if self._derived:
            self._lists_fresh = True
            self._pending = None
            self._derive(range(self.size))
            self.ready_lists()  # groups read the lists themselves

    @property
    def is_regular(self) -> bool:
        """Whether every slot has a present object that the kernels may be trusted with."""
        return not (self.absent or self.odd)

    def refresh(self, changed: Sequence[int]) -> None:
        """Follow the columns.

        Raises:
            InferenceError: a test about one object alone cannot be evaluated.
        """
        columns = self.columns
        if columns.size > self.size:
            self._grow(columns.size)
        if columns.unusual or self._own or self.odd or self._is_strict or self.gate is not None:
            changed = self._refresh_unusual(changed)
        elif self.absent or columns.has_holes:
            alive, present = columns.alive, self.present
            for slot in changed:
                if present[slot] != alive[slot]:
                    present[slot] = alive[slot]
                    self.absent += -1 if alive[slot] else 1
        if self._derived and changed:
            self._derive(changed)

    def ready_lists(self) -> list[list[Any]]:
        """Give the inputs as lists, one value a slot."""
        if not self._lists_fresh:
            for values, array in zip(self._derived, self._arrays, strict=True):
                values[:] = array[: self.size].tolist()
            self._lists_fresh = True
        return self.lists

    def ready_arrays(self) -> list[Numbers]:
        """Give the inputs as arrays: (size,) each."""
        plan, size = self._plan, self.size
        found = [
            self.columns.array(plan.sources[plan.inputs.variables.index(term.name)])[:size]
            for term in plan.inputs.plain
        ]
        if self._derived:
            if self._pending is None:
                self._arrays = [_spacious(values) for values in self._derived]
            else:
                for array, values in zip(self._arrays, self._derived, strict=True):
                    for slot in self._pending:
                        array[slot] = values[slot]
            self._pending = []
            found += [array[:size] for array in self._arrays]
        return found

    def regular(self) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Tell of each slot whether its object is present and not odd: (size,)."""
        found = np.frombuffer(self.present, dtype=np.bool_).copy()
        if self.odd:
            found[sorted(self.odd)] = False
        return found

    def copy(self, columns: Columns, gate: Gate | None) -> Side:
        """Give a side in the same state over a copy of its columns."""
        made = Side(self._plan, columns, gate)
        made._grow(self.size)
        self.ready_lists()
        made.present[:] = self.present
        made.absent = self.absent
        made.odd = set(self.odd)
        for mine, theirs in zip(self._derived, made._derived, strict=True):
            theirs[:] = mine
        if self._own:
            made._separate()
        return made

    def _grow(self, size: int) -> None:
        more = size - self.size
        self.ready_lists()
        self.present.extend(bytes(more))
        self.absent += more
        for values in self._derived:
            values.extend([0.0] * more)
        if self._own:
            for values in self.lists[: len(self._plan.inputs.plain)]:
                values.extend([0.0] * more)
        if self._pending is not None and self._arrays and size > len(self._arrays[0]):
            self._pending = None
        self.size = size

    def _set_present(self, slot: int, present: bool) -> None:  # noqa: FBT001 # what it sets
        if self.present[slot] != present:
            self.present[slot] = present
            self.absent += -1 if present else 1

    def _refresh_unusual(self, changed: Sequence[int]) -> list[int]:
        """Follow objects some of which may be odd or kept out by a test; give the ordinary ones."""
        plan, columns, gate = self._plan, self.columns, self.gate
        needed = [columns.column(name) for name in plan.attributes]
        if not self._own and (columns.unusual or self._is_strict):
            self._separate()
        ordinary = []
        for slot in changed:
            present: bool | None = bool(columns.alive[slot])
            present = present and all(column[slot] is not None for column in needed)
            if present and gate is not None:
                present = gate(slot)
            self._set_present(slot, present is not False)
            is_ordinary = all(is_plain(column[slot], plan.limit) for column in self._attributes)
            if present is None or (present and not is_ordinary):
                self.odd.add(slot)
            else:
                self.odd.discard(slot)
            if is_ordinary:
                ordinary.append(slot)
            if self._own:
                self._read(slot, is_ordinary=is_ordinary)
        return ordinary

    def _read(self, slot: int, *, is_ordinary: bool) -> None:
        """Bring the lists of its own up to date."""
        inputs = self._plan.inputs
        for place, term in enumerate(inputs.plain):
            source = self._attributes[inputs.variables.index(term.name)]
            self.lists[place][slot] = source[slot] if is_ordinary else 0.0
        if not is_ordinary:
            for values in self._derived:
                values[slot] = 0.0

    def _separate(self) -> None:
        """Read attributes from lists of its own from now on, in which every value is a number."""
        self._own = True
        variables, limit = self._plan.inputs.variables, self._plan.limit
        for place, term in enumerate(self._plan.inputs.plain):
            source = self._attributes[variables.index(term.name)][: self.size]
            self.lists[place] = [value if is_plain(value, limit) else 0.0 for value in source]

    def _derive(self, changed: Sequence[int]) -> None:
        """Compute the derived inputs of changed objects."""
        programs = self._plan.programs
        if len(changed) > _FEW and programs.derive_arrays is not None and self._derive_all():
            return
        assert programs.derive is not None, "there is something to derive"
        self.ready_lists()
        try:
            programs.derive(changed, self._attributes, self._derived)
        except (ArithmeticError, ValueError, TypeError):
            for slot in changed:
                self._derive_one(slot)
        if self._pending is not None:
            self._pending.extend(changed)
            if len(self._pending) > self.size:
                self._pending = None

    def _derive_one(self, slot: int) -> None:
        """Compute the derived inputs of one object, which is odd where there are none."""
        programs = self._plan.programs
        assert programs.derive is not None, "there is something to derive"
        try:
            programs.derive((slot,), self._attributes, self._derived)
        except (ArithmeticError, ValueError, TypeError):
            for values in self._derived:
                values[slot] = 0.0
            if self.present[slot]:
                self.odd.add(slot)

    def _derive_all(self) -> bool:
        """Compute the derived inputs of all objects with arrays; False where that will not do."""
        programs, columns = self._plan.programs, self.columns
        if self._own or self.odd or programs.derive_arrays is None:
            return False
        given = [columns.array(name)[: self.size] for name in self._plan.sources]
        with np.errstate(all="ignore"):
            found, doubt = programs.derive_arrays(*given)
        if doubt is not None and doubt.any():
            return False
        self._arrays = [np.array(each) for each in found]
        self._pending = []
        self._lists_fresh = False
        return True


def _spacious(values: list[float]) -> Numbers:
    """Give an array of these values with room for as many again."""
    array = np.zeros(2 * len(values) + 8)
    array[: len(values)] = values
    return array
