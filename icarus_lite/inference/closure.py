"""The stratified least model: every belief that follows from the given facts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from functools import partial

from icarus_lite.inference.canonical import canonical
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.facts import FactStore
from icarus_lite.inference.rules import Rule
from icarus_lite.inference.supports import Support
from icarus_lite.language.checking.stratification import recursive_concepts, strata
from icarus_lite.language.syntax import ConceptClause
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief


@dataclass(frozen=True, slots=True)
class _Component:
    """Concepts that depend on one another, mostly a single one, with their rules as written."""

    concepts: frozenset[str]
    rules: tuple[Rule, ...]
    recursive: bool
    numbers: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Limits:
    """What deriving may cost.

    Args:
        most: How many beliefs of one concept may be derived.
        tick: Is called now and then with the number of the clause that is being joined; it raises
            an error when the time is over.
        too_many: Is called with the number of a clause that concludes more; it raises an error.
    """

    most: int
    tick: Callable[[int], None]
    too_many: Callable[[int], None]


class Closure:
    """Concepts, arranged by stratum so that a `not` is asked only once its answer is final.

    Edge from a head to a negated predicate: strictly lower stratum; to a positive one: the same
    or lower. Concepts that do not depend on themselves are inferred in one pass. The others are
    repeated until nothing new comes out, each rule joining only what touches a fact that is new
    since the rule was last asked.

    The order of beliefs and of their derivations is that of asking all rules of a stratum again
    and again, in the order of the text, each over all facts: rules as written; of one rule, first
    what rests on the facts that were believed first, its first condition counting most.

    Attributes are functional: what is given decides before any clause; then the round of asking
    in which a belief first follows, in it the clause written first, and of that clause the
    canonically least values. So they depend on the facts, not on the order these came in.

    Raises:
        InferenceError: the concepts negate through recursion.
    """

    __slots__ = ("_components", "concepts")

    def __init__(
        self, clauses: Iterable[ConceptClause], evaluator: Evaluator | None = None
    ) -> None:
        evaluator = evaluator or Evaluator()
        known = tuple(clauses)
        recursive = recursive_concepts(known)
        self.concepts = frozenset(clause.head.predicate for clause in known)
        by_concept: dict[str, list[int]] = {}
        for number, clause in enumerate(known):
            by_concept.setdefault(clause.head.predicate, []).append(number)
        components = []
        for layer in strata(known):
            grows = not recursive.isdisjoint(layer)
            growing = frozenset(layer) if grows else frozenset()
            numbers = sorted(number for concept in layer for number in by_concept[concept])
            rules = tuple(Rule(known[number], growing, evaluator) for number in numbers)
            components.append(_Component(frozenset(layer), rules, grows, tuple(numbers)))
        self._components = tuple(components)

    def derive(
        self,
        facts: FactStore,
        denied: frozenset[Belief] = frozenset(),
        among: frozenset[str] | None = None,
        limits: Limits | None = None,
    ) -> dict[Belief, tuple[Support, ...]]:
        """Add to the facts all beliefs that follow from them.

        Args:
            facts: Percepts and asserted beliefs; the derived beliefs are added to it.
            denied: Beliefs that must not be derived, whatever the clauses say. The planner uses
                this to imagine an effect that perception has not confirmed yet.
            among: The concepts to derive; the beliefs of the others are taken to be there. All
                concepts if None.
            limits: What it may cost; clauses are numbered as they were given.

        Returns:
            Each derived belief with its derivations. The first never rests on the belief itself,
            so that following first derivations always ends at the given facts.

        Raises:
            InferenceError: a test or a bind cannot be evaluated; the text has the place.
        """
        found: dict[Belief, list[Support]] = {}
        counts: Counter[str] = Counter()
        for component in self._components:
            if among is not None and component.concepts.isdisjoint(among):
                continue
            asked = [0] * len(component.rules)
            first, fresh = True, True
            while fresh and (first or component.recursive):
                fresh = False
                for number, rule in enumerate(component.rules):
                    since, asked[number] = asked[number], facts.count
                    # All of it before any is added: a rule does not see what it just concluded.
                    clause = component.numbers[number]
                    tick = None if limits is None else partial(limits.tick, clause)
                    follows = tuple(
                        rule.all(facts, tick) if first else rule.new(facts, since, tick)
                    )
                    decided = _least(belief for belief, _ in follows)
                    for concluded, derivation in follows:
                        if concluded in denied:
                            continue
                        belief = decided.get(concluded, concluded)
                        supports = found.get(belief)
                        if supports is None:
                            found[belief] = [derivation]
                            counts[belief.predicate] += 1
                            if limits is not None and counts[belief.predicate] > limits.most:
                                limits.too_many(clause)
                        else:
                            supports.append(derivation)
                        fresh |= facts.add(belief)
                first = False
        return {belief: tuple(supports) for belief, supports in found.items()}


def _least(beliefs: Iterable[Belief]) -> dict[Belief, Belief]:
    """Give, of beliefs concluded by one clause that differ in attributes, the least of each."""
    least: dict[Belief, Belief] = {}
    for belief in beliefs:
        if belief.attributes:
            known = least.setdefault(belief, belief)
            if known is not belief and _attributes(belief) < _attributes(known):
                del least[belief]
                least[belief] = belief
    return least


def _attributes(belief: Belief) -> tuple[tuple[object, ...], ...]:
    """Give what beliefs of one clause are ordered by: the attributes as its head writes them."""
    return canonical(belief.attributes.values())
