"""Joins as Python source: nested loops that look up, check and go on.

A row that fails is left by `continue`, or by `return` where no loop is open yet, so that only loops
indent.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from icarus_lite.inference.network.bodies import Body, Literal, Negation, is_safe
from icarus_lite.inference.network.generation.expressions import equality_source, literal
from icarus_lite.inference.network.generation.naming import Names, identifier
from icarus_lite.inference.network.generation.writing import Lines
from icarus_lite.inference.network.ordering import Absent, Access, Ask, Find, Step, bound_cells
from icarus_lite.inference.network.relations import Pairs, Relation
from icarus_lite.language.syntax import Constant, Term, variables_of
from icarus_lite.records import dataclass, field

_DEEPEST = 14
"""Loops inside one another before the rest goes into a function of its own: Python allows 20."""


def index_name(relation: str, cells: Sequence[int]) -> str:
    """Give the identifier of the index of a relation, by its own, on some of its cells."""
    return f"{relation}_by_{'_'.join(str(cell + 1) for cell in cells)}"


def tuple_source(parts: Sequence[str]) -> str:
    """Write a key: bare where it is one cell, else a tuple."""
    if len(parts) == 1:
        return parts[0]
    return f"({', '.join(parts)})"


@dataclass(slots=True)
class Scope:
    """The identifiers of one clause.

    Args:
        body: The clause.
        variables: The identifier of each variable.
        tests: For each test that has a function, that function.
        parameters: For each such test its variables in the order of the parameters.
        indexes: The indexes that are needed, filled as joins ask for them.
    """

    body: Body
    variables: Mapping[str, str]
    tests: Mapping[int, str]
    parameters: Mapping[int, tuple[str, ...]]
    indexes: dict[str, dict[tuple[int, ...], None]]

    def of(self, term: Term) -> str:
        """Write a term."""
        return literal(term.value) if isinstance(term, Constant) else self.variables[term.name]


def variable_names(body: Body, relations: Sequence[Relation]) -> dict[str, str]:
    """Give each variable of a clause an identifier that no store has."""
    clause = body.clause
    names = Names(relation.name for relation in relations)
    found: dict[str, str] = {}
    atoms = (clause.head, *(c.atom for c in clause.elements))
    words = [v for atom in atoms for v in atom.variables]
    words += [bind.variable.name for bind in clause.binds]
    words += [v for test in clause.tests for v in variables_of(test)]
    for word in dict.fromkeys(words):
        found[word] = names.fresh(identifier(word))
    return found


@dataclass(slots=True)
class Join:
    """Writes one join into a function.

    Args:
        lines: Where to.
        scope: The identifiers of the clause.
        known: The variables that are bound; grows.
        loops: How many loops are open.
        lead: The literal whose row started the join, if any: rows of literals after it that are
            on the same relation must be other ones.
        on_loop: Lines for the beginning of every loop that contains another one.
        rest: How a function is called that goes on where Python allows no deeper loops.
    """

    lines: Lines
    scope: Scope
    known: set[str]
    lead: Literal | None = None
    on_loop: Sequence[str] = ()
    rest: str = "rest()"
    loops: int = 0
    _opened: int = 0
    _functions: list[int] = field(default_factory=list)

    @property
    def fail(self) -> str:
        """What leaves a row that does not fit."""
        return "continue" if self.loops else "return"

    @property
    def looped(self) -> bool:
        """Whether a loop was written."""
        return self._opened > 0

    def steps(self, steps: Sequence[Step]) -> None:
        """Write the steps; what is added to the lines afterwards is done for each match."""
        looping = [i for i, each in enumerate(steps) if _is_loop(each)]
        for number, step in enumerate(steps):
            if isinstance(step, Find):
                self._find(step)
                if looping and number in looping[:-1]:
                    self.lines.add(*self.on_loop)
            elif isinstance(step, Ask):
                self._ask(step)
            else:
                self._absent(step)

    def close(self) -> None:
        """End all loops."""
        while self._functions:
            depth = self._functions.pop()
            self.lines.indent(depth - self.lines.depth)
            self.lines.add(self.rest)
        self.lines.indent(-self._opened)

    def each(self, names: Sequence[str], rows: str) -> None:
        """Open a loop over rows, the cells of which are unpacked into these identifiers."""
        self._loop(f"for {', '.join(names)} in {rows}:")

    def bind_row(self, terms: Sequence[Term], names: Sequence[str]) -> None:
        """Bind the cells of a row, which are in these identifiers, and check what is known."""
        checks = []
        for term, name in zip(terms, names, strict=True):
            if isinstance(term, Constant):
                checks.append(f"{name} != {literal(term.value)}")
            elif term.name not in self.known:
                self.known.add(term.name)
            elif self.scope.variables[term.name] != name:
                checks.append(f"{name} != {self.scope.variables[term.name]}")
        if checks:
            self._unless(" or ".join(checks))

    def cell_names(self, terms: Sequence[Term]) -> list[str]:
        """Give the identifiers that a row's cells are unpacked into."""
        seen = set(self.known)
        names = []
        for cell, term in enumerate(terms):
            if isinstance(term, Constant) or term.name in seen:
                names.append(f"cell_{cell + 1}")
            else:
                names.append(self.scope.variables[term.name])
                seen.add(term.name)
        return names

    def _unless(self, condition: str) -> None:
        with self.lines.block(f"if {condition}:"):
            self.lines.add(self.fail)

    def _loop(self, opening: str) -> None:
        if self.loops >= _DEEPEST:
            self._functions.append(self.lines.depth)
            self.lines.add("def rest():")
            self.lines.indent()
            self.loops = 0
        self.lines.add(opening)
        self.lines.indent()
        self.loops += 1
        if not self._functions:
            self._opened += 1

    def _find(self, step: Find) -> None:
        relation, terms = step.literal.relation, step.literal.terms
        keys, values = terms[: relation.keys], terms[relation.keys :]
        key = tuple_source([self.scope.of(t) for t in keys]) if _all_known(keys, self.known) else ""
        if step.access is Access.MEMBER:
            if isinstance(relation, Pairs):
                a, b = (self.scope.of(t) for t in keys)
                self._unless(f"not {relation.name}.holds({a}, {b})")
            else:
                self._unless(f"{key} not in {relation.name}")
        elif step.access is Access.GET:
            names = self.cell_names(values)
            row = names[0] if len(names) == 1 else "row"
            self.lines.add(f"{row} = {relation.name}.get({key})")
            self._unless(f"{row} is None")
            if len(names) > 1:
                self.lines.add(f"{', '.join(names)} = row")
            self.bind_row(values, names)
        elif step.access is Access.INDEX:
            self._index(step)
        else:
            names = self.cell_names(terms)
            unpacked = ", ".join(names[: relation.keys])
            if isinstance(relation, Pairs):
                self._loop(f"for {unpacked} in {relation.name}.pairs():")
            elif values:
                if relation.keys > 1:
                    unpacked = f"({unpacked})"
                of_value = ", ".join(names[relation.keys :])
                if len(values) > 1:
                    of_value = f"({of_value})"
                self._loop(f"for {unpacked}, {of_value} in {relation.name}.items():")
            else:
                self._loop(f"for {unpacked} in {relation.name}:")
            self.bind_row(terms, names)
        self._set_apart(step)

    def _index(self, step: Find) -> None:
        relation, terms = step.literal.relation, step.literal.terms
        given = [self.scope.of(terms[cell]) for cell in step.bound]
        open_terms = [t for cell, t in enumerate(terms) if cell not in step.bound]
        names = self.cell_names(open_terms)
        if isinstance(relation, Pairs):
            side = "of_left" if step.bound == (0,) else "of_right"
            self._loop(f"for {names[0]} in {relation.name}.{side}({given[0]}):")
        else:
            self.scope.indexes.setdefault(relation.name, {})[step.bound] = None
            index = index_name(relation.name, step.bound)
            self._loop(f"for {', '.join(names)} in {index}.get({tuple_source(given)}, ()):")
        self.bind_row(open_terms, names)

    def _set_apart(self, step: Find) -> None:
        """Skip the very row that started the join where an earlier literal stands for it."""
        lead, mine = self.lead, step.literal
        if lead is None or mine.relation != lead.relation:
            return
        literals = self.scope.body.literals
        if _place(literals, mine) > _place(literals, lead):
            keys = mine.relation.keys
            own = tuple_source([self.scope.of(t) for t in mine.terms[:keys]])
            first = tuple_source([self.scope.of(t) for t in lead.terms[:keys]])
            self._unless("True" if own == first else f"{own} == {first}")

    def _ask(self, step: Ask) -> None:
        call = step.test.call
        if is_safe(call) and all(v in self.known for v in variables_of(call)):
            self._unless(f"not ({equality_source(call, self.scope.variables)})")
            return
        number = self.scope.body.tests.index(step.test)
        given = ", ".join(self.scope.variables[v] for v in self.scope.parameters[number])
        self._unless(f"not {self.scope.tests[number]}({given})")

    def _absent(self, step: Absent) -> None:
        self._unless(self.denied(step.negation))

    def denied(self, negation: Negation) -> str:
        """Write the condition that some row matches a negated pattern."""
        relation, terms = negation.relation, negation.terms
        if _all_known(terms[: relation.keys], self.known):
            return self._denied_by_key(relation, terms)
        bound = bound_cells(terms, self.known)
        names = [f"cell_{cell + 1}" for cell in range(len(terms))]
        open_cells = [cell for cell in range(len(terms)) if cell not in bound]
        equal = " and ".join(_agreements(terms, names, 0, self.scope, self.known, only=open_cells))
        if bound:
            self.scope.indexes.setdefault(relation.name, {})[bound] = None
            index = index_name(relation.name, bound)
            key = tuple_source([self.scope.of(terms[cell]) for cell in bound])
            opened = ", ".join(names[cell] for cell in open_cells)
            if equal:
                return f"any({equal} for {opened} in {index}.get({key}, ()))"
            return f"{key} in {index}"
        return f"any({equal} for {_items(relation, names)})" if equal else relation.name

    def _denied_by_key(self, relation: Relation, terms: Sequence[Term]) -> str:
        """Write that the one row with a known key matches a negated pattern."""
        keys = [self.scope.of(term) for term in terms[: relation.keys]]
        if isinstance(relation, Pairs):
            return f"{relation.name}.holds({', '.join(keys)})"
        key = tuple_source(keys)
        if not any(_must_equal(terms, self.known)[relation.keys :]):
            return f"{key} in {relation.name}"
        names = [f"cell_{cell + 1}" for cell in range(relation.keys, len(terms))]
        equal = " and ".join(_agreements(terms, names, relation.keys, self.scope, self.known))
        row = "(row,)" if relation.values == 1 else "row"
        comma = "," if len(names) == 1 else ""
        inner = f"for {', '.join(names)}{comma} in ({row},)"
        return f"(row := {relation.name}.get({key})) is not None and any({equal} {inner})"


def _items(relation: Relation, names: Sequence[str]) -> str:
    """Write a loop over all rows of a relation, for a generator expression."""
    of_key, of_value = ", ".join(names[: relation.keys]), ", ".join(names[relation.keys :])
    if not relation.values:
        return f"{of_key} in {relation.name}"
    if relation.keys > 1:
        of_key = f"({of_key})"
    if relation.values > 1:
        of_value = f"({of_value})"
    return f"{of_key}, {of_value} in {relation.name}.items()"


def _is_loop(step: Step) -> bool:
    return isinstance(step, Find) and step.access in (Access.INDEX, Access.SCAN)


def _place(literals: Sequence[Literal], wanted: Literal) -> int:
    return next(i for i, each in enumerate(literals) if each is wanted)


def _all_known(terms: Sequence[Term], known: set[str]) -> bool:
    return len(bound_cells(terms, known)) == len(terms)


def _must_equal(terms: Sequence[Term], known: set[str]) -> list[bool]:
    """Tell of each cell whether it has to equal something: known, or an earlier cell."""
    seen = set(known)
    found = []
    for term in terms:
        found.append(isinstance(term, Constant) or term.name in seen)
        if not isinstance(term, Constant):
            seen.add(term.name)
    return found


def _agreements(
    terms: Sequence[Term],
    names: Sequence[str],
    start: int,
    scope: Scope,
    known: set[str],
    only: Sequence[int] | None = None,
) -> list[str]:
    """Write what the cells from `start` on must equal; `names` are those of these cells."""
    first: dict[str, str] = {}
    found = []
    for cell in range(start, len(terms)):
        if only is not None and cell not in only:
            continue
        term, name = terms[cell], names[cell - start]
        if isinstance(term, Constant):
            found.append(f"{name} == {literal(term.value)}")
        elif term.name in known:
            found.append(f"{name} == {scope.variables[term.name]}")
        elif term.name in first:
            found.append(f"{name} == {first[term.name]}")
        else:
            first[term.name] = name
    return found
