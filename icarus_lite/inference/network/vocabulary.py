"""Which predicates a domain concludes, perceives or is given."""

from __future__ import annotations

from collections.abc import Mapping

from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.facts import Lineages
from icarus_lite.language.checking.stratification import recursive_concepts, strata
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Domain
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """What there is to know about predicates before any clause is compiled.

    Args:
        lineages: Each percept type with all types that its percepts belong to, its own first.
        layers: The concepts that depend on one another, bottom first.
        recursive: The concepts that are used in their own definition.
        given: The concepts that may be given as well: asserted, or perceived.
        attributes: For each concept the names of the attributes that some head has.
        evaluator: Evaluates the tests and binds of the domain.
    """

    lineages: Lineages
    layers: tuple[tuple[str, ...], ...]
    recursive: frozenset[str]
    given: frozenset[str]
    attributes: Mapping[str, tuple[str, ...]]
    evaluator: Evaluator

    @classmethod
    def of(cls, domain: Domain, evaluator: Evaluator, given: frozenset[str]) -> Vocabulary:
        """Read it off a domain.

        Raises:
            NotStratifiedError: a concept depends on its own negation.
        """
        attributes: dict[str, dict[str, None]] = {}
        for clause in domain.concepts:
            names = dict.fromkeys(name for name, _ in clause.head.attributes)
            attributes.setdefault(clause.head.predicate, {}).update(names)
        types = lineages(domain.percepts)
        perceived = frozenset(types) & frozenset(attributes)
        return cls(
            types,
            strata(domain.concepts),
            recursive_concepts(domain.concepts),
            given | perceived,
            {concept: tuple(names) for concept, names in attributes.items()},
            evaluator,
        )

    def is_concept(self, predicate: str) -> bool:
        """Tell whether clauses conclude it."""
        return predicate in self.attributes

    def has_objects(self, predicate: str, arity: int) -> bool:
        """Tell whether its facts are objects, kept in a table: perceived, or given as such."""
        return arity == 1 and predicate not in self.attributes

    def is_attributed(self, concept: str) -> bool:
        """Tell whether its beliefs may come with attributes, so that those have to be settled."""
        return bool(self.attributes[concept]) or concept in self.given
