"""The stratified least model: every belief that follows from the given facts."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from icarus_lite.errors import InferenceError
from icarus_lite.inference.facts import FactStore, ground
from icarus_lite.inference.matching import Evaluator, Match, Matcher
from icarus_lite.inference.supports import Derivation, Support, bind_pattern
from icarus_lite.language.stratification import strata
from icarus_lite.language.syntax import ConceptClause
from icarus_lite.symbols import Belief


@dataclass(frozen=True, slots=True)
class _Rule:
    clause: ConceptClause
    matcher: Matcher


class Closure:
    """Concepts, arranged by stratum so that a `not` is asked only once its answer is final.

    Edge from a head to a negated predicate: strictly lower stratum; to a positive one: the same
    or lower. Within a stratum the clauses are repeated until nothing new comes out.

    Raises:
        InferenceError: the concepts negate through recursion.
    """

    __slots__ = ("_evaluator", "_strata", "concepts")

    def __init__(
        self, clauses: Iterable[ConceptClause], evaluator: Evaluator | None = None
    ) -> None:
        self._evaluator = evaluator or Evaluator()
        known = tuple(clauses)
        self.concepts = frozenset(clause.head.predicate for clause in known)
        self._strata = tuple(
            tuple(
                _Rule(c, Matcher(c.elements, c.tests, evaluator=self._evaluator))
                for c in known
                if c.head.predicate in layer
            )
            for layer in strata(known)
        )

    def derive(
        self, facts: FactStore, denied: frozenset[Belief] = frozenset()
    ) -> dict[Belief, tuple[Support, ...]]:
        """Add to the facts all beliefs that follow from them.

        Args:
            facts: Percepts and asserted beliefs; the derived beliefs are added to it.
            denied: Beliefs that must not be derived, whatever the clauses say. The planner uses
                this to imagine an effect that perception has not confirmed yet.

        Returns:
            Each derived belief with its derivations. The first never rests on the belief itself,
            so that following first derivations always ends at the given facts.

        Raises:
            InferenceError: a test or a bind cannot be evaluated; the text has the place.
        """
        found: dict[Belief, dict[tuple[int, str], Support]] = {}
        for rules in self._strata:
            fresh = True
            while fresh:
                fresh = False
                for number, rule in enumerate(rules):
                    for belief, match in tuple(self._heads(rule, facts)):
                        if belief in denied:
                            continue
                        supports = found.setdefault(belief, {})
                        key = (number, repr(sorted(match.bindings.items())))
                        if key not in supports:
                            supports[key] = _derivation(rule.clause, match)
                        fresh |= facts.add(belief)
        return {belief: tuple(supports.values()) for belief, supports in found.items()}

    def _heads(self, rule: _Rule, facts: FactStore) -> Iterator[tuple[Belief, Match]]:
        for match in rule.matcher.matches(facts):
            bindings = dict(match.bindings)
            for bind in rule.clause.binds:
                bindings[bind.variable.name] = self._evaluator(bind.expression, bindings)
            belief = ground(rule.clause.head, bindings)
            if belief is None:
                raise InferenceError(f"a variable of the head {rule.clause.head} is never bound")
            yield belief, replace(match, bindings=bindings)


def _derivation(clause: ConceptClause, match: Match) -> Derivation:
    absent = tuple(bind_pattern(atom, match.bindings) for atom in match.absent)
    return Derivation(clause, match.bindings, match.matched, absent)
