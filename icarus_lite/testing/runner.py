"""Runs the `(test …)` forms of a domain against the engine and the planner themselves."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from icarus_lite.errors import FrameError, InferenceError
from icarus_lite.inference import (
    FactStore,
    Functions,
    InferenceEngine,
    Memory,
    explain,
    given_memory,
    match,
)
from icarus_lite.language.syntax import Atom, Constant, Domain, DomainTest, LaterCycle
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Belief, Percept, Value
from icarus_lite.testing.absence import why_absent
from icarus_lite.testing.outcome import CaseOutcome, Difference, Kind
from icarus_lite.testing.plans import check_plan

_MOST_EXPLAINED = 3


def run_tests(domain: Domain, functions: Functions | None = None) -> tuple[CaseOutcome, ...]:
    """Run all tests of a domain, in the order of the text.

    Args:
        domain: A checked domain.
        functions: Python predicates that its `:tests` may call by name.
    """
    engine = InferenceEngine(domain, functions)
    return tuple(run_test(engine, test) for test in domain.tests)


def run_test(engine: InferenceEngine, test: DomainTest) -> CaseOutcome:
    """Run one test of the engine's domain.

    The first cycle begins with what `:init` gives, and an otherwise empty memory. Each cycle
    perceives what it states and is told that its actions have succeeded; then its expectations are
    compared with the beliefs. A goal is planned for after the last cycle. Domain errors make the
    test fail; nothing is raised.
    """
    memory = given_memory(engine.domain, test.init)
    differences, notes = list[Difference](), list[str](memory.state.notes)
    percepts: tuple[Atom, ...] = ()
    cycles: tuple[DomainTest | LaterCycle, ...] = (test, *test.then)
    for number, cycle in enumerate(cycles):
        percepts = percepts if cycle.percepts is None else cycle.percepts
        try:
            memory = engine.step(memory, _percepts(percepts), _outcomes(cycle.actions))
            notes.extend(memory.state.notes)
            differences.extend(_compare(engine, memory, cycle, number))
        except (FrameError, InferenceError) as error:
            return _broken(engine, test, differences, notes, error, number)
    try:
        differences.extend(check_plan(engine, memory, test))
    except InferenceError as error:
        return _broken(engine, test, differences, notes, error, len(test.then))
    return CaseOutcome(test, engine.domain.source.path, tuple(differences), tuple(notes))


def _broken(
    engine: InferenceEngine,
    test: DomainTest,
    differences: Iterable[Difference],
    notes: Iterable[str],
    error: Exception,
    cycle: int,
) -> CaseOutcome:
    failure = Difference(Kind.ERROR, cycle, test.name, str(error), (), test.span)
    return CaseOutcome(test, engine.domain.source.path, (*differences, failure), tuple(notes))


def _compare(
    engine: InferenceEngine, memory: Memory, cycle: DomainTest | LaterCycle, number: int
) -> Iterator[Difference]:
    facts = memory.state.facts()
    for atom in cycle.expect:
        if not _matching(atom, facts):
            message = "nothing believed matches it" if atom.variables else "it is not believed"
            details = why_absent(atom, engine.domain, facts, engine.evaluator)
            yield Difference(Kind.MISSING, number, str(atom), message, details, atom.span)
    for atom in cycle.expect_not:
        found = _matching(atom, facts)
        if found:
            message = f"{found[0]} is believed"
            details = tuple(
                line
                for belief in found[:_MOST_EXPLAINED]
                for line in str(explain(belief, memory.state)).split("\n")
            )
            yield Difference(Kind.UNEXPECTED, number, str(atom), message, details, atom.span)


def _matching(atom: Atom, facts: FactStore) -> Sequence[Belief]:
    return [fact for fact in facts if match(atom, fact, {}) is not None]


def _percepts(atoms: Iterable[Atom]) -> Iterator[Percept]:
    for atom in atoms:
        values = _values(atom)
        if len(values) != 1 or not isinstance(values[0], str):
            raise FrameError(f"a percept has one name, such as (object o1 …); this one is {atom}")
        attributes = {name: t.value for name, t in atom.attributes if isinstance(t, Constant)}
        yield Percept(atom.predicate, values[0], attributes)


def _outcomes(actions: Iterable[Atom]) -> tuple[Outcome, ...]:
    return tuple(Outcome(Action(atom.predicate, _values(atom))) for atom in actions)


def _values(atom: Atom) -> tuple[Value, ...]:
    """Give the arguments of a ground atom; the checker has seen to it that it is ground."""
    return tuple(term.value for term in atom.args if isinstance(term, Constant))
