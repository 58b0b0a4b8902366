"""A whole network as one Python module: what `CompiledDomain.source` shows and what runs."""

from __future__ import annotations

import hashlib
import linecache
import math
import sys
from collections.abc import Callable, Mapping
from types import CodeType
from typing import Any

from icarus_lite.inference.network.bodies import is_safe
from icarus_lite.inference.network.design import Design, Head, Keeping
from icarus_lite.inference.network.generation.expressions import equality_source, write_test
from icarus_lite.inference.network.generation.heads import cells_of, write_component, write_head
from icarus_lite.inference.network.generation.joins import index_name
from icarus_lite.inference.network.generation.naming import Names, identifier
from icarus_lite.inference.network.generation.rules import Wiring, write_rule
from icarus_lite.inference.network.generation.stores import title_of, write_store
from icarus_lite.inference.network.generation.writing import Lines
from icarus_lite.inference.network.parts import Functions, Parts
from icarus_lite.inference.network.relations import Pairs, Relation, View
from icarus_lite.language.syntax import variables_of
from icarus_lite.records import dataclass
from icarus_lite.symbols import is_number


@dataclass(frozen=True, slots=True)
class Module:
    """A generated module.

    Args:
        source: Its text.
        path: The name of the file that a traceback or profiler shows it under.
        code: Its code, which is run once for each network.
        wiring: What calls what; the plans of each clause are in it.
        views: Every view that objects are seen by, those of kernels with a filter included.
        columns: For each percept type the attributes that the network looks at.
        sides: The sides of kernels that leave objects out, with the identifier of each.
    """

    source: str
    path: str
    code: CodeType
    wiring: Wiring
    views: tuple[View, ...]
    columns: Mapping[str, tuple[str, ...]]
    sides: Mapping[View, str]

    def connect(self, parts: Parts) -> Functions:
        """Run it over the stores of one network; give its functions."""
        space: dict[str, Any] = {
            "parts": parts,
            "MOST": sys.float_info.max,
            "UNUSUAL": (ArithmeticError, ValueError, TypeError),
            "dist": math.dist,
            "sqrt": math.sqrt,
            "finite": _finite,
        }
        exec(self.code, space)  # noqa: S102 - it was written here, from a checked domain
        functions: Functions = space["functions"]
        return functions


def generate(design: Design) -> Module:
    """Generate the module of a design.

    Args:
        design: The design.
    """
    writer = _Module(design)
    source = writer.write()
    digest = hashlib.sha256(source.encode()).hexdigest()[:8]
    path = f"<network of {design.domain.name} {digest}>"
    code = compile(source, path, "exec")
    linecache.cache[path] = (len(source), None, source.splitlines(keepends=True), path)
    return Module(source, path, code, writer.wiring, writer.views, writer.columns, writer.sides)


def _finite(number: float) -> float:
    if is_number(number):
        return number
    raise ValueError(number)


class _Module:
    def __init__(self, design: Design) -> None:
        self._design = design
        self.wiring = Wiring()
        kernels = [r for r in design.relations if isinstance(r, Pairs)]
        sides = [view for pairs in kernels for view in (pairs.left, pairs.right)]
        filtered = [view for view in dict.fromkeys(sides) if is_filtered(view)]
        seen = [r for r in design.relations if isinstance(r, View)]
        self.views = tuple(seen)
        self.sides: dict[View, str] = {}
        for view in filtered:
            self.sides[view] = f"side_{len(self.sides) + 1}"
        columns: dict[str, dict[str, None]] = {}
        for view in (*seen, *sides):
            columns.setdefault(view.type, {}).update(dict.fromkeys(view.attributes))
        self.columns = {type_: tuple(names) for type_, names in columns.items()}
        names = Names()
        self._names_of = {t: names.fresh(f"column_{identifier(t)}") for t in self.columns}
        self._column_of = {
            (type_, attribute): names.fresh(f"column_{identifier(type_)}_{identifier(attribute)}")
            for type_, attributes in self.columns.items()
            for attribute in attributes
        }

    def write(self) -> str:
        """Write the module."""
        body = Lines()
        design = self._design
        for view in self.views:
            self._see(body, view, f"see_{view.name}")
        for view, name in self.sides.items():
            self._see(body, view, f"see_{name}")
        for head in design.heads:
            for rule in head.bodies:
                write_rule(body, design, head, rule, self.wiring)
        body.add(f"# {'=' * 76}", "# What is kept, and who is told of its changes.", "")
        for relation in self._stored():
            write_store(body, relation, self.wiring, title_of(relation))
        components: dict[int, list[Head]] = {}
        for head in design.heads:
            components.setdefault(head.component, []).append(head)
        for heads in components.values():
            self._heads(body, heads)
        self._cycle(body, components)
        return f"{self._opening()}{body}"

    def _stored(self) -> tuple[Relation, ...]:
        return self._design.relations

    def _opening(self) -> str:
        lines = Lines()
        design = self._design
        lines.add(
            f'"""The network of the domain {design.domain.name}, generated from its clauses.',
            "",
            "It is run once for each network, over the stores of that network (`parts`).",
            "A belief is a key: the bare argument where there is only one, else a tuple of them.",
            "`by` is 1 for a row that has come and -1 for one that goes.",
            '"""',
            "",
        )
        lines.add("tick, too_many, most = parts.tick, parts.too_many, parts.most")
        lines.add("record, stale, stage = parts.record, parts.stale, parts.stage")
        for relation in design.relations:
            name = relation.name
            if isinstance(relation, Pairs):
                lines.add(f"{name} = parts.pairs[{name!r}]")
                continue
            lines.add(f"{name} = parts.rows[{name!r}]")
        for name, indexes in self.wiring.indexes.items():
            for cells in indexes:
                index = index_name(name, cells)
                lines.add(f"{index} = parts.rows[{index!r}] = {{}}")
        for head in design.heads:
            name = head.facts.name
            if head.keeping is Keeping.RECURSIVE:
                lines.add(f"{name}_gained, {name}_lost, {name}_reached = {{}}, {{}}, []")
            elif head.keeping not in (Keeping.PAIRS, Keeping.RECOMPUTED):
                lines.add(f"{name}_changes = {{}}")
        for type_, attributes in self.columns.items():
            lines.add(f"{self._names_of[type_]} = parts.names[{type_!r}]")
            for attribute in attributes:
                column = self._column_of[type_, attribute]
                lines.add(f"{column} = parts.columns[{type_!r}, {attribute!r}]")
        lines.add(*(f"{name} = parts.asked[{name!r}]" for name in self.wiring.asked), "")
        return str(lines)

    def _see(self, lines: Lines, view: View, name: str) -> None:
        """Write how an object is seen by a view: its values, or None if it is not seen."""
        lines.add(f"# {title_of(view)}")
        tests = self._view_tests(lines, view, name)
        with lines.block(f"def {name}(slot):"):
            for attribute, value in view.constants:
                with lines.block(f"if {self._column_of[view.type, attribute]}[slot] != {value!r}:"):
                    lines.add("return None")
            cells: dict[str, str] = {"": "key"}
            if "" in dict(view.variables).values():
                lines.add(f"key = {self._names_of[view.type]}[slot]")
            constant = {attribute for attribute, _ in view.constants}
            for number, attribute in enumerate(view.attributes):
                if attribute in constant and attribute not in (*view.cells, *view.required):
                    continue
                cells[attribute] = f"cell_{number + 1}"
                lines.add(f"{cells[attribute]} = {self._column_of[view.type, attribute]}[slot]")
                with lines.block(f"if {cells[attribute]} is None:"):
                    lines.add("return None")
            for test in tests:
                with lines.block(f"if not {test(cells)}:"):
                    lines.add("return None")
            row = [cells[attribute] for attribute in view.cells]
            lines.add(f"return {_value(row)}")
        lines.add("")

    def _view_tests(
        self, lines: Lines, view: View, name: str
    ) -> list[Callable[[Mapping[str, str]], str]]:
        attribute_of = dict(view.variables)
        found: list[Callable[[Mapping[str, str]], str]] = []
        for number, call in enumerate(view.tests):
            order = tuple(dict.fromkeys(variables_of(call)))
            if is_safe(call):
                found.append(
                    lambda cells, call=call, order=order: (
                        "("  # type: ignore[misc] # bound now
                        + equality_source(call, {v: cells[attribute_of[v]] for v in order})
                        + ")"
                    )
                )
                continue
            own, ask = f"{name}_test_{number + 1}", f"ask_{name}_{number + 1}"
            self.wiring.asked[ask] = (call, order)
            names = {v: f"{identifier(v)}_" for v in order}
            if len(set(names.values())) < len(names):
                names = {v: f"cell_{i + 1}" for i, v in enumerate(order)}
            write_test(lines, own, call, names, ask, order)
            found.append(
                lambda cells, own=own, order=order: (  # type: ignore[misc] # bound now
                    f"{own}({', '.join(cells[attribute_of[v]] for v in order)})"
                )
            )
        return found

    def _heads(self, lines: Lines, heads: list[Head]) -> None:
        keeping = heads[0].keeping
        if keeping is Keeping.PAIRS:
            return
        if keeping is Keeping.RECURSIVE:
            write_component(lines, heads, self.wiring)
            return
        if keeping is Keeping.RECOMPUTED:
            number = heads[0].component
            parts = ", ".join(self._telling(head) for head in heads)
            lines.add(
                f"settle_component_{number}, load_component_{number} = "
                f"parts.recomputed({number}, ({parts},))",
                "",
            )
            return
        for head in heads:
            if head.keeping is Keeping.ATTRIBUTED:
                name = head.facts.name
                lines.add(f"def fill_{name}():")
                lines.indent()
                lines.add(*(f"{self.wiring.fills[body.number]}()" for body in head.bodies))
                lines.add("return")
                lines.indent(-1)
                lines.add(
                    f"settle_{name}, load_{name} = parts.attributed("
                    f"{head.number}, {name}_changes, fill_{name}, {self._telling(head)})",
                    "",
                )
            elif head.keeping is not Keeping.PAIRS:
                write_head(lines, head, self.wiring)

    def _telling(self, head: Head) -> str:
        """Write what keeps a concept's rows: for itself, and with each set of attributes."""
        telling = []
        for relation in (head.facts, *cells_of(self._design.relations, head)):
            n = relation.name
            telling.append(f"({relation.cells!r}, {n}, show_{n}, withdraw_{n}, insert_{n})")
        return f"[{', '.join(telling)}]"

    def _cycle(self, lines: Lines, components: Mapping[int, list[Head]]) -> None:
        loads: list[str] = []
        with lines.block("def cycle():"):
            for number, heads in components.items():
                keeping = heads[0].keeping
                if keeping is Keeping.RECURSIVE:
                    changed = " or ".join(
                        f"{h.facts.name}_gained or {h.facts.name}_lost" for h in heads
                    )
                    lines.add(f"if {changed}: settle_component_{number}()")
                    loads.append(f"load_component_{number}()")
                elif keeping is Keeping.RECOMPUTED:
                    lines.add(f"if stale[{number}]: settle_component_{number}()")
                    loads.append(f"load_component_{number}()")
                else:
                    for head in heads:
                        name = head.facts.name
                        if head.keeping is not Keeping.PAIRS:
                            lines.add(f"if {name}_changes: settle_{name}()")
                            loads.append(f"load_{name}()")
            lines.add("return")
        lines.add("")
        with lines.block("def load():"):
            lines.add(*loads, "return")
        lines.add("")
        self._return(lines)

    def _return(self, lines: Lines) -> None:
        tables: dict[str, list[str]] = {
            "show": [],
            "withdraw": [],
            "insert": [],
            "index": [],
            "see": [f"see_{view.name}" for view in self.views],
            "prove": [],
        }
        tables["see"] += [f"see_{name}" for name in self.sides.values()]
        for relation in self._stored():
            tables["show"].append(f"show_{relation.name}")
            tables["withdraw"].append(f"withdraw_{relation.name}")
            if not isinstance(relation, Pairs):
                tables["insert"].append(f"insert_{relation.name}")
                tables["index"].append(f"index_{relation.name}")
        for head in self._design.heads:
            for body in head.bodies:
                tables["prove"].append(f"prove_{head.facts.name}_{body.number + 1}")
        lines.add("functions = {'cycle': cycle, 'load': load}")
        for functions in tables.values():
            for function in functions:
                lines.add(f"functions[{function!r}] = {function}")
        for head in self._design.heads:
            if head.keeping is Keeping.ATTRIBUTED:
                name = f"{head.facts.name}_changes"
                lines.add(f"functions[{name!r}] = {name}")


def is_filtered(view: View) -> bool:
    """Tell whether a side of a kernel leaves out objects that have its attributes."""
    return bool(view.required or view.constants or view.tests)


def _value(row: list[str]) -> str:
    if not row:
        return "True"
    return row[0] if len(row) == 1 else f"({', '.join(row)})"
