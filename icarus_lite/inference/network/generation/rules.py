"""One clause as Python source: what it concludes when a row of its body comes or goes.

For each condition there is a function that is called with a row of it, `by` 1 when the row has
appeared and -1 when it goes, and joins the others. Where a kernel keeps the rows it is called with
all of them that have appeared, or that go, at once. Two more functions join the whole: one to load
a network that believes nothing yet, one to find every derivation of a given belief.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference.network.bodies import Body, Literal, Negation, is_safe
from icarus_lite.inference.network.design import Design, Head, Keeping, place_of
from icarus_lite.inference.network.generation.expressions import literal, write_test
from icarus_lite.inference.network.generation.joins import (
    Join,
    Scope,
    tuple_source,
    variable_names,
)
from icarus_lite.inference.network.generation.writing import Lines
from icarus_lite.inference.network.ordering import Step, arrange
from icarus_lite.inference.network.relations import Facts, Pairs, Relation
from icarus_lite.language.syntax import Expression, Term, Variable, variables_of
from icarus_lite.records import dataclass, field


@dataclass(slots=True)
class Wiring:
    """Which functions are to be called when a row comes or goes, and what else is needed.

    Args:
        present: For each relation, by identifier, the functions to call while a row is there.
        absent: Likewise those to call while a row is not there: it is denied somewhere.
        indexes: For each relation the cells of each index that joins look rows up in.
        asked: For each function that evaluates by the language's own rules, the expression and
            the variables in the order of its row.
        proofs: For each clause the variables in the order in which its proofs give them.
        fills: For each clause that is joined to load the network, that function.
        grown: For each recursive concept the functions that give what rests on a belief of it.
        plans: For each clause its joins: `all` from scratch, `proof` with the head bound, and for
            each literal or negation, by number, the one led by it.
    """

    present: dict[str, list[str]] = field(default_factory=dict)
    absent: dict[str, list[str]] = field(default_factory=dict)
    indexes: dict[str, dict[tuple[int, ...], None]] = field(default_factory=dict)
    asked: dict[str, tuple[Expression, tuple[str, ...]]] = field(default_factory=dict)
    proofs: dict[int, tuple[str, ...]] = field(default_factory=dict)
    fills: dict[int, str] = field(default_factory=dict)
    grown: dict[str, list[str]] = field(default_factory=dict)
    plans: dict[int, dict[str, tuple[Step, ...]]] = field(default_factory=dict)


def write_rule(lines: Lines, design: Design, head: Head, body: Body, wiring: Wiring) -> None:
    """Write all functions of one clause, under its text."""
    _Rule(lines, design, head, body, wiring).write()


class _Rule:
    def __init__(
        self, lines: Lines, design: Design, head: Head, body: Body, wiring: Wiring
    ) -> None:
        self._lines, self._design, self._wiring = lines, design, wiring
        self._head, self._body = head, body
        self._stem = f"{head.facts.name}_{body.number + 1}"
        variables = variable_names(body, design.relations)
        self._scope = Scope(body, variables, {}, {}, wiring.indexes)
        own = {each.facts for each in design.heads if each.component == head.component}
        self._own: frozenset[Relation] = frozenset(own)
        wiring.plans[body.number] = {}

    def write(self) -> None:
        """Write everything."""
        self._title()
        if self._head.keeping is Keeping.RECOMPUTED:
            self._tests(needed_binds=self._binds_in_key())
            self._stale()
            self._plan_all()
        else:
            self._tests(needed_binds=True)
            if self._head.keeping is not Keeping.PAIRS:
                for number, each in enumerate(self._body.literals):
                    self._present(number, each)
                for number, negation in enumerate(self._body.negations):
                    self._absent(number, negation)
                self._fill()
            self._plan_all()
        self._prove()

    def _plan_all(self) -> None:
        """Note how the clause is joined from scratch, for those who want to see it."""
        steps = arrange(self._body, self._design.sizes)
        self._wiring.plans[self._body.number]["all"] = steps

    def _title(self) -> None:
        clause = self._body.clause
        self._lines.add(f"# {'-' * 76}", f"# {place_of(clause, self._design.domain)}")
        self._lines.add(f"# ({clause.head}")
        if clause.elements:
            words = " ".join(map(str, clause.elements))
            self._lines.add(f"#  :elements ({words})")
        if clause.tests:
            self._lines.add(f"#  :tests ({' '.join(map(str, clause.tests))})")
        if clause.binds:
            words = " ".join(f"({bind.variable} {bind.expression})" for bind in clause.binds)
            self._lines.add(f"#  :binds ({words})")
        self._lines.add("# )")

    def _tests(self, *, needed_binds: bool) -> None:
        """Write a function for each test that can fail, and name those that compute binds."""
        bound = {v for e in self._body.literals for t in e.terms for v in variables_of(t)}
        for number, test in enumerate(self._body.tests):
            used = tuple(dict.fromkeys(variables_of(test.call)))
            if is_safe(test.call) and bound.issuperset(used):
                continue
            order = tuple(v for v in used if v in bound)
            name, ask = f"{self._stem}_test_{number + 1}", f"ask_{self._stem}_{number + 1}"
            self._wiring.asked[ask] = (test.call, order)
            names = {v: self._scope.variables[v] for v in order}
            write_test(self._lines, name, test.call, names, ask, order)
            self._scope.tests[number] = name  # type: ignore[index] # filled here only
            self._scope.parameters[number] = order  # type: ignore[index] # filled here only
        if needed_binds:
            for number, bind in enumerate(self._body.clause.binds):
                order = tuple(dict.fromkeys(variables_of(bind.expression)))
                self._wiring.asked[self._bind(number)] = (bind.expression, order)

    def _bind(self, number: int) -> str:
        return f"bind_{self._stem}_{number + 1}"

    def _binds_in_key(self) -> bool:
        computed = {bind.variable.name for bind in self._body.clause.binds}
        return not computed.isdisjoint(
            v for t in self._body.clause.head.args for v in variables_of(t)
        )

    def _stale(self) -> None:
        """Write what marks a component that is computed from scratch as out of date."""
        name = f"{self._stem}_is_stale"
        with self._lines.block(f"def {name}(*_):"):
            self._lines.add(f"stale[{self._head.component}] = True")
        self._lines.add("")
        for relation in dict.fromkeys(self._body.relations):
            if relation not in self._own_relations():
                self._wiring.present.setdefault(relation.name, []).append(name)

    def _own_relations(self) -> set[Relation]:
        names = {facts.predicate for facts in self._own if isinstance(facts, Facts)}
        return {
            relation
            for relation in self._body.relations
            if isinstance(relation, Facts) and relation.predicate in names
        }

    def _present(self, number: int, lead: Literal) -> None:
        """Write what follows when a row of a condition comes, or no longer when it goes."""
        inside = lead.relation in self._own
        name = f"{self._stem}_when_{lead.relation.name}_{number + 1}"
        if inside:
            self._wiring.grown.setdefault(lead.relation.name, []).append(name)
        else:
            self._wiring.present.setdefault(lead.relation.name, []).append(name)
        names = self._join((), self._lines, lead).cell_names(lead.terms)
        by = [] if inside else ["by"]
        at_once = isinstance(lead.relation, Pairs)  # a kernel tells of many rows together
        parameters = ["pairs", "by"] if at_once else [*names, *by]
        with self._lines.block(f"def {name}({', '.join(parameters)}):"):
            join = self._join((), self._lines, lead)
            if at_once:
                join.each(names, "pairs")
            join.bind_row(lead.terms, names)
            steps = arrange(self._body, self._design.sizes, join.known, leading=lead)
            self._wiring.plans[self._body.number][f"{number}"] = steps
            join.steps(steps)
            self._conclude("grown" if inside else "by")
            self._finish(join)
        self._lines.add("")

    def _absent(self, number: int, lead: Negation) -> None:
        """Write what no longer follows when a row that is denied comes, or follows when it goes.

        It is called while the row is not there: it makes a difference only if no other row is
        denied by the same condition.
        """
        name = f"{self._stem}_unless_{lead.relation.name}_{number + 1}"
        self._wiring.absent.setdefault(lead.relation.name, []).append(name)
        positive = {v for e in self._body.literals for t in e.terms for v in variables_of(t)}
        opened = self._join((), self._lines, None)
        names = opened.cell_names(lead.terms)
        at_once = isinstance(lead.relation, Pairs)
        parameters = ["pairs"] if at_once else names
        with self._lines.block(f"def {name}({', '.join([*parameters, 'by'])}):"):
            join = self._join((), self._lines, None)
            if at_once:
                join.each(names, "pairs")
            join.bind_row(lead.terms, names)
            join.known &= positive
            if not self._is_whole(lead, join.known):
                with self._lines.block(f"if {join.denied(lead)}:"):
                    self._lines.add(join.fail)
            steps = arrange(self._body, self._design.sizes, join.known, without=lead)
            self._wiring.plans[self._body.number][f"not {number}"] = steps
            join.steps(steps)
            for other in self._body.negations[:number]:
                if other.relation == lead.relation:
                    self._denied_by_row(join, other, names)
            self._conclude("by")
            self._finish(join)
        self._lines.add("")

    def _is_whole(self, lead: Negation, known: set[str]) -> bool:
        """Tell whether only one row can match a negated pattern once its variables are bound."""
        keys = lead.terms[: lead.relation.keys]
        return all(v in known for term in keys for v in variables_of(term))

    def _denied_by_row(self, join: Join, other: Negation, names: Sequence[str]) -> None:
        """Leave what another condition denies because of the very row that comes or goes."""
        first: dict[str, str] = {}
        equal = []
        for term, name in zip(other.terms, names, strict=True):
            if not isinstance(term, Variable):
                equal.append(f"{name} == {literal(term.value)}")
            elif term.name in join.known:
                equal.append(f"{name} == {self._scope.variables[term.name]}")
            elif term.name in first:
                equal.append(f"{name} == {first[term.name]}")
            else:
                first[term.name] = name
        with self._lines.block(f"if {' and '.join(equal) or 'True'}:"):
            self._lines.add(join.fail)

    def _fill(self) -> None:
        """Write what follows from everything there is."""
        inside = any(each.relation in self._own for each in self._body.literals)
        if inside:
            return  # nothing follows from it as long as nothing of its own component is there
        name = f"fill_{self._stem}"
        self._wiring.fills[self._body.number] = name
        with self._lines.block(f"def {name}():"):
            join = self._join((), self._lines, None)
            steps = arrange(self._body, self._design.sizes)
            join.steps(steps)
            self._conclude("1")
            self._finish(join)
        self._lines.add("")

    def _prove(self) -> None:
        """Write the search for every derivation of a given belief."""
        clause = self._body.clause
        computed = {bind.variable.name for bind in clause.binds}
        names, late = [], []
        join = self._join((), self._lines, None)
        join.rest, join.on_loop = "yield from rest()", ()
        for cell, term in enumerate(clause.head.args):
            if isinstance(term, Variable) and term.name in computed:
                names.append(f"wanted_{cell + 1}")
                late.append((self._scope.variables[term.name], names[-1]))
            else:
                names.append(join.cell_names([*clause.head.args[: cell + 1]])[cell])
        kept = [i for i, t in enumerate(clause.head.args) if not _is_among(t, computed)]
        with self._lines.block(f"def prove_{self._stem}({', '.join(names)}):"):
            join.bind_row([clause.head.args[i] for i in kept], [names[i] for i in kept])
            steps = arrange(self._body, self._design.sizes, join.known)
            self._wiring.plans[self._body.number]["proof"] = steps
            join.steps(steps)
            if late:
                self._compute_binds()
                different = " or ".join(f"{own} != {wanted}" for own, wanted in late)
                with self._lines.block(f"if {different}:"):
                    self._lines.add(join.fail)
            variables = tuple(
                dict.fromkeys(
                    v
                    for each in self._body.literals
                    for term in each.terms[: each.relation.keys]
                    for v in variables_of(term)
                )
            )
            self._wiring.proofs[self._body.number] = variables
            given = [self._scope.variables[v] for v in variables]
            comma = "," if len(given) == 1 else ""
            self._lines.add(f"yield ({', '.join(given)}{comma})")
            join.close()
        self._lines.add("")

    def _join(self, known: Sequence[str], lines: Lines, lead: Literal | None) -> Join:
        changes = self._changes()
        number = self._body.number
        check = (
            []
            if changes is None
            else [
                f"tick({number})",
                f"if len({changes}) > most: too_many({number})",
            ]
        )
        return Join(lines, self._scope, set(known), lead, check)

    def _changes(self) -> str | None:
        name = self._head.facts.name
        match self._head.keeping:
            case Keeping.PAIRS | Keeping.RECOMPUTED:
                return None
            case Keeping.RECURSIVE:
                return f"{name}_gained"
            case _:
                return f"{name}_changes"

    def _compute_binds(self) -> None:
        for number, bind in enumerate(self._body.clause.binds):
            order = self._wiring.asked[self._bind(number)][1]
            row = [self._scope.variables[v] for v in order]
            comma = "," if len(row) == 1 else ""
            target = self._scope.variables[bind.variable.name]
            self._lines.add(f"{target} = {self._bind(number)}(({', '.join(row)}{comma}))")

    def _conclude(self, by: str) -> None:
        """Write what is done with each match."""
        self._compute_binds()
        head, name = self._body.clause.head, self._head.facts.name
        key = tuple_source([self._scope.of(term) for term in head.args])
        if self._head.keeping is Keeping.RECURSIVE:
            if by == "grown":
                self._lines.add(f"{name}_reached.append({key})")
            elif by == "1":
                self._lines.add(f"{name}_gained[{key}] = None")
            else:
                self._lines.add(f"({name}_gained if by > 0 else {name}_lost)[{key}] = None")
            return
        if self._head.keeping is Keeping.ATTRIBUTED:
            values = [self._scope.of(term) for _, term in head.attributes]
            comma = "," if len(values) == 1 else ""
            key = f"({key}, ({self._body.number}, ({', '.join(values)}{comma})))"
        if not key.isidentifier():
            self._lines.add(f"key = {key}")
            key = "key"
        self._lines.add(f"{name}_changes[{key}] = {name}_changes.get({key}, 0) + {by}")

    def _finish(self, join: Join) -> None:
        join.close()
        changes = self._changes()
        if join.looped and changes is not None:
            number = self._body.number
            self._lines.add(f"if len({changes}) > most: too_many({number})")


def _is_among(term: Term, names: set[str]) -> bool:
    return isinstance(term, Variable) and term.name in names
