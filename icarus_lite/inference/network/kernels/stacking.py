"""Straight-line code over rows of numbers, in which operations that are alike become one call.

On short rows an operation on arrays costs little more than its call. So rows that meet the same
operation at the same depth are kept one after the other in memory, wherever what comes after them
allows it, and are computed by one call. It is written where each call leaves its result; only what
is given in the end is made anew each time.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from typing import TypeAlias

from icarus_lite.inference.network.kernels.array_source import NotVectorizableError
from icarus_lite.records import dataclass, field

_BINARY: dict[type[ast.AST], str] = {
    ast.Add: "add", ast.Sub: "subtract", ast.Mult: "multiply", ast.Div: "divide",
    ast.BitAnd: "bitwise_and", ast.BitOr: "bitwise_or",
    ast.Lt: "less", ast.LtE: "less_equal", ast.Gt: "greater", ast.GtE: "greater_equal",
    ast.Eq: "equal", ast.NotEq: "not_equal",
}  # fmt: skip
_COMPARISONS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.Eq, ast.NotEq)
_UNARY: dict[type[ast.AST], str] = {ast.USub: "negative", ast.Invert: "invert"}
_CALLS = {"abs": "absolute", "sqrt": "sqrt", "minimum": "minimum", "maximum": "maximum"}
_TRUTHS = frozenset(
    {"bitwise_and", "bitwise_or", "invert", *(_BINARY[each] for each in _COMPARISONS)}
)
_NAMED_OUT = frozenset({"maximum", "minimum"})
"""These want to be told by name where to leave their result, others are faster without."""

_FAR = 200
"""So much is looked at of what becomes of a result, written out, to decide on its place."""


@dataclass(frozen=True, slots=True)
class Store:
    """Rows one after the other in memory.

    Args:
        inputs: The parameters that are laid out here; empty where a call leaves its result.
        planes: The plane of each row, which decides how long it is.
        truths: Whether they are truth values.
    """

    inputs: tuple[str, ...]
    planes: tuple[int, ...]
    truths: bool


@dataclass(frozen=True, slots=True)
class Stacked:
    """Code over stores.

    Args:
        lines: The definition of `flat_over`.
        stores: What it works on.
        rows: The parameters of `flat_over`: the store of each, its first row there, and the one
            after its last.
    """

    lines: tuple[str, ...]
    stores: tuple[Store, ...]
    rows: tuple[tuple[int, int, int], ...]


@dataclass(frozen=True, slots=True)
class _Given:
    """A row that is a parameter."""

    name: str
    plane: int


@dataclass(eq=False, slots=True)
class _Node:
    """An operation on rows, and where its result is: see `Stacking`.

    Args:
        function: What numpy calls it.
        operands: What it reads; a string names a constant.
        plane: The plane of its rows.
        level: How many operations deep it is.
        text: The statement, or the part of one, that it stands for.
        name: How its result is named if it is given in the end; else empty.
        wanted: By what its result is read, which decides on its place among others.
        store: The store of its result, and -1 as long as it has none.
        place: The row there.
    """

    function: str
    operands: list[_Given | _Node | str]
    plane: int
    level: int
    text: str
    name: str = ""
    wanted: list[str] = field(default_factory=list)
    store: int = -1
    place: int = -1

    @property
    def kind(self) -> tuple[int, str, tuple[str, ...]]:
        """What has to be alike for one call: the depth, the operation, and constants."""
        constants = (each if isinstance(each, str) else "" for each in self.operands)
        return self.level, self.function, (self.name, *constants)

    def goes_on(self, before: _Node) -> bool:
        """Tell whether all it reads follows right after what another one reads."""
        for one, other in zip(before.operands, self.operands, strict=True):
            if isinstance(one, _Node) and isinstance(other, _Node):
                if one.store < 0 or (one.store, one.place + 1) != (other.store, other.place):
                    return False
            elif type(one) is not type(other):
                return False
        return True


_Operand: TypeAlias = _Given | _Node | str


class Stacking:
    """Reads statements and writes them stacked.

    Args:
        planes: The parameters of the statements, each with its plane.
        constants: See `ArrayWriter`.
    """

    def __init__(self, planes: Mapping[str, int], constants: dict[str, str]) -> None:
        self._constants = constants
        self._known: dict[str, _Operand] = {n: _Given(n, plane) for n, plane in planes.items()}
        self._known |= {name: name for name in constants.values()}
        self._nodes: list[_Node] = []
        self._stores: list[Store] = []
        self._rows: dict[tuple[int, int, int], str] = {}
        self._lines: list[str] = []

    def write(self, statements: Sequence[str], results: Sequence[Sequence[str]]) -> Stacked:
        """Write a function that does what the statements do.

        Args:
            statements: Assignments of operations on parameters, constants, and what was assigned.
            results: For each tuple that is to be given the names of its parts, or `None`.

        Raises:
            NotVectorizableError: there is something in them that is no operation on rows.
        """
        for statement in statements:
            (assign,) = ast.parse(statement).body
            if not (isinstance(assign, ast.Assign) and isinstance(assign.targets[0], ast.Name)):
                raise NotVectorizableError
            self._known[assign.targets[0].id] = self._read(assign.value, statement)
        given = [f"({', '.join(map(self._result, parts))})" for parts in results]
        for run in self._runs():
            self._call(run)
        lines = [
            "def flat_over(rows):",
            '    """Give what tests all pairs laid out one after the other, in these rows."""',
            f"    ({', '.join(self._rows.values())},) = rows",
            *(f"    {name} = np.{name}" for name in sorted({n.function for n in self._nodes})),
            "",
            "    def flat():",
            *(f"        {line}" for line in self._lines),
            f"        return ({', '.join(given)},)",
            "",
            "    return flat",
        ]
        return Stacked(tuple(lines), tuple(self._stores), tuple(self._rows))

    # -- reading -------------------------------------------------------------------------------

    def _read(self, tree: ast.expr, statement: str = "") -> _Operand:
        text = statement or ast.unparse(tree)
        match tree:
            case ast.Name(id=name) if name in self._known:
                found = self._known[name]
            case ast.Constant(value=int() | float() as value):
                found = self._constant(repr(float(value)))
            case ast.UnaryOp(op=ast.USub(), operand=ast.Constant(value=int() | float() as value)):
                found = self._constant(repr(-float(value)))
            case ast.UnaryOp(op=op, operand=inner) if type(op) in _UNARY:
                found = self._node(_UNARY[type(op)], [inner], text)
            case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
                found = self._node(_BINARY[type(op)], [left, right], text)
            case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in _BINARY:
                found = self._node(_BINARY[type(op)], [left, right], text)
            case ast.Call(func=ast.Attribute(attr=name), args=args) if name in _CALLS:
                found = self._node(_CALLS[name], args, text)
            case _:
                raise NotVectorizableError
        return found

    def _constant(self, text: str) -> str:
        name = self._constants.setdefault(text, f"number_{len(self._constants) + 1}")
        self._known[name] = name
        return name

    def _node(self, function: str, args: Sequence[ast.expr], text: str) -> _Node:
        operands = [self._read(each) for each in args]
        planes = [each.plane for each in operands if not isinstance(each, str)]
        if not planes:  # of constants alone
            raise NotVectorizableError
        level = 1 + max((o.level for o in operands if isinstance(o, _Node)), default=0)
        node = _Node(function, operands, planes[0], level, text)
        self._nodes.append(node)
        return node

    def _result(self, name: str) -> str:
        if name == "None":
            return name
        found = self._known[name]
        if not isinstance(found, _Node):
            raise NotVectorizableError
        found.name = found.name or name
        return found.name

    # -- writing -------------------------------------------------------------------------------

    def _runs(self) -> Iterator[list[_Node]]:
        """Give what is computed by one call each, every one as soon as its operands have a place.

        What is given in the end is computed by a call of its own.
        """
        alike: dict[tuple[int, str, tuple[str, ...]], list[_Node]] = {}
        for node in reversed(self._nodes):
            _, function, constants = node.kind
            alike.setdefault(node.kind, []).insert(0, node)
            wanted = f"{node.level} {function} {constants} {sorted(node.wanted)}"[:_FAR]
            for place, operand in enumerate(node.operands):
                if isinstance(operand, _Node):
                    operand.wanted.append(f"{wanted} {place}")
        for kind in sorted(alike):
            nodes = sorted(alike[kind], key=_order)
            run: list[_Node] = []
            for node in nodes:
                if run and not node.goes_on(run[-1]):
                    yield run
                    run = []
                run.append(node)
            yield run

    def _call(self, run: Sequence[_Node]) -> None:
        """Write one call."""
        first = run[0]
        words = [self._operand([n.operands[k] for n in run]) for k in range(len(first.operands))]
        self._lines += [f"# {node.text}" for node in run]
        if first.name:
            self._lines.append(f"{first.name} = {first.function}({', '.join(words)})")
            return
        store = self._store((), [node.plane for node in run], truths=first.function in _TRUTHS)
        for place, node in enumerate(run):
            node.store, node.place = store, place
        row = self._row(store, 0, len(run))
        words.append(f"out={row}" if first.function in _NAMED_OUT else row)
        self._lines.append(f"{first.function}({', '.join(words)})")

    def _operand(self, every: Sequence[_Operand]) -> str:
        """Name the rows that a call reads."""
        first, last = every[0], every[-1]
        if isinstance(first, str):
            return first
        if isinstance(first, _Node) and isinstance(last, _Node):
            return first.name or self._row(first.store, first.place, last.place + 1)
        given = [each for each in every if isinstance(each, _Given)]
        names = tuple(each.name for each in given)
        store = self._store(names, [each.plane for each in given], truths=False)
        return self._row(store, 0, len(names))

    def _store(self, inputs: tuple[str, ...], planes: Sequence[int], *, truths: bool) -> int:
        made = Store(inputs, tuple(planes), truths)
        if inputs and made in self._stores:
            return self._stores.index(made)
        self._stores.append(made)
        return len(self._stores) - 1

    def _row(self, store: int, begin: int, end: int) -> str:
        return self._rows.setdefault((store, begin, end), f"row_{len(self._rows) + 1}")


def _order(node: _Node) -> tuple[list[tuple[int, int]], list[str]]:
    """Say where a node stands among those that are alike: as its operands do, or as is wanted."""
    places = [(each.store, each.place) for each in node.operands if isinstance(each, _Node)]
    return places, sorted(node.wanted)
