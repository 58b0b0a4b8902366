"""What of a planning problem in literals can matter: the rest is left out."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.planning.grounding.attaching import Attach
from icarus_lite.planning.grounding.instances import Derivation, Instance, Literals, fact_of
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import Value


@dataclass(frozen=True, slots=True)
class Simplified:
    """What matters.

    Args:
        instances: The operators that bring about what something needs.
        derivations: The derivations of each derived fact that something needs.
        needed: The literals that something needs.
        goal: The literals of the goal that do not hold for ever; None if one never can.
        impossible: The facts that never hold.
    """

    instances: list[Instance]
    derivations: dict[int, list[Derivation]]
    needed: set[int]
    goal: tuple[int, ...] | None
    impossible: set[int]


def simplify(problem: Literals, goal: Sequence[int] | None) -> Simplified:
    """Leave out what never changes, what cannot be, and what leads to nothing that is needed.

    Args:
        problem: The problem; the facts found to be constant are added to it.
        goal: The literals to achieve; None keeps all that any condition speaks of.
    """
    impossible = _settle(problem)
    instances = list(_possible(problem, impossible))
    derivations = {head: ways for head, ways in problem.derivations.items() if ways}
    if goal is None:
        every = set(range(len(problem.atoms))) - problem.constant - impossible
        needed = every.union(~number for number in every)
        return Simplified(instances, derivations, needed, (), impossible)
    left = left_of(goal, problem.constant, impossible)
    kept, needed = _chain_back(problem, instances, derivations, left or ())
    if left is None:
        kept = set()
    instances = [each for number, each in enumerate(instances) if number in kept]
    both = {fact_of(literal) for literal in needed}
    derivations = {head: ways for head, ways in derivations.items() if head in both}
    return Simplified(instances, derivations, needed, left, impossible)


def _settle(problem: Literals) -> set[int]:
    """Settle which derived facts hold for ever, and which facts never can."""
    constant, derivations = problem.constant, problem.derivations
    made = set(problem.initial).union(constant)
    for each in problem.instances:
        made.update(each.adds, each.expected)
        made.update(*(numbers for _, numbers in each.hierarchy))
    impossible = {
        number
        for number in range(len(problem.atoms))
        if number not in made and number not in derivations
    }
    for head in constant.intersection(derivations):
        del derivations[head]
    changed = True
    while changed:
        changed = False
        for head, ways in list(derivations.items()):
            left = [
                way if conditions == way.conditions else replace(way, conditions=conditions)
                for way in ways
                if (conditions := left_of(way.conditions, constant, impossible)) is not None
            ]
            if not left:
                del derivations[head]
                impossible.add(head)
                changed = True
            elif head not in problem.variants and any(not way.conditions for way in left):
                del derivations[head]
                constant.add(head)
                changed = True
            else:
                derivations[head] = left
    return impossible


def left_of(
    literals: Sequence[int], constant: set[int], impossible: set[int]
) -> tuple[int, ...] | None:
    """Give the literals that are not settled; None if one is settled the wrong way."""
    left = []
    for literal in literals:
        number = fact_of(literal)
        if number in constant:
            if literal < 0:
                return None
        elif number in impossible:
            if literal >= 0:
                return None
        else:
            left.append(literal)
    return tuple(left)


def _possible(problem: Literals, impossible: set[int]) -> Iterable[Instance]:
    constant = problem.constant
    settled = constant | impossible
    settled.update([~number for number in settled])
    for each in problem.instances:
        if settled.isdisjoint(each.conditions):
            yield each
            continue
        conditions = left_of(each.conditions, constant, impossible)
        if conditions is not None:
            each.conditions = conditions
            yield each


class _Makers:
    """Which instances make a fact true, and which end it; as far as they may do so."""

    def __init__(self, problem: Literals, instances: Sequence[Instance]) -> None:
        self._true: dict[int, list[int]] = {}
        self._false: dict[int, list[int]] = {}
        of_child: dict[Value, list[int]] = {}
        for number, (child, _) in problem.hierarchy.items():
            of_child.setdefault(child, []).append(number)
        for place, each in enumerate(instances):
            makes, ends = self._true, self._false
            for number in each.adds:
                makes.setdefault(number, []).append(place)
            for number in each.deletes:
                ends.setdefault(number, []).append(place)
            for number in each.expected:
                makes.setdefault(number, []).append(place)
            for _, undenied in each.ended:
                ends.setdefault(undenied, []).append(place)
            for event, numbers in each.hierarchy:
                gone: Sequence[int] = numbers
                if isinstance(event, Attach):
                    makes.setdefault(numbers[0], []).append(place)
                    gone = of_child[event.child]
                for number in gone:
                    ends.setdefault(number, []).append(place)

    def of(self, literal: int) -> Sequence[int]:
        """Give the places of the instances that may make a literal true."""
        if literal >= 0:
            return self._true.get(literal, ())
        return self._false.get(~literal, ())


def _chain_back(
    problem: Literals,
    instances: Sequence[Instance],
    derivations: dict[int, list[Derivation]],
    goal: Sequence[int],
) -> tuple[set[int], set[int]]:
    """Find the instances that serve the goal, directly or through others, and what they need."""
    makers = _Makers(problem, instances)
    kept, needed, pending = set[int](), set(goal), list(goal)

    def need(literals: Iterable[int]) -> None:
        for literal in literals:
            if literal not in needed:
                needed.add(literal)
                pending.append(literal)

    while pending:
        literal = pending.pop()
        number = fact_of(literal)
        if number in problem.variants:  # what becomes of one depends on the others
            need(each for rival in problem.variants[number] for each in (rival, ~rival))
        for way in derivations.get(number, ()):
            need(way.conditions if literal >= 0 else (~each for each in way.conditions))
        for place in makers.of(literal):
            if place not in kept:
                kept.add(place)
                instance = instances[place]
                need(instance.conditions)
                if instance.depends_on_state:
                    need(_decisive(problem, instance))
    return kept, needed


def _decisive(problem: Literals, instance: Instance) -> Iterable[int]:
    """Give the literals on which the effects of an instance depend."""
    yield from (belief for belief, _ in instance.ended)
    if instance.hierarchy:  # whether it attaches depends on all attachments
        for link in problem.hierarchy:
            yield from (link, ~link)
