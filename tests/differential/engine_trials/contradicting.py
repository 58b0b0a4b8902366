"""Random domains with contradictions, and what becomes of beliefs under them, by counting.

For the second opinion a contradiction is a concept: a belief is contradicted if the concept whose
clause asks for it, and for what contradicts it, is believed. So clingo says what is contradicted;
what is left to do here is to count cycles.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from engine_trials.clingo_oracle import ClingoOracle
from engine_trials.histories import Change, World, worlds
from engine_trials.programs import ProgramDraw
from engine_trials.scratch import Row
from engine_trials.trial import Trial
from engine_trials.vocabulary import Kind, Vocabulary
from icarus_lite import Belief
from icarus_lite.inference.facts import ground
from icarus_lite.language import check_domain, has_errors, parse_domain
from icarus_lite.language.syntax import (
    Atom,
    ConceptClause,
    Condition,
    Contradiction,
    Domain,
    Variable,
)

_CONTRADICTED = "contradicted-"


@dataclass(frozen=True, slots=True)
class Revision:
    """A trial whose domain has contradictions."""

    trial: Trial
    contradictions: tuple[Contradiction, ...]

    def text(self) -> str:
        """Write the domain as an .icr file."""
        return f"{self.trial.text()}{_written(self.contradictions)}"

    def domain(self) -> Domain:
        """Give the domain as the reader reads it.

        Raises:
            ValueError: it cannot be read or has errors.
        """
        domain, problems = parse_domain(self.text(), f"seed-{self.trial.seed}.icr")
        problems = (*problems, *(check_domain(domain) if domain is not None else ()))
        if domain is None or has_errors(problems):
            raise ValueError([f"{each.code} {each.message}" for each in problems])
        return domain


class ContradictionDraw(ProgramDraw):
    """Draws contradictions beside the clauses of a domain."""

    def contradictions(self) -> tuple[Contradiction, ...]:
        """Draw some, of what only actions assert; they may read whatever there is."""
        return tuple(self._contradiction() for _ in range(self._draw.randint(1, 5)))

    def _contradiction(self) -> Contradiction:
        words = self._words
        everything = self._below(len(words.layers))
        head = self._pattern(self._draw.choice(words.asserted), ())
        count = self._draw.choice((0, 1, 1, 1, 2))
        others = [self._pattern(self._draw.choice(everything), ()) for _ in range(count)]
        drawn = self._completed(words.asserted[0], [head, *others], everything, words.layers[0])
        first = drawn.elements.index(Condition(head))
        elements = (*drawn.elements[:first], *drawn.elements[first + 1 :])
        cycles = self._draw.choice((1, 2, 2, 3, 3, 4))
        return Contradiction(head, elements, drawn.tests, cycles)


def draw_revision(seed: int, trial: Trial) -> Revision:
    """Draw contradictions for the domain of a trial, and more to be asserted in its history.

    A few beliefs that the contradictions speak of are asserted again and again, so that there is
    something to be withdrawn in most cycles.
    """
    draw = random.Random(f"contradictions of seed {seed}")
    found: tuple[Contradiction, ...] = ()
    while not found:
        drawn = ContradictionDraw(draw, trial.vocabulary).contradictions()
        found = tuple(each for each in drawn if each.elements or each.tests)
    pool = [_belief(draw, draw.choice(found).head, trial.vocabulary) for _ in range(8)]
    history = tuple(_asserting(draw, change, pool) for change in trial.history)
    return Revision(replace(trial, history=history), found)


def _belief(draw: random.Random, head: Atom, words: Vocabulary) -> Belief:
    """Draw a belief that a head may match."""
    bound = {}
    for term, kind in zip(head.args, words.signatures[head.predicate].args, strict=True):
        if isinstance(term, Variable):
            number = kind is Kind.NUMBER or (kind is Kind.ANY and draw.random() < 0.5)
            bound.setdefault(term.name, draw.choice(words.numbers if number else words.symbols))
    found = ground(Atom(head.predicate, head.args), bound)
    assert found is not None
    return found


def _asserting(draw: random.Random, change: Change, pool: Sequence[Belief]) -> Change:
    share = draw.choice((0.1, 0.3, 0.3, 0.6))
    fresh = [each for each in pool if draw.random() < share and each not in change.withdrawn]
    return replace(change, asserted=tuple(dict.fromkeys((*change.asserted, *fresh))))


@dataclass(slots=True)
class Counting:
    """What persists, and for how long it has been contradicted: by the book, and slowly.

    Args:
        revision: The domain.

    Attributes:
        asserted: What persists, each with the cycle in which it was asserted last.
        counts: By contradiction and belief, for how many cycles it has been contradicted.
    """

    revision: Revision
    asserted: dict[Belief, int] = field(default_factory=dict)
    counts: dict[tuple[int, Belief], int] = field(default_factory=dict)
    _known: set[str] = field(default_factory=set)
    _oracle: ClingoOracle = field(init=False)

    def __post_init__(self) -> None:
        domain = self.revision.domain()
        rules = enumerate(self.revision.contradictions)
        more = tuple(_as_concept(number, rule) for number, rule in rules)
        self._oracle = ClingoOracle(replace(domain, concepts=(*domain.concepts, *more)))

    def step(
        self, cycle: int, change: Change, world: World
    ) -> tuple[frozenset[Row], dict[Belief, int]]:
        """Go on by a cycle.

        Returns:
            The beliefs, and what was withdrawn, each with the cycles for which it had been
            contradicted, by the first contradiction that ended it.
        """
        for belief in change.withdrawn:
            self.asserted.pop(belief, None)
        for belief in change.asserted:
            self.asserted.pop(belief, None)
            self.asserted[belief] = cycle
        present = {percept.name for percept in world.percepts}
        self._known |= present
        gone = self._known - present
        self.asserted = {b: when for b, when in self.asserted.items() if not gone & {*b.args}}
        held = self._held(world)
        contradicted = self._contradicted(held)
        withdrawn: dict[Belief, int] = {}
        counts: dict[tuple[int, Belief], int] = {}
        for number, belief in contradicted:
            renewed = self.asserted[belief] == cycle
            count = 1 if renewed else self.counts.get((number, belief), 0) + 1
            if count >= self.revision.contradictions[number].cycles:
                withdrawn.setdefault(belief, count)
            else:
                counts[number, belief] = count
        for belief in withdrawn:
            del self.asserted[belief]
        self.counts = {key: n for key, n in counts.items() if key[1] not in withdrawn}
        return _beliefs(self._held(world) if withdrawn else held), withdrawn

    def _contradicted(self, held: frozenset[Row]) -> list[tuple[int, Belief]]:
        found = []
        for number, rule in enumerate(self.revision.contradictions):
            order = _variables(rule.head)
            for name, args, _ in held:
                if name == f"{_CONTRADICTED}{number}":
                    head = Atom(rule.head.predicate, rule.head.args)
                    belief = ground(head, dict(zip(order, args, strict=True)))
                    assert belief is not None
                    if belief in self.asserted and (number, belief) not in found:
                        found.append((number, belief))
        return found

    def _held(self, world: World) -> frozenset[Row]:
        (held,) = self._oracle.beliefs([World(world.percepts, tuple(self.asserted))])
        return held


def _beliefs(held: frozenset[Row]) -> frozenset[Row]:
    return frozenset(each for each in held if not each[0].startswith(_CONTRADICTED))


def history_of(trial: Trial) -> Sequence[tuple[Change, World]]:
    """Give the changes of a trial with what is perceived after each."""
    return list(zip(trial.history, worlds(trial.history), strict=True))


def _as_concept(number: int, rule: Contradiction) -> ConceptClause:
    head = Atom(f"{_CONTRADICTED}{number}", tuple(map(Variable, _variables(rule.head))))
    return ConceptClause(head, (Condition(rule.head), *rule.elements), rule.tests)


def _variables(head: Atom) -> tuple[str, ...]:
    """Give the variables among the arguments of a head, each once."""
    return tuple(dict.fromkeys(t.name for t in head.args if isinstance(t, Variable)))


def _written(contradictions: Sequence[Contradiction]) -> str:
    lines = ["(contradictions"]
    for each in contradictions:
        parts = [f"  ({each.head}"]
        if each.elements:
            parts.append(f":elements ({' '.join(map(str, each.elements))})")
        if each.tests:
            parts.append(f":tests ({' '.join(map(str, each.tests))})")
        lines.append("\n   ".join([*parts, f":cycles {each.cycles})"]))
    return "\n".join(lines) + ")\n"
