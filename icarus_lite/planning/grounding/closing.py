"""A state with its derived facts: the stratified least model, on bits.

Derived facts come in an order in which each comes after those it rests on, so that one look at
each is enough; only facts that rest on one another are looked at again until nothing changes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from icarus_lite.planning.ground_task import State
from icarus_lite.planning.grounding.bits import Bits
from icarus_lite.planning.grounding.components import components
from icarus_lite.planning.grounding.instances import Derivation, Literals, fact_of
from icarus_lite.records import dataclass

Ways = tuple[tuple[tuple[State, State], ...], State]
"""For a belief: each way to derive it with the bits to set then, and those to set if none holds.

Where a belief has values of attributes, the ways to all of them in the order in which they
compete: the first that holds decides.
"""


class Closing:
    """Gives states their derived facts.

    Args:
        problem: The problem.
        derivations: The derivations that matter.
        bits: Which bit is which.
    """

    __slots__ = ("_derived", "_layers")

    def __init__(
        self, problem: Literals, derivations: Mapping[int, Sequence[Derivation]], bits: Bits
    ) -> None:
        self._derived = ~bits.mask(x for head in derivations for x in (head, ~head))
        self._layers = tuple(_layers(problem, derivations, bits))

    def __call__(self, state: State) -> State:
        """Give a state with its derived facts brought up to date."""
        state &= self._derived
        for layer in self._layers:
            state = layer.derive(state)
        return state


@dataclass(frozen=True, slots=True)
class _Straight:
    """Beliefs that are looked at one after the other."""

    beliefs: tuple[Ways, ...]

    def derive(self, state: State) -> State:
        for ways, otherwise in self.beliefs:
            for conditions, result in ways:
                if state & conditions == conditions:
                    state |= result
                    break
            else:
                state |= otherwise
        return state


@dataclass(frozen=True, slots=True)
class _Repeated:
    """Beliefs that rest on one another: looked at until nothing new follows."""

    beliefs: tuple[Ways, ...]

    def derive(self, state: State) -> State:
        waiting: Sequence[Ways] = self.beliefs
        changed = True
        while changed:
            changed, rest = False, []
            for belief in waiting:
                for conditions, result in belief[0]:
                    if state & conditions == conditions:
                        state |= result
                        changed = True
                        break
                else:
                    rest.append(belief)
            waiting = rest
        for _, otherwise in waiting:
            state |= otherwise
        return state


@dataclass(frozen=True, slots=True)
class _Rounds:
    """Beliefs with values that rest on one another: derived in the rounds of the semantics.

    The round in which a belief first follows decides on its value, in it the clause written
    first, and of that clause the least value. A clause does not see what it just concluded.

    Args:
        clauses: For each clause its ways, the least values first: the conditions, the belief by
            a number, and the bits to set.
        otherwise: For each belief, the bits to set if it is not derived.
    """

    clauses: tuple[tuple[tuple[State, int, State], ...], ...]
    otherwise: Mapping[int, State]

    def derive(self, state: State) -> State:
        decided: set[int] = set()
        before = -1
        while before != len(decided):
            before = len(decided)
            for ways in self.clauses:
                follows: dict[int, State] = {}
                for conditions, belief, result in ways:
                    if belief not in decided and state & conditions == conditions:
                        follows.setdefault(belief, result)
                decided.update(follows)
                for result in follows.values():
                    state |= result
        for belief, otherwise in self.otherwise.items():
            if belief not in decided:
                state |= otherwise
        return state


_Layer = _Straight | _Repeated | _Rounds
"""Beliefs that rest on those of earlier layers; `derive` gives a state with them."""


def _layers(
    problem: Literals, derivations: Mapping[int, Sequence[Derivation]], bits: Bits
) -> list[_Layer]:
    belief = {head: min(problem.variants.get(head, (head,))) for head in derivations}
    valued = {
        problem.recursive[problem.atoms[head][0]]
        for head in derivations
        if head in problem.variants and problem.atoms[head][0] in problem.recursive
    }
    # Beliefs that must be derived together are led by one of them.
    leader: dict[int, int] = {}
    first: dict[int, int] = {}
    for head in derivations:
        group = problem.recursive.get(problem.atoms[head][0], -1)
        leader[head] = first.setdefault(group, head) if group in valued else belief[head]
    members: dict[int, list[int]] = {}
    uses: dict[int, list[int]] = {}
    for head, ways in derivations.items():
        members.setdefault(leader[head], []).append(head)
        used = uses.setdefault(leader[head], [])
        used += [leader[n] for way in ways for x in way.conditions if (n := fact_of(x)) in leader]
    layers, single = list[_Layer](), list[Ways]()
    for component in components(uses):
        alone = len(component) == 1 and component[0] not in uses[component[0]]
        in_rounds = any(first.get(group) in component for group in valued)
        if alone and not in_rounds:
            single.append(_ways(members[component[0]], derivations, bits))
            continue
        layers.append(_Straight(tuple(single)))
        single = []
        if in_rounds:
            heads = [head for node in component for head in members[node]]
            layers.append(_rounds(heads, belief, derivations, bits))
        else:
            beliefs = [_ways(members[node], derivations, bits) for node in component]
            layers.append(_Repeated(tuple(beliefs)))
    return [*layers, _Straight(tuple(single))]


def _ways(
    heads: Sequence[int], derivations: Mapping[int, Sequence[Derivation]], bits: Bits
) -> Ways:
    otherwise = bits.opposite(heads)
    every = [way for head in heads for way in derivations[head]]
    if len(heads) > 1:
        every.sort(key=lambda way: way.rank)
    found = [(bits.mask(way.conditions), _result(way.head, otherwise, bits)) for way in every]
    return tuple(found), otherwise


def _rounds(
    heads: Sequence[int],
    belief: Mapping[int, int],
    derivations: Mapping[int, Sequence[Derivation]],
    bits: Bits,
) -> _Rounds:
    otherwise: dict[int, State] = {}
    for head in heads:
        otherwise[belief[head]] = otherwise.get(belief[head], 0) | bits.opposite((head,))
    clauses: dict[int, list[tuple[State, int, State]]] = {}
    for way in sorted((w for head in heads for w in derivations[head]), key=lambda w: w.rank):
        result = _result(way.head, otherwise[belief[way.head]], bits)
        entry = bits.mask(way.conditions), belief[way.head], result
        clauses.setdefault(way.rank[0], []).append(entry)
    return _Rounds(tuple(map(tuple, clauses.values())), otherwise)


def _result(head: int, otherwise: State, bits: Bits) -> State:
    """Give the bits to set when a fact follows: its own, and that no rival holds."""
    return bits.masks.get(head, 0) | otherwise & ~bits.masks.get(~head, 0)
