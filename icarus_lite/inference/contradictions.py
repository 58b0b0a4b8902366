"""Contradictions: what persists is withdrawn once what cannot go together with it has held.

Each cycle is judged by what would be believed if nothing were withdrawn in it, all contradictions
at once, so that their order does not matter. Of each belief that is in doubt it is counted for how
many cycles in a row it has been; an action that asserts it anew lets the count begin again.

It is belief revision in its simplest form: the newest evidence wins, after a delay (Gärdenfors 1988
calls it contraction); what rested on the belief goes with it, as in truth maintenance (Doyle 1979).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.inference.canonical import canonical
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.facts import Bindings, FactStore, match
from icarus_lite.inference.matching import Match
from icarus_lite.inference.supports import Assertion, Literal, Support, bind_literal
from icarus_lite.language.syntax import Contradiction
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief, Value


@dataclass(frozen=True, slots=True)
class Doubt:
    """A belief that a contradiction speaks against, though not yet for long enough.

    Args:
        rule: Which contradiction of the domain, by its place from 0.
        belief: The belief.
        cycles: For how many cycles in a row, from 1.
        limit: After how many it is withdrawn.
    """

    rule: int
    belief: Belief
    cycles: int
    limit: int

    def __str__(self) -> str:
        return f"what contradicts it has held for {self.cycles} of {self.limit} cycles"


@dataclass(frozen=True, slots=True)
class Withdrawal:
    """A belief that was asserted, and is withdrawn.

    Args:
        belief: The belief.
        because: What could not go together with it, each condition and test as the domain has it,
            with the values of the last cycle: `(apart plug case)`, `(not (held plug ?any))`.
        cycles: For how many cycles in a row that had held.
    """

    belief: Belief
    because: tuple[str, ...]
    cycles: int = 1

    def __str__(self) -> str:
        return f"{self.belief} was withdrawn: {self.reason}"

    @property
    def reason(self) -> str:
        """What held, and for how long, in words."""
        held = " and ".join(self.because)
        return f"{held} held" + (f" for {self.cycles} cycles" if self.cycles > 1 else "")


@dataclass(frozen=True, slots=True)
class Judgement:
    """What the contradictions of a domain come to in one cycle.

    Args:
        doubts: What is in doubt from now on, by contradiction, then as written.
        withdrawn: What is withdrawn, as written.
    """

    doubts: tuple[Doubt, ...] = ()
    withdrawn: tuple[Withdrawal, ...] = ()


def judge(
    rules: Sequence[Contradiction],
    given: Mapping[Belief, Sequence[Support]],
    facts: FactStore,
    cycle: int,
    before: Sequence[Doubt],
    evaluator: Evaluator,
) -> Judgement:
    """Judge the beliefs that persist by all that is perceived and believed in a cycle.

    Args:
        rules: The contradictions.
        given: The beliefs that rest on actions, each with what asserted it first.
        facts: Percepts and beliefs of the cycle.
        cycle: Its number.
        before: The doubts of the cycle before.
        evaluator: Evaluates the tests.

    Raises:
        InferenceError: a test cannot be evaluated.
    """
    counts = {(doubt.rule, doubt.belief): doubt.cycles for doubt in before}
    doubts: list[Doubt] = []
    withdrawn: dict[Belief, Withdrawal] = {}
    for number, rule in enumerate(rules):
        for belief, bound in _spoken_of(rule, given):
            ways = _ways(rule, bound, facts, evaluator)
            first = next(ways, None)
            if first is None:
                continue
            renewed = any(isinstance(s, Assertion) and s.cycle == cycle for s in given[belief])
            count = 1 if renewed else counts.get((number, belief), 0) + 1
            if count < rule.cycles:
                doubts.append(Doubt(number, belief, count, rule.cycles))
            elif belief not in withdrawn:
                because = _because(rule, (first, *ways))
                withdrawn[belief] = Withdrawal(belief, because, count)
    left = [doubt for doubt in doubts if doubt.belief not in withdrawn]
    return Judgement(
        tuple(sorted(left, key=lambda doubt: (doubt.rule, str(doubt.belief)))),
        tuple(sorted(withdrawn.values(), key=lambda each: str(each.belief))),
    )


def carried_over(
    doubts: Sequence[Doubt], old: Sequence[Contradiction], new: Sequence[Contradiction]
) -> tuple[Doubt, ...]:
    """Give the doubts that go on in an edited domain: those by contradictions that it still has.

    Args:
        doubts: The doubts by the old contradictions.
        old: The contradictions of before.
        new: Those of now.
    """
    places = {rule: number for number, rule in reversed([*enumerate(new)])}
    return tuple(
        Doubt(places[old[doubt.rule]], doubt.belief, doubt.cycles, doubt.limit)
        for doubt in doubts
        if old[doubt.rule] in places
    )


def _spoken_of(
    rule: Contradiction, given: Mapping[Belief, object]
) -> Iterator[tuple[Belief, dict[str, Value]]]:
    """Give the beliefs that match the head of a contradiction, with what it binds."""
    for belief in given:
        bound = match(rule.head, belief, {})
        if bound is not None:
            yield belief, bound


def _ways(
    rule: Contradiction, bound: Bindings, facts: FactStore, evaluator: Evaluator
) -> Iterator[Match]:
    matcher = evaluator.matcher(rule.elements, rule.tests, tuple(bound))
    return matcher.matches(facts, bound)


def _because(rule: Contradiction, ways: Sequence[Match]) -> tuple[str, ...]:
    """Say what held, in the way with the least values: whatever the order of the facts."""
    positive = [each.atom for each in rule.elements if not each.negated]
    names = dict.fromkeys(name for atom in positive for name in atom.variables)
    way = min(ways, key=lambda found: canonical(found.bindings[name] for name in names))
    literals: tuple[Literal, ...] = (*rule.elements, *rule.tests)
    return tuple(str(bind_literal(each, way.bindings)) for each in literals)
