"""What a network is told: percepts and assertions, checked where they enter, and taken back whole.

Every write is noted with what was there before, until the cycle has succeeded.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import hypot, isfinite, isnan
from typing import Any, NamedTuple, TypeAlias

from icarus_lite.errors import FrameError
from icarus_lite.inference.facts import Lineages, check_values
from icarus_lite.inference.network.changes import Delta
from icarus_lite.inference.network.history import Kind, Writes, key_of
from icarus_lite.inference.network.kernels.columns import PLAIN
from icarus_lite.symbols import Belief, Percept, Value, is_number

Entry: TypeAlias = tuple[str, int, Any]
"""A fact that may be given: its predicate, the number of its arguments, and its key."""

_NUMERIC = {int, float}
_ABSENT: Any = object()

_Values: TypeAlias = Mapping[str, Sequence[Any]]
"""For each of some attributes one value an object."""


class Base:
    """Percepts and assertions.

    Args:
        lineages: Each percept type with all types that its percepts belong to, its own first.

    Attributes:
        percepts: The attributes of each percept, by type and name; a move changes them in place.
        asserted: The beliefs that are given, by kind and key.
        touched: The facts that the cycle has touched so far.
    """

    __slots__ = (
        "_before",
        "_journal",
        "_last",
        "_lineages",
        "_owners",
        "asserted",
        "percepts",
        "touched",
    )

    def __init__(self, lineages: Lineages) -> None:
        self._lineages = lineages
        self.percepts: dict[str, dict[Value, dict[str, Value]]] = {}
        self.asserted: dict[Kind, dict[Any, Belief]] = {}
        self.touched: dict[Entry, None] = {}
        self._owners: dict[tuple[str, Value], str] = {}
        self._journal: list[_Entry | _Columns] = []
        self._before: dict[tuple[Kind, Any], Belief | None] = {}
        # Of the last move of each type, as long as nothing else has been written: the names, the
        # attributes of these percepts, and the values that were set.
        self._last: dict[str, tuple[list[str], list[dict[str, Value]], _Values]] = {}

    def copy(self) -> Base:
        """Give the same again, to go its own way."""
        other = Base(self._lineages)
        other.percepts = {
            type_: {name: dict(attributes) for name, attributes in known.items()}
            for type_, known in self.percepts.items()
        }
        other._owners = dict(self._owners)
        other.asserted = {kind: dict(known) for kind, known in self.asserted.items()}
        return other

    def lineage(self, type_: str) -> Sequence[str]:
        """Give all types that percepts of a type belong to, its own first."""
        return self._lineages.get(type_, (type_,))

    # -- writing -------------------------------------------------------------------------------

    def take(self, delta: Delta) -> None:
        """Take in what has changed.

        Raises:
            FrameError: a percept or assertion is not what it may be; `undo` what was written.
        """
        if delta.gone or delta.percepts:
            self._last.clear()
        for type_, name in delta.gone:
            if name in self.percepts.get(type_, ()):
                self._write(self.percepts[type_], name, _ABSENT)
                for each in self.lineage(type_):
                    self._write(self._owners, (each, name), _ABSENT)
                    self.touched[each, 1, name] = None
        seen: set[tuple[str, str]] = set()
        for percept in delta.percepts:
            key = percept.type, percept.name
            if key in seen:
                raise _not_unique(percept.type, percept.name)
            seen.add(key)
            check_values(percept)
            known = self.percepts.setdefault(percept.type, {})
            self._write(known, percept.name, dict(percept.attributes))
            for each in self.lineage(percept.type):
                owner = self._owners.get((each, percept.name))
                if owner is None:
                    self._write(self._owners, (each, percept.name), percept.type)
                elif owner != percept.type:
                    raise _not_unique(each, percept.name)
                self.touched[each, 1, percept.name] = None
        self.give(delta.asserted, delta.withdrawn)

    def give(self, asserted: Iterable[Belief], withdrawn: Iterable[Belief]) -> None:
        """Take in assertions and withdrawals; what is both stays.

        Raises:
            FrameError: a number is not finite.
        """
        for belief in withdrawn:
            self._give((belief.predicate, len(belief.args)), key_of(belief.args), None)
        for belief in asserted:
            for value in belief.args:
                _check_value(f"an argument of {belief.predicate}", value)
            if belief.attributes:
                _check_attributes(str(belief), belief.attributes)
            self._give((belief.predicate, len(belief.args)), key_of(belief.args), belief)

    def _give(self, kind: Kind, key: Any, belief: Belief | None) -> None:
        known = self.asserted.setdefault(kind, {})
        old = known.get(key)
        if old is None and belief is None:
            return
        self._before.setdefault((kind, key), old)
        self._write(known, key, _ABSENT if belief is None else belief)
        self.touched[(*kind, key)] = None

    def move(
        self, type_: str, names: Sequence[str], columns: Mapping[str, Sequence[Value]]
    ) -> tuple[dict[str, tuple[Value, ...]], bool]:
        """Take in new values of some attributes of percepts that are there.

        Returns:
            The values, and whether all of them are plain numbers: see `PLAIN`.

        Raises:
            FrameError: an object is not known or named twice, a value is missing or not finite.
        """
        count = len(names)
        every: list[Any] = []
        lists = {}
        for attribute, given in columns.items():
            values = given if type(given) is tuple else _as_tuple(given)
            if len(values) != count:
                raise FrameError(f"{count} objects, but {len(values)} values of {attribute}")
            lists[attribute] = values
            every += values
        plain = _are_plain(every)
        if not plain:
            for attribute, values in lists.items():
                _check_values(attribute, names, values)
        last = self._last.get(type_)
        if last is not None and last[0] == names:  # the same objects move again, as they mostly do
            known, records, old = last
        else:
            known, records, old = [*names], self._records(type_, names), {}
        if old.keys() != lists.keys():
            old = {a: [record.get(a, _ABSENT) for record in records] for a in lists}
        for attribute, values in lists.items():
            for record, value in zip(records, values):  # noqa: B905 # strict costs a tenth of it
                record[attribute] = value
        self._journal.append(_Columns(records, old))
        self._last[type_] = known, records, lists
        return lists, plain

    def _records(self, type_: str, names: Sequence[str]) -> list[dict[str, Value]]:
        """Give the attributes of some percepts.

        Raises:
            FrameError: one is not there, or named twice.
        """
        known = self.percepts.get(type_, {})
        try:
            records = [known[name] for name in names]
        except KeyError as error:
            message = f"there is no percept of type {type_} named {error.args[0]} to be moved"
            raise FrameError(message) from None
        if len({*map(id, records)}) != len(records):
            raise FrameError(f"an object of type {type_} is moved twice in one cycle")
        return records

    def touch(self, type_: str, names: Iterable[str]) -> None:
        """Note that percepts have changed, under every type they belong to."""
        for each in self.lineage(type_):
            for name in names:
                self.touched[each, 1, name] = None

    def _write(self, where: dict[Any, Any], key: Any, value: Any) -> None:
        self._journal.append(_Entry(where, key, where.get(key, _ABSENT)))
        if value is _ABSENT:
            where.pop(key, None)
        else:
            where[key] = value

    def settle(self) -> Writes:
        """The cycle has succeeded: hand over what it has written over."""
        written, self._journal = self._journal, []
        self.touched.clear()
        self._before.clear()
        return written

    def undo(self) -> None:
        """Take back all that was written in this cycle."""
        self._last.clear()
        _replay(self._journal)
        self.settle()

    @contextmanager
    def undone(self) -> Iterator[None]:
        """Be, for a while, what it was before this cycle."""
        self._last.clear()
        again = _replay(self._journal)
        yield
        _replay(again)

    def before(self, cycles: Sequence[Writes]) -> Base:
        """Give a base of its own that is what this one was before some cycles.

        Args:
            cycles: What each of the last cycles has written over, the last one last.
        """
        self._last.clear()
        again = [_replay(written) for written in reversed(cycles)]
        found = self.copy()
        for written in reversed(again):
            _replay(written)
        return found

    # -- reading -------------------------------------------------------------------------------

    def perceived(self, entry: Entry) -> Mapping[str, Value] | None:
        """Give the attributes of a percept, or None if there is none."""
        predicate, arity, key = entry
        owner = self._owners.get((predicate, key)) if arity == 1 else None
        return None if owner is None else self.percepts[owner][key]

    def percept(self, type_: str, name: Value) -> Percept | None:
        """Give a percept by one of the types it belongs to, or None if there is none."""
        owner = self._owners.get((type_, name))
        return None if owner is None else Percept(owner, str(name), self.percepts[owner][name])

    def given(self, entry: Entry) -> Mapping[str, Value] | None:
        """Give the attributes of an assertion, or None if there is none."""
        predicate, arity, key = entry
        belief = self.asserted.get((predicate, arity), {}).get(key)
        return None if belief is None else belief.attributes

    def effective(self, entry: Entry) -> Mapping[str, Value] | None:
        """Give the attributes that count: perceived before asserted."""
        found = self.perceived(entry)
        return self.given(entry) if found is None else found

    def all(self) -> Iterator[Entry]:
        """Give every fact that is perceived or asserted, each once."""
        found: dict[Entry, None] = {(type_, 1, name): None for type_, name in self._owners}
        for (predicate, arity), known in self.asserted.items():
            found.update(((predicate, arity, key), None) for key in known)
        return iter(found)

    def assertions(self) -> Iterator[Belief]:
        """Give all assertions."""
        for known in self.asserted.values():
            yield from known.values()

    def changed_assertions(self) -> Iterator[tuple[Kind, Any, Belief | None, Belief | None]]:
        """Give each assertion that this cycle has touched: as it was before, and as it is."""
        for (kind, key), old in self._before.items():
            yield kind, key, old, self.asserted[kind].get(key)

    def difference(self, percepts: Iterable[Percept], asserted: Iterable[Belief]) -> Delta:
        """Find out what is different from a whole picture of now.

        Raises:
            FrameError: two percepts of one type share a name.
        """
        seen: dict[tuple[str, Value], None] = {}
        changed = []
        nothing: dict[Value, dict[str, Value]] = {}
        for percept in percepts:
            key = percept.type, percept.name
            if key in seen:
                raise _not_unique(*key)
            seen[key] = None
            if self.percepts.get(percept.type, nothing).get(percept.name) != percept.attributes:
                changed.append(percept)
        count = sum(map(len, self.percepts.values()))
        new = sum(p.name not in self.percepts.get(p.type, nothing) for p in changed)
        gone: list[tuple[str, str]] = []
        if count + new != len(seen):
            gone = [
                (type_, str(name))
                for type_, known in self.percepts.items()
                for name in known
                if (type_, name) not in seen
            ]
        given: dict[tuple[Kind, Any], Belief] = {}
        for belief in asserted:
            given.setdefault(((belief.predicate, len(belief.args)), key_of(belief.args)), belief)
        fresh = [
            belief
            for (kind, key), belief in given.items()
            if (old := self.asserted.get(kind, {}).get(key)) is None
            or old.attributes != belief.attributes
        ]
        withdrawn = [
            belief
            for kind, beliefs in self.asserted.items()
            for key, belief in beliefs.items()
            if (kind, key) not in given
        ]
        return Delta(tuple(changed), tuple(gone), tuple(fresh), tuple(withdrawn))


class _Entry(NamedTuple):
    """An entry of a dictionary, and what it was."""

    where: dict[Any, Any]
    key: Any
    old: Any

    @property
    def size(self) -> int:
        """How much it is, counted in changes of one value."""
        return 1 + len(self.old) if type(self.old) is dict else 1

    def undone(self) -> _Entry:
        """Put it back; give what puts it back again."""
        again = _Entry(self.where, self.key, self.where.get(self.key, _ABSENT))
        if self.old is _ABSENT:
            self.where.pop(self.key, None)
        else:
            self.where[self.key] = self.old
        return again


class _Columns(NamedTuple):
    """Some attributes of many objects, and what they were."""

    records: Sequence[dict[str, Value]]
    old: _Values

    @property
    def size(self) -> int:
        """How much it is, counted in changes of one value."""
        return len(self.old) * len(self.records)

    def undone(self) -> _Columns:
        """Put it back; give what puts it back again."""
        old = self.old
        now = {attribute: _exchange(self.records, attribute, old[attribute]) for attribute in old}
        return _Columns(self.records, now)


def _exchange(
    records: Sequence[dict[str, Value]], attribute: str, values: Sequence[Any]
) -> list[Any]:
    """Set an attribute of each object; give what it was."""
    old = [record.get(attribute, _ABSENT) for record in records]
    for record, value in zip(records, values, strict=True):
        record[attribute] = value
    if _ABSENT in values:
        for record in records:
            if record[attribute] is _ABSENT:
                del record[attribute]
    return old


def _replay(journal: Sequence[_Entry | _Columns]) -> list[_Entry | _Columns]:
    """Put everything back, the last write first; give the journal that puts it back again."""
    return [each.undone() for each in reversed(journal)]


def _as_tuple(values: Sequence[Value]) -> tuple[Value, ...]:
    """Give the values of a list or array as a tuple of Python's values."""
    return tuple(values.tolist() if hasattr(values, "tolist") else values)


def _are_plain(values: Sequence[Any]) -> bool:
    """Tell whether all values are numbers, none of them large: finite at any rate."""
    if not {*map(type, values)} <= _NUMERIC:
        return False
    try:
        # No number is larger than the root of the sum of all squares, which is found much faster
        # than the largest number; it is no number itself where one of them is none.
        if hypot(*values) <= PLAIN:
            return True
    except OverflowError:  # an integer beyond every float
        return False
    # Where one is no number at all, the smallest and the greatest may not tell, but the sum does.
    return not isnan(sum(values)) and bool(min(values) >= -PLAIN and max(values) <= PLAIN)


def _check_values(attribute: str, names: Sequence[str], values: Sequence[Value]) -> None:
    """See that all values of an attribute are values.

    Raises:
        FrameError: one is not.
    """
    if {*map(type, values)} <= _NUMERIC:
        try:
            if isfinite(sum(values)):  # type: ignore[arg-type] # numbers
                return
        except OverflowError:
            pass  # an integer beyond every float, or else a sum of them: looked at one by one
    for name, value in zip(names, values, strict=True):
        _check_value(f"attribute {attribute} of {name}", value)


def _not_unique(type_: str, name: Value) -> FrameError:
    return FrameError(f"2 percepts of type {type_} are named {name}; names are unique")


def _check_attributes(name: str, attributes: Mapping[str, Value]) -> None:
    for attribute, value in attributes.items():
        _check_value(f"attribute {attribute} of {name}", value)


def _check_value(what: str, value: object) -> None:
    if not isinstance(value, str) and not is_number(value):
        number = isinstance(value, int | float) and not isinstance(value, bool)
        fault = "not finite" if number else "neither a number nor a symbol"
        raise FrameError(f"{what} is {value!r}, {fault}")
