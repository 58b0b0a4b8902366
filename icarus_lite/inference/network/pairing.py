"""The kernels of a scene: each follows its objects in turn, and tells what it gains and loses.

Kernels that see the same objects follow together as long as nothing is out of the ordinary.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from icarus_lite.inference.network import kernels
from icarus_lite.inference.network.design import Design
from icarus_lite.inference.network.pair_stores import NamedPair, PairStore
from icarus_lite.inference.network.parts import Functions
from icarus_lite.inference.network.relations import Pairs
from icarus_lite.inference.network.tables import Objects
from icarus_lite.records import dataclass

if TYPE_CHECKING:
    from icarus_lite.inference.network.kernels.group import Found

Changed: TypeAlias = Mapping[int, list[int]]
"""For each set of objects, by identity, slots that kernels have to look at."""


@dataclass(frozen=True, slots=True)
class _Kernel:
    """Pairs with whom to tell; `number` that of the concept whose beliefs they are, if any."""

    store: PairStore
    show: Callable[[Sequence[NamedPair]], None]
    withdraw: Callable[[Sequence[NamedPair]], None]
    number: int | None
    clause: int
    left: int
    right: int


@dataclass(frozen=True, slots=True)
class _Group:
    """Kernels that are followed together: for each of all kernels its number in it, if any.

    The last entry of each says whether it is an order of keys.
    """

    group: kernels.PairGroup
    kernels: Sequence[tuple[_Kernel, int | None, bool]]


class Pairing:
    """All kernels of a network.

    Args:
        design: The network's design.
        functions: The generated functions that are to be told.
        pairs: The pairs that kernels keep, by the identifier of their relation.
        groups: The rules that may be followed together, and the objects that they see.
    """

    __slots__ = ("_followed", "_groups", "_kernels", "_paired")

    def __init__(
        self,
        design: Design,
        functions: Functions,
        pairs: Mapping[str, PairStore],
        groups: Iterable[tuple[Objects, kernels.GroupProgram]],
    ) -> None:
        self._kernels: list[_Kernel] = []
        self._groups: dict[int, _Group] = {}
        self._followed: _Group | None = None  # the last one: only it may be armed
        self._paired = frozenset(id(o) for s in pairs.values() for o in (s.left, s.right))
        numbers = {head.relation.name: head.number for head in design.heads}
        clauses = {
            literal.relation.name: body.number
            for body in reversed(design.bodies)
            for literal in body.literals
        }
        for relation in design.relations:
            if isinstance(relation, Pairs):
                number, clause = numbers.get(relation.name), clauses[relation.name]
                self._kernels.append(
                    _kernel(pairs[relation.name], relation, number, clause, functions)
                )
        for objects, program in groups:
            places = {member.name: n for n, member in enumerate(program.members)}
            relations = [pairs[name].relation for name in places]
            group = kernels.PairGroup(program, relations, objects.columns)  # type: ignore[arg-type] # of these two kinds
            own = [
                (kernel, places.get(name), isinstance(kernel.store.relation, kernels.OrderRelation))
                for name, kernel in zip(pairs, self._kernels, strict=True)
            ]
            self._groups[id(objects)] = _Group(group, own)

    def load(self, check: Callable[[int, int], None]) -> None:
        """Let the kernels follow from scratch: see `Scene.load_pairs`."""
        for kernel in self._kernels:
            kernel.store.load()
            check(len(kernel.store), kernel.clause)

    def follow_alone(self) -> None:
        """Let no rules follow together from now on."""
        for each in self._groups.values():
            each.group.disarm()
        self._groups.clear()

    def follow(
        self,
        changed: Changed,
        known: Mapping[int, int],
        attributes: Mapping[int, tuple[str, ...]],
        record: Callable[[Any], None],
        check: Callable[[int, int], None],
    ) -> None:
        """Let all kernels follow, one after the other, each telling what it gains and loses.

        Args:
            changed: For each set of objects, by identity, the slots to look at.
            known: Of how many of these the objects were there before and still are.
            attributes: For each set of objects which attributes may have changed.
            record: Is told of the changes of a concept.
            check: Is called with the size of a relation and the clause it stands for.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        moving = self._moving(changed, known) if known else None
        if moving is not None and moving in self._groups:
            together = self._groups[moving]
            if together is not self._followed:
                self._disarm_others(together)
                self._followed = together
            found = together.group.follow(changed[moving], attributes[moving])
            if found is not None:
                _follow_together(together, found, moving, changed[moving], record, check)
                return
        for each in self._groups.values():
            each.group.disarm()
        nothing: list[int] = []
        for kernel in self._kernels:
            left = changed.get(kernel.left, nothing)
            right = changed.get(kernel.right, nothing)
            if left or right:
                added, removed = kernel.store.update(left, right)
                if added or removed:
                    _tell(kernel, added, removed, record, check)

    def _moving(self, changed: Changed, known: Mapping[int, int]) -> int | None:
        """Give the one set of objects that kernels have to look at, if none came and none went."""
        paired, moving = self._paired, None
        for identity in changed:
            if identity in paired:
                if moving is not None:
                    return None
                moving = identity
        if moving is None or known.get(moving) != len(changed[moving]):
            return None
        return moving

    def _disarm_others(self, together: _Group) -> None:
        """Let the other groups know that objects move that rules over two types see as well."""
        for other in self._groups.values():
            if other is not together:
                other.group.disarm()


def _kernel(
    store: PairStore, relation: Pairs, number: int | None, clause: int, functions: Functions
) -> _Kernel:
    return _Kernel(
        store,
        functions[f"show_{relation.name}"],
        functions[f"withdraw_{relation.name}"],
        number,
        clause,
        id(store.left),
        id(store.right),
    )


def _follow_together(
    together: _Group,
    found: Found,
    moving: int,
    slots: Sequence[int],
    record: Callable[[Any], None],
    check: Callable[[int, int], None],
) -> None:
    """Let relations take over what their group has found, in the order of all kernels."""
    for kernel, number, is_order in together.kernels:
        if number is None:
            left = slots if kernel.left == moving else ()
            right = slots if kernel.right == moving else ()
            if not left and not right:
                continue
            added, removed = kernel.store.update(left, right)
        elif is_order:
            added, removed = kernel.store.named(together.group.order(number))
        elif number in found:
            added, removed = kernel.store.named(together.group.matrix(number, found[number]))
        else:
            continue
        if added or removed:
            _tell(kernel, added, removed, record, check)


def _tell(
    kernel: _Kernel,
    added: Sequence[NamedPair],
    removed: Sequence[NamedPair],
    record: Callable[[Any], None],
    check: Callable[[int, int], None],
) -> None:
    if removed:
        kernel.withdraw(removed)
    if added:
        kernel.show(added)
    if kernel.number is not None:
        record((kernel.number, added, removed, ()))
    if added:
        check(len(kernel.store.relation), kernel.clause)
