"""What grounding needs to know of a clause, whatever is believed: its parts, sorted."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    SkillClause,
    Term,
    variables_of,
)
from icarus_lite.planning.grounding.attaching import Attaching
from icarus_lite.planning.grounding.views import names_of, terms_of
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class TimedTest:
    """A test, and the conditions that must have been met before it may be asked.

    Args:
        test: The test.
        after: The conditions, by their places; empty for a test that can never fail to have an
            answer.
    """

    test: Call
    after: frozenset[int]


@dataclass(frozen=True, slots=True)
class GroundedClause:
    """A clause in the form in which it is ground.

    Args:
        number: Its place among the clauses that are ground together.
        clause: The clause as written.
        variables: The variables that its conditions bind, in order of occurrence.
        positive: Its positive conditions, in the order written.
        fluent: Which of these can change, by place.
        denials: Its negated conditions on what can change.
        static_denials: Its negated conditions on what stays as it is.
        tests: Its tests.
        effects: What an instance makes true; the head, for a concept. What it says about
            attachments is in `attaching`.
        removals: The patterns of what an instance ends.
        attaching: What it does to the attachment hierarchy, if anything.
    """

    number: int
    clause: SkillClause | ConceptClause
    variables: tuple[str, ...]
    positive: tuple[Atom, ...]
    fluent: frozenset[int]
    denials: tuple[Atom, ...]
    static_denials: tuple[Atom, ...]
    tests: tuple[TimedTest, ...]
    effects: tuple[Atom, ...]
    removals: tuple[Atom, ...]
    attaching: Attaching | None = None

    @property
    def skill(self) -> SkillClause:
        """The clause as written, which must be that of a skill."""
        assert isinstance(self.clause, SkillClause)
        return self.clause


def timed_tests(tests: Sequence[Call], positive: Sequence[Atom]) -> tuple[TimedTest, ...]:
    """Say of each test which conditions come before it, as the semantics has it.

    A test is asked as soon as its variables are bound, conditions taken as written: what these
    rule out it is never asked about. One that has an answer whatever it is asked need not wait.
    """
    known: set[str] = set()
    ready = [frozenset[str]()]
    for atom in positive:
        known.update(atom.variables)
        ready.append(frozenset(known))
    timed = []
    for test in tests:
        needed = set(variables_of(test))
        turn = next((t for t, names in enumerate(ready) if needed <= names), len(positive))
        harmless = _has_an_answer(test) and needed <= known
        timed.append(TimedTest(test, frozenset() if harmless else frozenset(range(turn))))
    return tuple(timed)


def _has_an_answer(test: Call) -> bool:
    return test.function in ("=", "/=") and not any(isinstance(a, Call) for a in test.args)


def is_bound(atom: Atom, names: Collection[str]) -> bool:
    """Tell whether all variables of a pattern are among these names."""
    return all(name in names for name in atom.variables)


def cells_of(atom: Atom) -> tuple[tuple[Term, ...], tuple[tuple[str, Term], ...]]:
    """Give the arguments of a pattern, and its attributes sorted by name."""
    terms = terms_of(atom)
    size = len(atom.args)
    return terms[:size], tuple(zip(names_of(atom), terms[size:], strict=True))
