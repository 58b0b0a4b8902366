"""Bodies: the conditions of a clause, as relations to join and tests to ask.

Three things are taken out of the general join. Two percept patterns at the beginning with numeric
tests over both become one relation of pairs, which a kernel keeps. Constants in a percept pattern,
and tests over one object that cannot fail, become part of the view of that pattern. An attribute
that nothing else asks for need only be there.

A test that may fail (a comparison of numbers, which a symbol is not) is never asked of a row that
the conditions standing before it as written rule out: what the domain excludes is no mistake.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from icarus_lite.inference.network import kernels
from icarus_lite.inference.network.relations import Facts, Pairs, Relation, View
from icarus_lite.inference.network.vocabulary import Vocabulary
from icarus_lite.language.functions import FUNCTIONS
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Constant,
    Term,
    Variable,
    variables_of,
)
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Literal:
    """A relation whose rows are joined.

    Args:
        relation: The relation.
        terms: What its cells are matched with, keys first.
        places: The positive conditions, numbered as written, that it stands for.
    """

    relation: Relation
    terms: tuple[Term, ...]
    places: frozenset[int]


@dataclass(frozen=True, slots=True)
class Negation:
    """A relation in which no row may match; variables that are bound nowhere else mean "any"."""

    relation: Relation
    terms: tuple[Term, ...]
    atom: Atom


@dataclass(frozen=True, slots=True)
class Test:
    """A test that the join asks.

    Args:
        call: The test.
        needs: The variables that must be bound.
        after: The positive conditions that must have been met before.
    """

    call: Call
    needs: frozenset[str]
    after: frozenset[int]


@dataclass(frozen=True, slots=True)
class Body:
    """A clause taken apart.

    Args:
        clause: The clause.
        number: Its place among all clauses, as written.
        literals: What is joined.
        negations: What must be absent.
        tests: What is asked, in the order written.
    """

    clause: ConceptClause
    number: int
    literals: tuple[Literal, ...]
    negations: tuple[Negation, ...]
    tests: tuple[Test, ...]

    @property
    def relations(self) -> tuple[Relation, ...]:
        """The relations of all conditions, repeats included."""
        positive = [each.relation for each in self.literals]
        return (*positive, *(each.relation for each in self.negations))


def body_of(clause: ConceptClause, number: int, vocabulary: Vocabulary) -> Body:
    """Take a clause apart."""
    return _Reader(clause, number, vocabulary).body()


def is_safe(call: Call) -> bool:
    """Tell whether a test has an answer whatever the values: equality of plain terms."""
    return (
        call.function in ("=", "/=")
        and FUNCTIONS[call.function].accepts(len(call.args))
        and not any(isinstance(argument, Call) for argument in call.args)
    )


class _Reader:
    """Reads one clause; tests are taken out of `_tests` as a pattern takes them over."""

    def __init__(self, clause: ConceptClause, number: int, vocabulary: Vocabulary) -> None:
        self._clause, self._number, self._vocabulary = clause, number, vocabulary
        self._positive = [c.atom for c in clause.elements if not c.negated]
        self._negative = [c.atom for c in clause.elements if c.negated]
        bound: set[str] = {v for atom in self._positive for v in atom.variables}
        self._tests: list[Test] = []
        for turn, call in _in_turn(clause.tests, self._positive):
            after = frozenset() if is_safe(call) else frozenset(range(turn))
            needs = frozenset(variables_of(call)) & bound
            self._tests.append(Test(call, needs, after))

    def body(self) -> Body:
        literals = self._pair_rule() if len(self._positive) > 1 else None
        start = 0
        if literals is None:
            literals = []
        else:
            start = 2
        for place in range(start, len(self._positive)):
            atom = self._positive[place]
            if self._vocabulary.has_objects(atom.predicate, len(atom.args)):
                own = self._take([t for t in self._tests if self._belongs(t, atom, place)])
                literals.append(Literal(*self._view(atom, own, (atom,)), frozenset((place,))))
            else:
                literals.append(Literal(*_facts(atom), frozenset((place,))))
        negations = tuple(self._negation(atom) for atom in self._negative)
        return Body(self._clause, self._number, tuple(literals), negations, tuple(self._tests))

    def _take(self, wanted: Sequence[Test]) -> tuple[Call, ...]:
        """Take tests out of those that the join has to ask."""
        taken = {id(test) for test in wanted}
        self._tests = [test for test in self._tests if id(test) not in taken]
        return tuple(test.call for test in wanted)

    def _belongs(self, test: Test, atom: Atom, place: int) -> bool:
        """Tell whether a test is about the objects of one pattern alone and can be asked early."""
        own = frozenset(atom.variables)
        if not test.needs or frozenset(variables_of(test.call)) - own:
            return False
        return not test.after or (place == 0 and test.after == {0})

    def _uses(self, patterns: Iterable[Atom]) -> Counter[str]:
        """Count how often each variable is used outside of these patterns and of taken tests."""
        clause = self._clause
        skipped = {id(atom) for atom in patterns}
        uses: Counter[str] = Counter(clause.head.variables)
        for atom in (*self._positive, *self._negative):
            if id(atom) not in skipped:
                uses.update(atom.variables)
        for test in self._tests:
            uses.update(variables_of(test.call))
        for bind in clause.binds:
            uses.update(variables_of(bind.expression))
        return uses

    def _view(
        self, atom: Atom, own: tuple[Call, ...], patterns: Sequence[Atom]
    ) -> tuple[View, tuple[Term, ...]]:
        """Give the view of a percept pattern, and the terms for its cells."""
        uses = self._uses(patterns)
        within = Counter(atom.variables)
        for other in patterns:
            if other is not atom:
                within.update(other.variables)
        cells: list[str] = []
        terms: list[Term] = []
        required, constants = [], []
        variables: dict[str, str] = {}
        tested = {v for call in own for v in variables_of(call)}
        if isinstance(atom.args[0], Variable) and atom.args[0].name in tested:
            variables[atom.args[0].name] = ""
        for attribute, term in atom.attributes:
            if isinstance(term, Constant):
                constants.append((attribute, term.value))
                continue
            if term.name in tested:
                variables.setdefault(term.name, attribute)
            if uses[term.name] or within[term.name] > 1:
                cells.append(attribute)
                terms.append(term)
            else:
                required.append(attribute)
        view = View(
            atom.predicate,
            tuple(cells),
            tuple(required),
            tuple(constants),
            own,
            tuple(variables.items()),
        )
        return view, (atom.args[0], *terms)

    def _negation(self, atom: Atom) -> Negation:
        if not self._vocabulary.has_objects(atom.predicate, len(atom.args)):
            return Negation(*_facts(atom), atom)
        constants = tuple((a, t.value) for a, t in atom.attributes if isinstance(t, Constant))
        open_ones = [(a, t) for a, t in atom.attributes if isinstance(t, Variable)]
        view = View(atom.predicate, tuple(a for a, _ in open_ones), (), constants)
        return Negation(view, (atom.args[0], *(term for _, term in open_ones)), atom)

    def _pair_rule(self) -> list[Literal] | None:
        """Take two percept patterns at the beginning and their numeric tests as one relation."""
        left, right = self._positive[:2]
        for atom in (left, right):
            if not self._vocabulary.has_objects(atom.predicate, len(atom.args)):
                return None
        variables = [*left.variables, *right.variables]
        if len(set(variables)) < len(variables):
            return None
        names = [atom.args[0] for atom in (left, right)]
        if not all(isinstance(name, Variable) for name in names):
            return None
        within = frozenset(variables)
        mine = [t for t in self._tests if t.needs and frozenset(variables_of(t.call)) <= within]
        on_left = frozenset(left.variables)
        left_own = [t for t in mine if t.needs <= on_left and t.after <= {0}]
        right_own = [t for t in mine if t.needs <= frozenset(right.variables) and not t.after]
        both = [t for t in mine if t not in left_own and t not in right_own]
        apart = [t for t in both if t.call.function == "/=" and set(t.call.args) == set(names)]
        apart = [t for t in apart if len(t.call.args) == 2]
        numeric = [t for t in both if not is_safe(t.call)]
        plain = [t for t in both if is_safe(t.call) and t not in apart]
        if not numeric or any(
            both.index(one) < both.index(other) for one in plain for other in numeric
        ):
            return None
        calls = tuple(test.call for test in numeric)
        read = frozenset(v for call in calls for v in variables_of(call))
        one, other = _side(left, read), _side(right, read)
        path = self._vocabulary.evaluator.path
        kernel = kernels.compile_pair(one, other, calls, bool(apart), path=path)
        if kernel is None:
            return None
        self._take([*left_own, *right_own, *numeric, *apart])
        literals: list[Literal] = []
        views = []
        for atom, own in ((left, left_own), (right, right_own)):
            view, terms = self._view(atom, tuple(t.call for t in own), (left, right))
            attributes = tuple(a for a, t in atom.attributes if str(t) in read)
            required = tuple(a for a in (*view.cells, *view.required) if a not in attributes)
            views.append(
                View(view.type, attributes, required, view.constants, view.tests, view.variables)
            )
            if view.cells:
                literals.append(Literal(view, terms, frozenset()))
        pairs = Pairs(views[0], views[1], calls, bool(apart), kernel)
        return [Literal(pairs, (names[0], names[1]), frozenset((0, 1))), *literals]


def _side(atom: Atom, read: frozenset[str]) -> kernels.PairSide:
    name = atom.args[0]
    attributes = tuple(
        (t.name, a) for a, t in atom.attributes if isinstance(t, Variable) and t.name in read
    )
    return kernels.PairSide(name.name if isinstance(name, Variable) else None, attributes)


def _facts(atom: Atom) -> tuple[Facts, tuple[Term, ...]]:
    names = tuple(name for name, _ in atom.attributes)
    terms = (*atom.args, *(term for _, term in atom.attributes))
    return Facts(atom.predicate, len(atom.args), names), terms


def _in_turn(tests: Sequence[Call], positive: Sequence[Atom]) -> list[tuple[int, Call]]:
    """Give each test with the number of positive conditions that stand before it, in that order."""
    found: list[tuple[int, int, Call]] = []
    for number, test in enumerate(tests):
        missing = set(variables_of(test))
        turn = 0
        for place, atom in enumerate(positive):
            if not missing:
                break
            if missing & set(atom.variables):
                missing -= set(atom.variables)
                turn = place + 1
        found.append((len(positive) if missing else turn, number, test))
    return [(turn, test) for turn, _, test in sorted(found, key=lambda each: each[:2])]
