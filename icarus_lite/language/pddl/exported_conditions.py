"""Conditions and tests of a clause as PDDL: said where PDDL can say it, evaluated where not.

Attributes and numeric tests rest on percepts, which do not change while planning. So the part of
a clause that speaks of them is evaluated at the start, and stands in PDDL as a predicate made for
it, whose facts are written into the initial state.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence

from icarus_lite.language.checking.expressions import variables_in
from icarus_lite.language.checking.report import Report
from icarus_lite.language.pddl.kinds import is_equality
from icarus_lite.language.pddl.scope import RefusedError
from icarus_lite.language.pddl.situation import KnownState
from icarus_lite.language.pddl.syntax import And, Equal, Exists, Formula, Not, Or, Typed
from icarus_lite.language.pddl.vocabulary import PddlVocabulary, variable_name
from icarus_lite.language.syntax import Atom, Call, Condition, Constant, Expression, Variable
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Value

_MOST_ROWS = 20_000
"""More facts than this for one evaluated condition are refused."""


@dataclass(frozen=True, slots=True)
class Body:
    """The conditions of a clause.

    Args:
        parts: What must hold, all of it.
        types: The type of each variable, in the order in which they come up.
    """

    parts: tuple[Formula, ...]
    types: dict[str, str]


@dataclass(slots=True)
class Conditions:
    """Translates conditions, and collects the predicates this takes."""

    names: PddlVocabulary
    state: KnownState
    report: Report
    _made: dict[str, str] = field(default_factory=dict)

    def body(
        self,
        owner: str,
        conditions: Sequence[Condition],
        tests: Sequence[Call],
        wanted: Iterable[str],
    ) -> Body | None:
        """Translate the conditions of a clause.

        Args:
            owner: What the clause is about, to name predicates made for it.
            conditions: Its elements, or a goal.
            tests: Its tests.
            wanted: Variables that the rest of the clause uses.

        Returns:
            The body; None if it can never hold.

        Raises:
            RefusedError: PDDL cannot say it; the reason is in the report.
        """
        if not self.names.values.can_hold(conditions):
            return None
        split = _Split(self, conditions, tests)
        split.sort()
        uses = {name for c in split.said for name in c.atom.variables} | set(wanted)
        uses |= {v.name for test in split.equations for v in variables_in(test)}
        parts: list[Formula] = []
        for group in split.groups():
            part = self._evaluated(owner, group, conditions, uses)
            if part is None:
                return None
            parts += part
        for condition in split.said:
            part = self._said(owner, condition, conditions)
            if part is None:
                return None
            parts += part
        parts += [self._equation(test) for test in split.equations]
        bound = [v for c in conditions if not c.negated for v in c.atom.variables if v in uses]
        types = {name: self.type_of(name, conditions) for name in dict.fromkeys(bound)}
        return Body(tuple(dict.fromkeys(parts)), types)

    def type_of(self, variable: str, conditions: Iterable[Condition]) -> str:
        """Give the narrowest type of all that a variable can be where the conditions hold."""
        return self.names.type_of_values(self.names.values.of(variable, conditions))

    def refuse(self, atom: Atom | Call, message: str, hint: str) -> RefusedError:
        """Report that something cannot be exported; raise what this returns."""
        self.report.error(atom.span, "PDDL007", message, hint)
        return RefusedError()

    def _said(
        self, owner: str, condition: Condition, conditions: Sequence[Condition]
    ) -> list[Formula] | None:
        """Translate a condition that PDDL can say; [] if it holds anyway, None if never."""
        atom, names = condition.atom, self.names
        if condition.negated:
            return self._absent(owner, atom, conditions)
        if atom.predicate in names.kinds.types:
            return []  # the type of the variable says it, and a constant has been looked up
        return [self._fact(atom, conditions)]

    def _fact(self, atom: Atom, conditions: Sequence[Condition]) -> Formula:
        types = [
            self.names.type_of_value(term.value)
            if isinstance(term, Constant)
            else self.type_of(term.name, conditions)
            for term in atom.args
        ]
        name = self.names.predicate(atom.predicate)
        return self.names.fact(name, map(self.names.term, atom.args), types)

    def _absent(
        self, owner: str, atom: Atom, conditions: Sequence[Condition]
    ) -> list[Formula] | None:
        bound = {v for c in conditions if not c.negated for v in c.atom.variables}
        if atom.predicate not in self.names.values.possible:
            return []
        if atom.attributes:
            if atom.predicate in self.names.kinds.changing:
                raise self._changing_attribute(atom)
            shared = [v for v in dict.fromkeys(atom.variables) if v in bound]
            rows = self._rows([Condition(atom)], [], shared, {})
            if not shared:
                return None if rows else []
            positive = self._predicate_for(owner, [Condition(atom)], [], shared, rows, conditions)
            return [Not(positive)]
        local = [name for name in dict.fromkeys(atom.variables) if name not in bound]
        scope = [*conditions, Condition(atom)] if local else conditions
        fact = self._fact(atom, scope)
        if not local:
            return [Not(fact)]
        variables = tuple(
            Typed(variable_name(n), self.type_of(n, [Condition(atom)])) for n in local
        )
        return [Not(Exists(variables, fact))]

    def _changing_attribute(self, atom: Atom) -> RefusedError:
        message = f"{atom} asks for an attribute of what skills change, which PDDL cannot say"
        return self.refuse(atom, message, "make the value an argument of the predicate")

    def _equation(self, test: Expression) -> Formula:
        assert isinstance(test, Call)
        if test.function in ("and", "or"):
            parts = tuple(map(self._equation, test.args))
            return And(parts) if test.function == "and" else Or(parts)
        if test.function == "not":
            return Not(self._equation(test.args[0]))
        terms = [self.names.term(arg) for arg in test.args if not isinstance(arg, Call)]
        if test.function == "=":
            pairs = list(itertools.pairwise(terms))
            equal: list[Formula] = [Equal(a, b) for a, b in pairs]
            return equal[0] if len(equal) == 1 else And(tuple(equal))
        apart: list[Formula] = [Not(Equal(a, b)) for a, b in itertools.combinations(terms, 2)]
        return apart[0] if len(apart) == 1 else And(tuple(apart))

    def _evaluated(
        self, owner: str, group: _Group, conditions: Sequence[Condition], uses: set[str]
    ) -> list[Formula] | None:
        """Evaluate a group of conditions and tests; [] if it holds anyway, None if never."""
        kept = [name for name in group.variables if name in uses]
        free = {name: self.names.values.of(name, conditions) for name in group.unbound}
        rows = self._rows(group.conditions, group.tests, kept, free)
        if not rows:
            return None
        if not kept:
            return []
        made = self._predicate_for(owner, group.conditions, group.tests, kept, rows, conditions)
        return [made]

    def _rows(
        self,
        conditions: Sequence[Condition],
        tests: Sequence[Call],
        kept: Sequence[str],
        free: dict[str, dict[Value, None]],
    ) -> tuple[tuple[Value, ...], ...]:
        rows: dict[tuple[Value, ...], None] = {}
        for chosen in itertools.product(*free.values()):
            given = dict(zip(free, chosen, strict=True))
            for found in self.state.matches(conditions, tests, given):
                rows[tuple(found[name] for name in kept)] = None
                if len(rows) > _MOST_ROWS:
                    culprit = tests[0] if tests else conditions[0].atom
                    message = f"this is true of more than {_MOST_ROWS} combinations of objects"
                    raise self.refuse(culprit, message, "export a task with fewer objects")
        return tuple(rows)

    def _predicate_for(
        self,
        owner: str,
        conditions: Sequence[Condition],
        tests: Sequence[Call],
        kept: Sequence[str],
        rows: tuple[tuple[Value, ...], ...],
        clause: Sequence[Condition],
    ) -> Formula:
        """Make a predicate that is true of these rows; the same one for the same conditions."""
        numbers = {name: f"?{i}" for i, name in enumerate(kept)}
        key = " ".join(_numbered(str(each), numbers) for each in (*conditions, *tests))
        if not conditions:  # then the rows depend on the rest of the clause
            key = f"{owner} {clause} {key}"
        name = self.names.fresh_predicate(key, _wish(owner, conditions, tests))
        self.names.rows[name] = rows
        for row in rows:
            for value in row:
                self.names.object(value)
        types = [
            self.names.common_type(
                [self.type_of(v, clause), *(self.names.type_of_value(row[i]) for row in rows)]
            )
            for i, v in enumerate(kept)
        ]
        return self.names.fact(name, map(variable_name, kept), types)


@dataclass(slots=True)
class _Group:
    """Conditions and tests that share variables and are evaluated together."""

    conditions: list[Condition]
    tests: list[Call]

    @property
    def variables(self) -> list[str]:
        names = [name for c in self.conditions for name in c.atom.variables]
        names += [v.name for test in self.tests for v in variables_in(test)]
        return list(dict.fromkeys(names))

    @property
    def unbound(self) -> list[str]:
        bound = {name for c in self.conditions for name in c.atom.variables}
        return [name for name in self.variables if name not in bound]


@dataclass(slots=True)
class _Split:
    """Sorts the conditions and tests of one clause into what is said and what is evaluated."""

    owner: Conditions
    conditions: Sequence[Condition]
    tests: Sequence[Call]
    said: list[Condition] = field(default_factory=list)
    equations: list[Call] = field(default_factory=list)
    _measured: list[Condition] = field(default_factory=list)
    _numeric: list[Call] = field(default_factory=list)

    def sort(self) -> None:
        """Sort them. Raises RefusedError where an attribute changes."""
        changing = self.owner.names.kinds.changing
        for condition in self.conditions:
            if condition.negated or not condition.atom.attributes:
                self.said.append(condition)
            elif condition.atom.predicate in changing:
                raise self.owner._changing_attribute(condition.atom)  # noqa: SLF001
            else:
                self._measured.append(condition)
        arguments = {
            t.name
            for c in self.said
            if not c.negated
            for t in c.atom.args
            if isinstance(t, Variable)
        }
        arguments |= {
            t.name for c in self._measured for t in c.atom.args if isinstance(t, Variable)
        }
        for test in self.tests:
            named = all(v.name in arguments for v in variables_in(test))
            (self.equations if is_equality(test) and named else self._numeric).append(test)
        known = {name for c in self._measured for name in c.atom.variables}
        asked = {v.name for test in self._numeric for v in variables_in(test)} - known
        for condition in tuple(self.said):
            fixed = not condition.negated and condition.atom.predicate not in changing
            if fixed and asked & set(condition.atom.variables):
                self.said.remove(condition)
                self._measured.append(condition)

    def groups(self) -> Iterator[_Group]:
        """Give what is evaluated, in groups that share no variable."""
        waiting = [_Group([c], []) for c in self._measured] + [
            _Group([], [t]) for t in self._numeric
        ]
        while waiting:
            group = waiting.pop(0)
            grown = True
            while grown:
                shared = [g for g in waiting if set(g.variables) & set(group.variables)]
                grown = bool(shared)
                for other in shared:
                    group.conditions += other.conditions
                    group.tests += other.tests
                    waiting.remove(other)
            yield group


def _numbered(text: str, numbers: dict[str, str]) -> str:
    words = text.replace("(", "( ").replace(")", " )").split()
    return " ".join(numbers.get(word, word) for word in words)


def _wish(owner: str, conditions: Sequence[Condition], tests: Sequence[Call]) -> str:
    """Name a made predicate after the one pattern it stands for, or else after its clause."""
    if len(conditions) == 1 and not tests:
        atom = conditions[0].atom
        pairs = [
            f"{name}-{value}" for name, value in atom.attributes if isinstance(value, Constant)
        ]
        if len(pairs) == len(atom.attributes):
            return "-".join([atom.predicate, *pairs])
    return f"{owner}-measured"
