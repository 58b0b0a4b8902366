"""Which values each argument of each predicate can ever take, whatever is done.

Signs are ignored and variables are looked at one by one, so the sets are larger than what can
come true, never smaller: what is not in them is impossible.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from typing import TypeAlias

from icarus_lite.language.pddl.attaching import Attaching, attachings
from icarus_lite.language.pddl.kinds import planned_skills
from icarus_lite.language.syntax import Atom, Condition, Constant, Domain, Term, Variable
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Belief, Value

Place: TypeAlias = tuple[str, int | str]
"""An argument of a predicate: its position, or the name of the attribute."""

Values: TypeAlias = dict[Value, None]
"""A set that keeps its order, for runs are to be repeatable."""


@dataclass(frozen=True, slots=True)
class PossibleValues:
    """The result.

    Args:
        places: Values by argument.
        possible: The predicates that can hold at all.
        fixed: The facts of the predicates that never change.
    """

    places: dict[Place, Values]
    possible: frozenset[str]
    fixed: dict[str, list[Belief]]

    def at(self, predicate: str, place: int | str) -> Values:
        """Give the values that an argument can take."""
        return self.places.get((predicate, place), {})

    def of(self, variable: str, conditions: Iterable[Condition]) -> Values:
        """Give the values that a variable can take where these conditions hold.

        Without a positive condition that binds it, there is none.
        """
        found: Values | None = None
        for condition in conditions:
            if condition.negated:
                continue
            for place, term in places_of(condition.atom):
                if isinstance(term, Variable) and term.name == variable:
                    here = self._here(condition.atom, place)
                    found = here if found is None else {v: None for v in found if v in here}
        return found or {}

    def _here(self, atom: Atom, place: int | str) -> Values:
        """Give the values of an argument in an atom: of what never changes, exactly."""
        if atom.predicate not in self.fixed:
            return self.at(atom.predicate, place)
        found: Values = {}
        for fact in self.fixed[atom.predicate]:
            given: dict[int | str, Value] = dict(enumerate(fact.args))
            given.update(fact.attributes.items())
            fits = all(
                where in given and (isinstance(term, Variable) or given[where] == term.value)
                for where, term in places_of(atom)
            )
            if fits:
                found[given[place]] = None
        return found

    def can_hold(self, conditions: Sequence[Condition]) -> bool:
        """Tell whether the positive conditions could hold together, as far as values tell."""
        positive = [condition for condition in conditions if not condition.negated]
        if any(condition.atom.predicate not in self.possible for condition in positive):
            return False
        for condition in positive:
            for place, term in places_of(condition.atom):
                if isinstance(term, Constant):
                    if term.value not in self.at(condition.atom.predicate, place):
                        return False
                elif not self.of(term.name, positive):
                    return False
        return True


def places_of(atom: Atom) -> list[tuple[int | str, Term]]:
    """Give the arguments and attributes of an atom, each with its place."""
    return [*enumerate(atom.args), *atom.attributes]


def possible_values(
    domain: Domain, facts: Iterable[Belief], changing: Collection[str]
) -> PossibleValues:
    """Find the values of all arguments that facts, concepts and skills can give.

    Args:
        domain: The domain.
        facts: All that is believed at the start.
        changing: The predicates that skills change, directly or through concepts.
    """
    fixed: dict[str, list[Belief]] = {}
    places: dict[Place, Values] = {}
    possible: dict[str, None] = {}
    for fact in facts:
        possible[fact.predicate] = None
        if fact.predicate not in changing:
            fixed.setdefault(fact.predicate, []).append(fact)
        named: list[tuple[int | str, Value]] = [*enumerate(fact.args), *fact.attributes.items()]
        for place, value in named:
            places.setdefault((fact.predicate, place), {})[value] = None
    skills = [(clause, attachings(domain, clause)) for clause in planned_skills(domain)]
    found, before = PossibleValues(places, frozenset(possible), fixed), -1
    while before != sum(map(len, places.values())) + len(possible):
        before = sum(map(len, places.values())) + len(possible)
        found = PossibleValues(places, frozenset(possible), fixed)
        for concept in domain.concepts:
            if concept.head.predicate in changing and found.can_hold(concept.elements):
                _spread(concept.head, concept.elements, found, possible)
        for clause, attaching in skills:
            if not found.can_hold(clause.elements):
                continue
            stated = [effect.atom for effect in clause.effects if not effect.negated]
            for atom in (*stated, *map(_attached, attaching)):
                _spread(atom, clause.elements, found, possible)
    return found


def _attached(attaching: Attaching) -> Atom:
    return Atom(ATTACHED, (attaching.child, attaching.parent))


def _spread(
    atom: Atom, conditions: Sequence[Condition], found: PossibleValues, possible: dict[str, None]
) -> None:
    given = [
        (
            place,
            {term.value: None} if isinstance(term, Constant) else found.of(term.name, conditions),
        )
        for place, term in enumerate(atom.args)
    ]
    if all(values for _, values in given):
        possible[atom.predicate] = None
        for place, values in given:
            found.places.setdefault((atom.predicate, place), {}).update(values)
