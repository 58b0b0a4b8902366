"""Joins: a conjunction compiled to a plan, and the plan run over a store of facts.

A plan takes the positive conditions one after the other. Each is a step: look facts up by what is
known, append what they bind to the row, try the tests that can now be answered. Rows are tuples
that grow to the right, so that trying the next fact needs no copy and no undoing. Negated
conditions come last and are a single look-up each.

Conditions are joined in the order written. To find only what has become possible since facts were
added, a plan may be *led* by one condition: that one is taken first and meets new facts only, the
others follow in the order written. Led by each condition in turn, with those before it kept to
old facts, plans find every new match exactly once (semi-naive evaluation; Bancilhon and
Ramakrishnan 1986). A test never runs before the conditions that stand before it as written
have been met, so that it is not asked about what the domain has already ruled out.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import Enum
from operator import itemgetter

from icarus_lite.inference.expressions import Compiled, compile_test, conjoin
from icarus_lite.inference.facts import FactStore
from icarus_lite.inference.views import Entry, Key, Row, View, key_getter, row_getter
from icarus_lite.language.functions import PythonFunctions
from icarus_lite.language.syntax import Atom, Call, Constant, Term
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value

_number = itemgetter(2)


class Age(Enum):
    """Which facts a step may use: all, or those added before or since a given moment."""

    ANY = "any"
    OLD = "old"
    NEW = "new"


@dataclass(frozen=True, slots=True)
class Conjunction:
    """What is to be joined.

    Args:
        positive: The positive conditions, in the order written.
        negative: The negated ones.
        tests: One tuple more than there are positive conditions: the tests that can be answered
            before the first of them, after the first, and so on.
    """

    positive: tuple[Atom, ...]
    negative: tuple[Atom, ...]
    tests: tuple[tuple[Call, ...], ...]


@dataclass(frozen=True, slots=True)
class Lookup:
    """How one condition finds its facts, given a row.

    Args:
        view: The view of its facts.
        key: Picks the key out of the row.
        whole: Whether the key is all the arguments; then the store itself is the index.
    """

    view: View
    key: Callable[[Row], Key]
    whole: bool

    def source(self, facts: FactStore) -> Mapping[Key, Sequence[Entry]]:
        """Give the index to look into."""
        return facts.rows(self.view.predicate) if self.whole else facts.index(self.view)


@dataclass(frozen=True, slots=True)
class Step:
    """One positive condition of a plan.

    Args:
        lookup: How it finds its facts.
        test: What is asked as soon as they have been found, if anything.
        age: Which facts it may use.
    """

    lookup: Lookup
    test: Compiled | None
    age: Age

    def entries(
        self, source: Mapping[Key, Sequence[Entry]], row: Row, since: int
    ) -> Iterator[Entry]:
        """Give the facts that it can use, oldest first."""
        found = source.get(self.lookup.key(row), ())
        if self.age is Age.NEW:
            found = found[bisect_left(found, since, key=_number) :]
        elif self.age is Age.OLD:
            found = found[: bisect_left(found, since, key=_number)]
        return iter(found)


Tick = Callable[[], None]
"""Looks at the clock; raises an error when the time is over."""


@dataclass(frozen=True, slots=True)
class Plan:
    """A compiled conjunction.

    Args:
        constants: What each row begins with.
        slots: Where each variable stands in a row that the plan gives.
        before: What is asked first, if any test needs nothing but what is given.
        steps: The positive conditions, in the order in which they are joined.
        absences: The negated ones.
        places: For each positive condition as written, its place among the steps.
    """

    constants: Row
    slots: Mapping[str, int]
    before: Compiled | None
    steps: tuple[Step, ...]
    absences: tuple[Lookup, ...]
    places: tuple[int, ...]

    def run(
        self, facts: FactStore, given: Row = (), since: int = 0, tick: Tick | None = None
    ) -> Iterator[tuple[Row, tuple[Entry, ...]]]:
        """Give each match: its row, and the facts that met the conditions, as they are joined.

        Args:
            facts: The facts to join.
            given: The values of the variables that are bound beforehand.
            since: What is old: the facts with smaller numbers.
            tick: Is called now and then, to look at the clock.

        Raises:
            InferenceError: a test cannot be evaluated.
        """
        row = self.constants + given
        if self.before is not None and not self.before(row):
            return
        if self.steps:
            yield from self._join(facts, row, since, tick)
        elif not self._is_denied(facts, row):
            yield row, ()

    def _join(
        self, facts: FactStore, row: Row, since: int, tick: Tick | None
    ) -> Iterator[tuple[Row, tuple[Entry, ...]]]:
        steps, last = self.steps, len(self.steps) - 1
        sources = [steps[0].lookup.source(facts)]
        pending = [steps[0].entries(sources[0], row, since)]
        rows, found = [row], list[Entry]()
        while pending:
            if tick is not None:
                tick()
            depth = len(pending) - 1
            base, test = rows[depth], steps[depth].test
            for entry in pending[depth]:
                row = base + entry[0]
                if test is not None and not test(row):
                    continue
                if depth == last:
                    if not self._is_denied(facts, row):
                        yield row, (*found, entry)
                    continue
                found.append(entry)
                rows.append(row)
                if len(sources) == len(rows) - 1:
                    sources.append(steps[depth + 1].lookup.source(facts))
                pending.append(steps[depth + 1].entries(sources[depth + 1], row, since))
                break
            else:
                pending.pop()
                rows.pop()
                if found:
                    found.pop()

    def row(self, entries: Sequence[Entry]) -> Row:
        """Give the row of a match of which only the facts are known, nothing being given.

        A row of another plan will not do: a variable that met 2 in one fact and 2.0 in another
        has the value of the first that was joined.
        """
        row = self.constants
        for step, (_, fact, _) in zip(self.steps, entries, strict=True):
            row += step.lookup.view.binds(fact)
        return row

    def _is_denied(self, facts: FactStore, row: Row) -> bool:
        return any(each.key(row) in each.source(facts) for each in self.absences)


def compile_plan(
    conjunction: Conjunction,
    given: Sequence[str],
    functions: PythonFunctions,
    path: str,
    lead: int | None = None,
    growing: frozenset[str] = frozenset(),
) -> Plan:
    """Compile a conjunction.

    Args:
        conjunction: What is to be joined.
        given: The variables that are bound beforehand, in the order in which they will be given.
        functions: Python functions that tests may call.
        path: The domain file, to name it in errors.
        lead: The place of the condition that leads, if any.
        growing: The predicates that gain facts while the plan is in use; where a condition leads,
            those before it that are on one of these keep to old facts.
    """
    positive = conjunction.positive
    constants = _constants_of((*positive, *conjunction.negative))
    slots: dict[str, int] = {}
    for name in given:
        slots[name] = len(constants) + len(slots)

    def compiled(turn: int) -> list[Compiled]:
        known = dict(slots)
        return [compile_test(t, known, functions, path) for t in conjunction.tests[turn]]

    before = conjoin(compiled(0))
    order = list(range(len(positive)))
    if lead is not None:
        order = [lead, *order[:lead], *order[lead + 1 :]]
    steps, joined, tried = [], set[int](), 0
    for place in order:
        lookup = _lookup(positive[place], constants, slots)
        joined.add(place)
        tests: list[Compiled] = []
        while tried in joined:
            tried += 1
            tests += compiled(tried)
        age = Age.ANY
        if place == lead:
            age = Age.NEW
        elif lead is not None and place < lead and positive[place].predicate in growing:
            age = Age.OLD
        steps.append(Step(lookup, conjoin(tests), age))
    absences = tuple(_lookup(atom, constants, dict(slots)) for atom in conjunction.negative)
    values = tuple(value for _, value in constants)
    places = tuple(order.index(place) for place in range(len(order)))
    return Plan(values, slots, before, tuple(steps), absences, places)


def _constants_of(atoms: Iterable[Atom]) -> dict[tuple[type, Value], int]:
    """Give each constant its slot; 1 and 1.0 are kept apart, as a belief shows which it is."""
    slots: dict[tuple[type, Value], int] = {}
    for atom in atoms:
        for term in _terms(atom):
            if isinstance(term, Constant):
                slots.setdefault((type(term.value), term.value), len(slots))
    return slots


def _terms(atom: Atom) -> tuple[Term, ...]:
    return (*atom.args, *(term for _, term in atom.attributes))


def _lookup(
    atom: Atom, constants: Mapping[tuple[type, Value], int], slots: dict[str, int]
) -> Lookup:
    """Compile how a condition finds its facts; the variables that it binds get the next slots."""
    key, key_slots, values = [], [], []
    equal: list[tuple[int, int]] = []
    fresh: dict[str, int] = {}
    for cell, term in enumerate(_terms(atom)):
        if isinstance(term, Constant):
            key.append(cell)
            key_slots.append(constants[type(term.value), term.value])
        elif term.name in slots:
            key.append(cell)
            key_slots.append(slots[term.name])
        elif term.name in fresh:
            equal.append((fresh[term.name], cell))
        else:
            fresh[term.name] = cell
            values.append(cell)
    for name in fresh:
        slots[name] = len(constants) + len(slots)
    arity = len(atom.args)
    names = tuple(name for name, _ in atom.attributes)
    view = View(atom.predicate, arity, names, tuple(key), tuple(values), tuple(equal))
    whole = not names and len(key) == arity
    pick = row_getter if whole else key_getter
    return Lookup(view, pick(tuple(key_slots)), whole)
