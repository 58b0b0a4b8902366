"""The nearest attempt: the bindings under which most of a conjunction holds.

A conjunction fails in as many ways as there are bindings to try. What helps is the way that comes
closest, so conditions that cannot be met are left out and counted: the search is a branch and
bound over the conditions still to be met, the one with the fewest facts to choose from first.

Of attempts that leave out equally many, the one counts whose first failure comes latest; of these
the one that misses a numeric test by least, so that "what is near the case?" is answered with what
is nearest to it; then the least values in the order of the variables. Unless the search is
cut off, the answer depends on nothing else, and not on the order of the facts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Final, cast

from icarus_lite.errors import InferenceError
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.explaining.conjunctions import (
    Attempt,
    Checked,
    Standing,
    in_order,
    is_positive,
    variables_in,
)
from icarus_lite.inference.explaining.lookup import Facts, OpenRow, Pattern
from icarus_lite.inference.explaining.margins import Margin, margin_of
from icarus_lite.inference.expressions import Compiled, compile_test
from icarus_lite.inference.facts import Bindings
from icarus_lite.inference.supports import Literal, bind_literal
from icarus_lite.inference.views import Row
from icarus_lite.language.syntax import Call, Condition, variables_of
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Value

LIMIT: Final = 1_000
"""How many facts a search tries before it is content with the best attempt so far."""


def nearest_attempt(
    conditions: Sequence[Condition],
    tests: Sequence[Call],
    facts: Facts,
    given: Bindings,
    evaluator: Evaluator,
    limit: int = LIMIT,
) -> Attempt:
    """Give the bindings under which most conditions and tests hold.

    Args:
        conditions: The conditions.
        tests: What is asked of the variables they bind.
        facts: Percepts and beliefs.
        given: What is bound beforehand.
        evaluator: Evaluates the tests. One that has no value counts as failed, as here it may be
            asked about what an earlier condition has ruled out.
        limit: How many facts to try at most.
    """
    order = in_order(conditions, tests, given)
    search = _Search(order, facts, given, evaluator, limit)
    search.run()
    return search.attempt()


@dataclass(frozen=True, slots=True)
class _Question:
    """A test or a `not`: what it needs to be asked, and the answer (met, what blocks, error).

    What it needs is a set of slots, as bits.
    """

    place: int
    needs: int
    ask: Callable[[OpenRow], tuple[bool, Belief | None, str]]


@dataclass(frozen=True, slots=True)
class _Best:
    """The best attempt so far; a smaller rank is better, then smaller values."""

    rank: tuple[int, int, float]
    values: tuple[tuple[int, Value], ...]
    standings: tuple[Standing, ...]
    facts: tuple[Belief | None, ...]
    errors: tuple[str, ...]
    row: tuple[Value | None, ...]


class _Search:
    """One branch and bound. All state is undone on the way back up."""

    def __init__(
        self,
        order: Sequence[Literal],
        facts: Facts,
        given: Bindings,
        evaluator: Evaluator,
        limit: int,
    ) -> None:
        self._order = order
        self._limit = limit
        self._slots: dict[str, int] = {}
        for name in (*given, *(name for each in order for name in variables_in(each))):
            self._slots.setdefault(name, len(self._slots))
        self._row: list[Value | None] = [given.get(name) for name in self._slots]
        self._patterns: dict[int, Pattern] = {}
        self._absent: dict[int, Pattern] = {}
        self._questions: list[_Question] = []
        self._margins: dict[int, Margin] = {}
        shared = {*given, *(n for each in order if is_positive(each) for n in variables_in(each))}
        for place, each in enumerate(order):
            if isinstance(each, Call):
                self._add_test(place, each, evaluator)
            else:
                pattern = Pattern(each.atom, self._slots, facts)
                if each.negated:
                    self._absent[place] = pattern
                    needs = self._bits(n for n in each.atom.variables if n in shared)
                    self._questions.append(_Question(place, needs, _absence(pattern)))
                else:
                    self._patterns[place] = pattern
        self._standings: list[Standing | None] = [None] * len(order)
        self._facts: list[Belief | None] = [None] * len(order)
        self._errors = [""] * len(order)
        self._bound = self._bits(given)
        self._failed, self._first = 0, len(order)
        self._tried = 0
        self._best: _Best | None = None
        self._done = False

    def _add_test(self, place: int, test: Call, evaluator: Evaluator) -> None:
        compiled = compile_test(test, self._slots, evaluator.functions, evaluator.path)
        needs = self._bits(variables_of(test))
        self._questions.append(_Question(place, needs, _test(compiled)))
        margin = margin_of(test, self._slots, evaluator)
        if margin is not None:
            self._margins[place] = margin

    def _bits(self, names: Iterable[str]) -> int:
        return sum(1 << slot for slot in {self._slots[name] for name in names})

    def run(self) -> None:
        self._answer_questions()
        self._descend()

    def attempt(self) -> Attempt:
        best = self._best
        assert best is not None  # the first descent always arrives
        bindings = {
            name: value
            for name, slot in self._slots.items()
            if (value := best.row[slot]) is not None
        }
        checked = tuple(
            Checked(
                each,
                bind_literal(each, bindings),
                best.standings[place],
                self._fact(place, best),
                best.errors[place],
            )
            for place, each in enumerate(self._order)
        )
        return Attempt(checked, bindings, self._tried <= self._limit)

    def _fact(self, place: int, best: _Best) -> Belief | None:
        """Give the fact to show beside a condition of the best attempt.

        Of the beliefs that block a `not` it is the first in writing. What a condition names that
        was left out early is known only now that the others are bound.
        """
        fact, row = best.facts[place], list(best.row)
        if best.standings[place] is not Standing.FAILED:
            return fact
        if place in self._absent:
            entries, _ = self._absent[place].find(row)
            return min((blocking for _, blocking, _ in entries), key=str, default=fact)
        pattern = self._patterns.get(place)
        return fact if fact or pattern is None else pattern.namesake(row)

    def _descend(self) -> None:
        """Try every promising way to go on from here."""
        choice = self._fewest()
        if choice is None:
            self._arrive()
            return
        place, entries, free = choice
        row, before = self._row, (self._failed, self._first, self._bound)
        bound = self._bound | sum(1 << slot for slot in free)
        for values, fact, _ in entries:
            self._tried += 1
            if self._tried > self._limit and self._best is not None:
                self._done = True
                return
            for slot, value in zip(free, values, strict=True):
                row[slot] = value
            self._bound = bound
            self._standings[place], self._facts[place] = Standing.MET, fact
            answered = self._answer_questions()
            if self._is_promising():
                self._descend()
            self._undo(place, free, answered, before)
            if self._done:
                return
        self._leave_out(place)

    def _leave_out(self, place: int) -> None:
        """Go on without a condition, but with the attributes of the very object it names."""
        before = self._failed, self._first, self._bound
        self._fail(place)
        if self._is_promising():
            pattern = self._patterns[place]
            namesake = pattern.namesake(self._row)
            bound: Sequence[int] = ()
            if namesake is not None:
                self._facts[place] = namesake
                bound = pattern.bind_attributes(namesake, self._row)
                self._bound |= sum(1 << slot for slot in bound)
            answered = self._answer_questions() if bound else []
            if self._is_promising():
                self._descend()
            self._undo(place, bound, answered, before)
        else:
            self._undo(place, (), (), before)

    def _fewest(self) -> tuple[int, Sequence[tuple[Row, Belief, int]], tuple[int, ...]] | None:
        """Choose the condition that leaves the least choice; None when all are dealt with."""
        choice, least = None, -1
        for place, pattern in self._patterns.items():
            if self._standings[place] is None:
                count = pattern.estimate(self._row)
                if choice is None or count < least:
                    choice, least = place, count
                    if not least:
                        break
        if choice is None:
            return None
        entries, free = self._patterns[choice].find(self._row)
        return choice, entries, free

    def _answer_questions(self) -> list[int]:
        """Ask all tests and negations that can be asked by now; give their places."""
        answered = []
        row, standings = self._row, self._standings
        for question in self._questions:
            place = question.place
            if standings[place] is None and not question.needs & ~self._bound:
                met, fact, error = question.ask(row)
                answered.append(place)
                if met:
                    standings[place] = Standing.MET
                else:
                    self._fail(place)
                    self._facts[place], self._errors[place] = fact, error
        return answered

    def _fail(self, place: int) -> None:
        self._standings[place] = Standing.FAILED
        self._failed += 1
        self._first = min(self._first, place)

    def _undo(
        self,
        place: int,
        bound: Sequence[int],
        answered: Sequence[int],
        before: tuple[int, int, int],
    ) -> None:
        for slot in bound:
            self._row[slot] = None
        for each in (place, *answered):
            self._standings[each], self._facts[each], self._errors[each] = None, None, ""
        self._failed, self._first, self._bound = before

    def _is_promising(self) -> bool:
        return self._best is None or (self._failed, -self._first) <= self._best.rank[:2]

    def _arrive(self) -> None:
        """Compare what has been reached with the best so far."""
        left = self._standings.count(None)
        first = min(self._first, self._standings.index(None)) if left else self._first
        best = self._best
        if best is not None and (self._failed + left, -first) > best.rank[:2]:
            return
        margin = self._margins.get(first)
        short = 0.0 if margin is None else margin(cast("Row", self._row))
        rank = self._failed + left, -first, short
        if best is not None and rank > best.rank:
            return
        values = tuple([_canonical(value) for value in self._row])
        if best is None or (rank, values) < (best.rank, best.values):
            standings = tuple(each or Standing.OPEN for each in self._standings)
            facts, errors, row = tuple(self._facts), tuple(self._errors), tuple(self._row)
            self._best = _Best(rank, values, standings, facts, errors, row)
            self._done = not rank[0]


def _absence(pattern: Pattern) -> Callable[[OpenRow], tuple[bool, Belief | None, str]]:
    def ask(row: OpenRow) -> tuple[bool, Belief | None, str]:
        entries, _ = pattern.find(row)
        return not entries, entries[0][1] if entries else None, ""

    return ask


def _test(compiled: Compiled) -> Callable[[OpenRow], tuple[bool, Belief | None, str]]:
    def ask(row: OpenRow) -> tuple[bool, Belief | None, str]:
        try:
            return bool(compiled(cast("Row", row))), None, ""
        except InferenceError as error:
            return False, None, str(error)

    return ask


def _canonical(value: Value | None) -> tuple[int, Value]:
    """Order values of any kind: what is free, numbers, symbols."""
    if value is None:
        return 0, 0
    return (2, value) if isinstance(value, str) else (1, value)
