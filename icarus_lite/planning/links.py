"""Which step of a plan serves which condition: the plan carried out in the mind, looked back at.

Everything is read off the stages that the plan passes through, so that attachments, persisting
effects and derived concepts are treated as the engine treats them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from icarus_lite.inference import Derivation, Matcher, bind_pattern, match
from icarus_lite.language.syntax import Atom, Condition, Constant, Variable
from icarus_lite.planning.causes import Need, Needs, pattern_of
from icarus_lite.planning.naming import objects_of
from icarus_lite.planning.plan import Plan
from icarus_lite.planning.projection import Projection, Stage
from icarus_lite.planning.situation import Imagination
from icarus_lite.records import replace
from icarus_lite.symbols import Belief, Value

MOST_ALTERNATIVES = 8
"""Supports of one belief that are compared for the one that waits for the fewest steps."""


def with_links(imagination: Imagination, plan: Plan, projection: Projection) -> Plan:
    """Give a plan with its causal links.

    Args:
        imagination: Has carried it out.
        plan: The plan, its goals known.
        projection: How it was carried out. One that does not reach the goal gives no links.
    """
    if not projection.valid:
        return plan
    finder = _Finder(projection.stages)
    evaluator = imagination.evaluator
    needs: list[Needs] = []
    for number, step in enumerate(projection.steps):
        clause = step.clause
        kept = _objects(dict(step.bindings), objects_of(clause))
        matcher = Matcher(clause.elements, clause.tests, tuple(kept), evaluator)
        needs.append(finder.needs(number, number, clause.elements, matcher, kept))
    last = len(projection.steps)
    needs.append(finder.needs(None, last, plan.goals, Matcher(plan.goals, evaluator=evaluator), {}))
    return replace(plan, steps=projection.steps, needs=tuple(needs))


class _Finder:
    """Finds what a literal rests on at some stage of a plan."""

    def __init__(self, stages: Sequence[Stage]) -> None:
        self._stages = stages
        self._given = [{fact: fact for fact in stage.given} for stage in stages]
        self._facts = [stage.facts for stage in stages]
        self._ended = _ended(stages, self._given)
        self._believed: dict[tuple[Atom, int], Need] = {}
        self._absent: dict[tuple[Atom, int], Need] = {}

    def needs(
        self,
        consumer: int | None,
        at: int,
        conditions: Sequence[Condition],
        matcher: Matcher,
        kept: dict[str, Value],
    ) -> Needs:
        """Say what a conjunction rests on at a stage at which it holds."""
        found = next(matcher.matches(self._stages[at].facts, kept))
        matched = iter(found.matched)
        bindings = {**found.bindings, **kept}
        objects = {n for c in conditions for n in _argument_names(c.atom)}
        parts = []
        for condition in conditions:
            pattern = bind_pattern(condition.atom, _objects(bindings, objects))
            if condition.negated:
                parts.append(self._absence(pattern, at, frozenset()))
            else:
                fact = next(matched)
                parts.append(self._presence(_stated(pattern, fact), fact, at, frozenset()))
        return Needs(consumer, tuple(parts))

    def _presence(self, pattern: Atom, fact: Belief, at: int, above: frozenset[Belief]) -> Need:
        """Say what a belief rests on at a stage."""
        known = self._believed.get((pattern, at))
        if known is None:
            known = self._believed[pattern, at] = self._support(pattern, fact, at, above)
        return known

    def _support(self, pattern: Atom, fact: Belief, at: int, above: frozenset[Belief]) -> Need:
        literal = Condition(pattern)
        if fact in self._given[at]:
            return Need(literal, self._given_since(pattern, fact, at))
        since = self._since(fact, at)
        best: Need | None = None
        for support in self._stages[at].supports.get(fact, ())[:MOST_ALTERNATIVES]:
            if not isinstance(support, Derivation):
                continue
            if best is not None and not above.isdisjoint({fact, *support.matched}):
                continue  # an alternative that may rest on what it is to support
            found = self._derived(literal, support, at, above | {fact})
            if best is None or _producer(found) < _producer(best):
                best = found
            if best.producer is None:
                break
        if since is not None and (best is None or _producer(best) < since):
            return Need(literal, since)  # an effect had denied it, and this one no longer does
        return best or Need(literal)

    def _derived(
        self, literal: Condition, support: Derivation, at: int, above: frozenset[Belief]
    ) -> Need:
        """Say what a derived belief rests on; what holds from the start is not taken apart."""
        bindings = _objects(support.bindings, objects_of(support.clause))
        matched, premises = iter(support.matched), []
        for condition in support.clause.elements:
            pattern = bind_pattern(condition.atom, bindings)
            if condition.negated:
                premises.append(self._absence(pattern, at, above))
            else:
                fact = next(matched)
                premises.append(self._presence(_stated(pattern, fact), fact, at, above))
        producer = _latest(premises)
        return Need(literal, producer, () if producer is None else tuple(premises))

    def _since(self, fact: Belief, at: int) -> int | None:
        """Give the step since which a belief holds without a break; None for from the start."""
        return next((n for n in range(at - 1, -1, -1) if fact not in self._facts[n]), None)

    def _given_since(self, pattern: Atom, fact: Belief, at: int) -> int | None:
        """Give the step since which a belief is given with the values that a pattern asks for."""
        values = [fact.attributes.get(name) for name, _ in pattern.attributes]
        for number in range(at - 1, -1, -1):
            then = self._given[number].get(fact)
            if then is None or [then.attributes.get(n) for n, _ in pattern.attributes] != values:
                return number
        return None

    def _absence(self, pattern: Atom, at: int, above: frozenset[Belief]) -> Need:
        """Say what keeps a stage free of a pattern."""
        known = self._absent.get((pattern, at))
        if known is None:
            last = {
                fact: (number, fact)  # the later entry counts
                for number, fact in self._ended.get(pattern.predicate, ())
                if number < at and match(pattern, fact, {}) is not None
            }
            gone = tuple(self._end(fact, number, at, above) for number, fact in last.values())
            known = Need(Condition(pattern, negated=True), _latest(gone), gone=gone)
            self._absent[pattern, at] = known
        return known

    def _end(self, fact: Belief, number: int, at: int, above: frozenset[Belief]) -> Need:
        """Say what has ended a belief that holds no longer since some step."""
        if fact in self._given[number] and fact in self._given[number + 1]:
            # It goes on, with other attributes.
            named = tuple((name, Constant(value)) for name, value in fact.attributes.items())
            ended = replace(pattern_of(fact), attributes=named)
            return Need(Condition(ended, negated=True), number)
        literal = Condition(pattern_of(fact), negated=True)
        before, after = self._stages[number], self._stages[number + 1]
        denied = fact in after.situation.denied and fact not in before.situation.denied
        if fact in self._given[number] or denied or fact in above:
            return Need(literal, number)
        premises: dict[Need, None] = {}
        for support in self._supports_until(fact, at):
            premises[self._broken(support, at, above | {fact})] = None
        waiting = tuple(premise for premise in premises if premise.producer is not None)
        if not waiting:
            return Need(literal, number)
        return Need(literal, max(number, _producer_of(waiting)), waiting)

    def _supports_until(self, fact: Belief, at: int) -> Iterator[Derivation]:
        """Give all ways in which a belief was derived before a stage."""
        seen: set[tuple[tuple[Belief, ...], tuple[Atom, ...]]] = set()
        for stage in self._stages[:at]:
            for support in stage.supports.get(fact, ()):
                if isinstance(support, Derivation):
                    key = support.matched, support.absent
                    if key not in seen:
                        seen.add(key)
                        yield support

    def _broken(self, support: Derivation, at: int, above: frozenset[Belief]) -> Need:
        """Give the first condition of a derivation that fails at a stage, and why it does."""
        facts = self._stages[at].facts
        for fact in support.matched:
            if fact not in facts:
                pattern = pattern_of(fact)
                if fact in above:
                    return Need(Condition(pattern, negated=True))
                return self._absence(pattern, at, above)
        for absent in support.absent:
            for _, fact in facts.matches(absent, {}):
                return self._presence(pattern_of(fact), fact, at, above)
        return Need(Condition(support.clause.head))


def _ended(
    stages: Sequence[Stage], given: Sequence[Mapping[Belief, Belief]]
) -> Mapping[str, Sequence[tuple[int, Belief]]]:
    """Give, by predicate, the beliefs that end, each with the step that it ends with.

    What is given anew with other attributes has ended as what it was.
    """
    ended: dict[str, list[tuple[int, Belief]]] = {}
    for number in range(len(stages) - 1):
        after = stages[number + 1].facts
        for fact in stages[number].facts:
            if fact not in after:
                ended.setdefault(fact.predicate, []).append((number, fact))
        following = given[number + 1]
        altered = [f for f in given[number] if following.get(f, f).attributes != f.attributes]
        for fact in sorted(altered, key=str):
            ended.setdefault(fact.predicate, []).append((number, fact))
    return ended


def _objects(bindings: Mapping[str, Value], names: Iterable[str]) -> dict[str, Value]:
    return {name: bindings[name] for name in names if name in bindings}


def _argument_names(atom: Atom) -> Iterator[str]:
    return (term.name for term in atom.args if isinstance(term, Variable))


def _stated(pattern: Atom, fact: Belief) -> Atom:
    """Fill the arguments of a pattern in from the fact that has met it."""
    return replace(pattern, args=tuple(map(Constant, fact.args)))


def _latest(needs: Iterable[Need]) -> int | None:
    return max((need.producer for need in needs if need.producer is not None), default=None)


def _producer(need: Need) -> int:
    return -1 if need.producer is None else need.producer


def _producer_of(needs: Sequence[Need]) -> int:
    return max(map(_producer, needs))
