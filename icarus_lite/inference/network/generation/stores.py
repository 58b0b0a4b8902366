"""One relation as Python source: its rows and indexes kept, and its changes told to the rules.

`show` is called with a row that has come to be, `withdraw` with one that is no longer. What denies
is asked while the row is not there, what joins while it is: so that a clause which looks at the
same relation twice counts each derivation once. Of pairs that a kernel keeps both are told of all
rows together.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference.network.generation.joins import index_name, tuple_source
from icarus_lite.inference.network.generation.rules import Wiring
from icarus_lite.inference.network.generation.writing import Lines
from icarus_lite.inference.network.relations import Facts, Pairs, Relation


def write_store(lines: Lines, relation: Relation, wiring: Wiring, title: str) -> None:
    """Write the functions of a relation.

    Args:
        lines: Where to.
        relation: The relation.
        wiring: The functions to tell, and the indexes to keep.
        title: What it holds, as a comment.
    """
    _Store(lines, relation, wiring).write(title)


class _Store:
    def __init__(self, lines: Lines, relation: Relation, wiring: Wiring) -> None:
        self._lines, self._relation, self._name = lines, relation, relation.name
        self._present = wiring.present.get(relation.name, [])
        self._absent = wiring.absent.get(relation.name, [])
        self._indexes = list(wiring.indexes.get(relation.name, ()))
        count = relation.keys + relation.values
        self._cells = [f"cell_{cell + 1}" for cell in range(count)]

    def write(self, title: str) -> None:
        self._lines.add(f"# {title}")
        if isinstance(self._relation, Pairs):
            self._pairs()
            return
        self._show()
        self._withdraw()
        self._insert()
        self._delete()
        self._index()

    def _pairs(self) -> None:
        """A kernel keeps the pairs; there is nothing to do but to tell."""
        for word, first, then, by in (
            ("show", self._absent, self._present, ("-1", "1")),
            ("withdraw", self._present, self._absent, ("-1", "1")),
        ):
            with self._lines.block(f"def {word}_{self._name}(pairs):"):
                self._lines.add(*(f"{function}(pairs, {by[0]})" for function in first))
                self._lines.add(*(f"{function}(pairs, {by[1]})" for function in then))
                self._lines.add("return")
        self._lines.add("")

    def _calls(self, functions: Sequence[str], by: str) -> list[str]:
        return [f"{function}({', '.join([*self._cells, by])})" for function in functions]

    def _unpack(self, *, values: bool, force: bool = False) -> None:
        """Take key and value apart, if anything needs the cells."""
        if not (force or self._present or self._absent or self._indexes):
            return
        keys = self._relation.keys
        if keys > 1:
            self._lines.add(f"{', '.join(self._cells[:keys])} = key")
        elif keys == 1:
            self._lines.add("cell_1 = key")
        if values and self._relation.values > 1:
            self._lines.add(f"{', '.join(self._cells[keys:])} = value")
        elif values and self._relation.values == 1:
            self._lines.add(f"{self._cells[keys]} = value")

    def _add(self) -> None:
        self._lines.add(f"{self._name}[key] = value")
        for cells in self._indexes:
            index, key, rest = self._index_parts(cells)
            self._lines.add(f"{index}.setdefault({key}, {{}})[{rest}] = None")

    def _take(self) -> None:
        self._lines.add(f"del {self._name}[key]")
        for cells in self._indexes:
            index, key, rest = self._index_parts(cells)
            self._lines.add(f"bucket = {index}[{key}]", f"del bucket[{rest}]")
            with self._lines.block("if not bucket:"):
                self._lines.add(f"del {index}[{key}]")

    def _index_parts(self, cells: tuple[int, ...]) -> tuple[str, str, str]:
        key = tuple_source([self._cells[cell] for cell in cells])
        others = [name for cell, name in enumerate(self._cells) if cell not in cells]
        return index_name(self._name, cells), key, tuple_source(others)

    def _show(self) -> None:
        with self._lines.block(f"def show_{self._name}(key, value):"):
            self._unpack(values=True)
            self._lines.add(*self._calls(self._absent, "-1"))
            self._add()
            self._lines.add(*self._calls(self._present, "1"))
        self._lines.add("")

    def _withdraw(self) -> None:
        with self._lines.block(f"def withdraw_{self._name}(key, value):"):
            self._unpack(values=True)
            self._lines.add(*self._calls(self._present, "-1"))
            self._take()
            self._lines.add(*self._calls(self._absent, "1"))
        self._lines.add("")

    def _insert(self) -> None:
        with self._lines.block(f"def insert_{self._name}(key, value):"):
            if self._indexes:
                self._unpack(values=True)
            self._add()
        self._lines.add("")

    def _delete(self) -> None:
        with self._lines.block(f"def delete_{self._name}(key, value):"):
            if self._indexes:
                self._unpack(values=True)
            self._take()
        self._lines.add("")

    def _index(self) -> None:
        with self._lines.block(f"def index_{self._name}():"):
            if not self._indexes:
                self._lines.add("return")
            else:
                with self._lines.block(f"for key, value in {self._name}.items():"):
                    self._unpack(values=True)
                    for cells in self._indexes:
                        index, key, rest = self._index_parts(cells)
                        self._lines.add(f"{index}.setdefault({key}, {{}})[{rest}] = None")
        self._lines.add("")


def title_of(relation: Relation) -> str:
    """Say what a relation holds, in words."""
    if isinstance(relation, Facts):
        words = "".join(f" ^{name}" for name in relation.cells)
        return f"The beliefs ({relation.predicate}{' ?' * relation.arity}{words})."
    if isinstance(relation, Pairs):
        tests = " ".join(map(str, relation.tests))
        return f"Pairs of {relation.left.type} and {relation.right.type} with {tests}."
    words = "".join(f" ^{name}" for name in relation.cells)
    words += "".join(f" ^{name}" for name in relation.required)
    words += "".join(f" ^{name} {value}" for name, value in relation.constants)
    tests = f" with {' '.join(map(str, relation.tests))}" if relation.tests else ""
    return f"Objects seen as ({relation.type} ?{words}){tests}."
