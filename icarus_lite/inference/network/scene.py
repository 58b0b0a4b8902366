"""The scene: the objects of every type, the views that see them, and the kernels that pair them.

Within an update, whatever was there and is so no longer is withdrawn first, while all that it was
joined with is still there; then kernels follow; then what is new is shown. So rules never see an
object half in its old place and half in its new one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from icarus_lite.inference.network import kernels
from icarus_lite.inference.network.design import Design
from icarus_lite.inference.network.generation.module import Module, is_filtered
from icarus_lite.inference.network.kernels.columns import Columns
from icarus_lite.inference.network.pair_stores import PairStore
from icarus_lite.inference.network.pairing import Pairing
from icarus_lite.inference.network.parts import Functions, Known, Move, Show
from icarus_lite.inference.network.relations import Pairs, View
from icarus_lite.inference.network.tables import Objects, Table
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value


@dataclass(frozen=True, slots=True)
class _Seen:
    """A view of a percept type: how an object is seen, and its rows."""

    attributes: frozenset[str]
    see: Callable[[int], Any]
    rows: dict[Any, Any]
    show: Callable[[Any, Any], None]
    withdraw: Callable[[Any, Any], None]


@dataclass(frozen=True, slots=True)
class _Side:
    """Objects that a kernel sees through a filter."""

    attributes: frozenset[str]
    see: Callable[[int], Any]
    objects: Objects

    def values(self, slot: int) -> Sequence[Value] | None:
        """Give the values of an object for the kernel, or None if it is filtered out."""
        found = self.see(slot)
        width = len(self.objects.columns.attributes)
        if found is None:
            return None
        return () if width == 0 else (found,) if width == 1 else found


@dataclass(frozen=True, slots=True)
class _Movement:
    """What depends on some attributes of a type: which views, sides and columns to look at."""

    table: Table
    identity: int
    attributes: tuple[str, ...]
    views: tuple[_Seen, ...]
    sides: tuple[_Side, ...]
    numeric: bool


class Turn:
    """One update under way.

    Attributes:
        shows: The rows to show once all has been withdrawn.
        changed: For each set of objects, by identity, the slots that kernels have to look at.
        sides: The objects to look at again through a filter; None for one that is gone.
        new: The objects to put in.
        gone: The objects to take out.
        known: For each set of objects, by identity, how many of its changed slots are of objects
            that were there before and still are.
        attributes: For each of these sets which attributes may have changed.
    """

    __slots__ = ("attributes", "changed", "gone", "known", "new", "shows", "sides")

    def __init__(self) -> None:
        self.shows: list[Show] = []
        self.changed: dict[int, list[int]] = {}
        self.sides: list[tuple[_Side, Value, int | None]] = []
        self.new: list[tuple[str, Value, Mapping[str, Value]]] = []
        self.gone: list[tuple[str, Value]] = []
        self.known: dict[int, int] = {}
        self.attributes: dict[int, tuple[str, ...]] = {}


class Scene:
    """The objects of one network.

    Args:
        design: The network's design.
        module: Its generated module.
        groups: The pair rules that may be followed together.

    Attributes:
        objects: For each percept type its objects with all their attributes.
        pairs: The pairs that kernels keep, by the identifier of their relation.
        tables: The columns of each type that the network looks at.
    """

    __slots__ = (
        "_filtered", "_is_leaving", "_movements", "_pairing", "_programs", "_sides", "_views",
        "objects", "pairs", "tables",
    )  # fmt: skip

    def __init__(
        self, design: Design, module: Module, groups: Sequence[kernels.GroupProgram] = ()
    ) -> None:
        self.objects: dict[str, dict[Value, Mapping[str, Value]]] = {}
        numeric: dict[str, dict[str, None]] = {}
        kernels = [r for r in design.relations if isinstance(r, Pairs)]
        for relation in kernels:
            for view in (relation.left, relation.right):
                if not is_filtered(view):
                    numeric.setdefault(view.type, {}).update(dict.fromkeys(view.cells))
        self.tables: dict[str, Table] = {}
        for type_, attributes in module.columns.items():
            own = tuple(numeric.get(type_, ()))
            self.tables[type_] = Table(own, [name for name in attributes if name not in own])
        self._filtered = {view: Objects(Columns(view.cells)) for view in module.sides}
        self.pairs = {
            relation.name: PairStore(
                relation.kernel, self._seen_by(relation.left), self._seen_by(relation.right)
            )
            for relation in kernels
        }
        self._views: dict[str, list[_Seen]] = {type_: [] for type_ in self.tables}
        self._sides: dict[str, list[_Side]] = {type_: [] for type_ in self.tables}
        self._movements: dict[tuple[str, tuple[str, ...]], _Movement | None] = {}
        self._is_leaving = False
        self._programs = groups

    def _seen_by(self, view: View) -> Objects:
        found = self._filtered.get(view)
        return self.tables[view.type].objects if found is None else found

    def connect(
        self,
        design: Design,
        module: Module,
        functions: Functions,
        rows: Mapping[str, dict[Any, Any]],
    ) -> None:
        """Connect it with the generated functions that are to be told."""
        for view in module.views:
            seen = _Seen(
                frozenset(view.attributes),
                functions[f"see_{view.name}"],
                rows[view.name],
                functions[f"show_{view.name}"],
                functions[f"withdraw_{view.name}"],
            )
            self._views[view.type].append(seen)
        for view, name in module.sides.items():
            side = _Side(frozenset(view.attributes), functions[f"see_{name}"], self._filtered[view])
            self._sides[view.type].append(side)
        groups = [(self.tables[each.type].objects, each) for each in self._programs]
        self._pairing = Pairing(design, functions, self.pairs, groups)

    # -- loading -------------------------------------------------------------------------------

    def load(self, objects: Iterable[tuple[str, Value, Mapping[str, Value]]]) -> None:
        """Take in all objects, telling no one.

        Raises:
            InferenceError: a test about one object cannot be evaluated.
        """
        for type_, name, attributes in objects:
            self.objects.setdefault(type_, {})[name] = attributes
            table = self.tables.get(type_)
            if table is None:
                continue
            slot = table.put(name, attributes)
            for side in self._sides[type_]:
                values = side.values(slot)
                if values is not None:
                    side.objects.put(name, values)
        for type_, table in self.tables.items():
            for view in self._views[type_]:
                for name, slot in table.objects.places.items():
                    value = view.see(slot)
                    if value is not None:
                        view.rows[name] = value

    def load_pairs(self, check: Callable[[int, int], None]) -> None:
        """Let the kernels follow from scratch.

        Args:
            check: Is called with the size of each relation and the clause it stands for.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        self._pairing.load(check)

    # -- following -----------------------------------------------------------------------------

    def move(self, move: Move, turn: Turn) -> None:
        """Write what has moved into the columns, and withdraw the rows that are so no longer."""
        names, moved = move.names, move.columns
        attributes = tuple(moved)
        for type_ in move.types:
            try:
                movement = self._movements[type_, attributes]
            except KeyError:
                movement = self._movement(type_, attributes)
            if movement is None:
                continue
            slots = movement.table.move(names, moved, plain=move.plain)
            if movement.numeric:
                identity = movement.identity
                turn.changed[identity] = slots
                turn.known[identity] = len(slots)
                turn.attributes[identity] = movement.attributes
            if movement.views:
                for name, slot in zip(names, slots, strict=True):
                    _see(movement.views, name, slot, turn.shows)
            for side in movement.sides:
                turn.sides += [(side, name, slot) for name, slot in zip(names, slots, strict=True)]

    def _movement(self, type_: str, attributes: tuple[str, ...]) -> _Movement | None:
        key = type_, attributes
        if key not in self._movements:
            table = self.tables.get(type_)
            touched = frozenset(attributes)
            made = None
            if table is not None:
                made = _Movement(
                    table,
                    id(table.objects),
                    attributes,
                    tuple(view for view in self._views[type_] if view.attributes & touched),
                    tuple(side for side in self._sides[type_] if side.attributes & touched),
                    not touched.isdisjoint(table.objects.columns.attributes),
                )
            self._movements[key] = made
        return self._movements[key]

    def change(self, objects: Iterable[tuple[str, Value, Known]], turn: Turn) -> None:
        """Withdraw the rows of objects that are gone, and those that are so no longer."""
        for type_, name, attributes in objects:
            known = self.objects.setdefault(type_, {})
            if attributes is None:
                known.pop(name, None)
            else:
                known[name] = attributes
            table = self.tables.get(type_)
            if table is None:
                continue
            if name not in table.objects.places:
                if attributes is not None:
                    turn.new.append((type_, name, attributes))
            elif attributes is None:
                for view in self._views[type_]:
                    old = view.rows.get(name)
                    if old is not None:
                        view.withdraw(name, old)
                turn.gone.append((type_, name))
            else:
                self._put(type_, name, attributes, turn)
                identity = id(table.objects)
                turn.known[identity] = turn.known.get(identity, 0) + 1
                turn.attributes[identity] = table.objects.columns.attributes

    def follow(
        self, turn: Turn, record: Callable[[Any], None], check: Callable[[int, int], None]
    ) -> None:
        """Let objects come and go, kernels follow, and then show all that is new.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        for type_, name in turn.gone:
            self._is_leaving = True
            objects = self.tables[type_].objects
            turn.changed.setdefault(id(objects), []).append(objects.drop(name))
            turn.sides += [(side, name, None) for side in self._sides[type_]]
        strangers = bool(turn.new or turn.sides)
        if strangers:
            for store in self.pairs.values():
                store.expect_strangers()
        for type_, name, attributes in turn.new:
            self._put(type_, name, attributes, turn)
        for side, name, slot in turn.sides:
            self._filter(side, name, slot, turn)
        if turn.changed:
            self._pairing.follow(turn.changed, turn.known, turn.attributes, record, check)
        if strangers:
            for store in self.pairs.values():
                store.expect_no_strangers()
        for show, key, value in turn.shows:
            show(key, value)

    def follow_alone(self) -> None:
        """Let no rules follow together from now on."""
        self._pairing.follow_alone()

    def settle(self) -> None:
        """Let the places of objects that have gone be used again."""
        if self._is_leaving:
            self._is_leaving = False
            for table in self.tables.values():
                table.objects.settle()
            for objects in self._filtered.values():
                objects.settle()

    def _put(self, type_: str, name: Value, attributes: Mapping[str, Value], turn: Turn) -> None:
        table = self.tables[type_]
        slot = table.put(name, attributes)
        turn.changed.setdefault(id(table.objects), []).append(slot)
        _see(self._views[type_], name, slot, turn.shows)
        turn.sides += [(side, name, slot) for side in self._sides[type_]]

    def _filter(self, side: _Side, name: Value, slot: int | None, turn: Turn) -> None:
        values = None if slot is None else side.values(slot)
        if values is not None:
            own = side.objects.put(name, values)
        elif name in side.objects.places:
            own = side.objects.drop(name)
            self._is_leaving = True
        else:
            return
        turn.changed.setdefault(id(side.objects), []).append(own)


def _see(views: Iterable[_Seen], name: Value, slot: int, shows: list[Show]) -> None:
    """Look at an object again; withdraw the rows it no longer has, note those it has now."""
    for view in views:
        now, old = view.see(slot), view.rows.get(name)
        if now == old:
            continue
        if old is not None:
            view.withdraw(name, old)
        if now is not None:
            shows.append((view.show, name, now))
