"""How derived facts come about, for the heuristic to count with.

A derived fact has a rule for each of its derivations. Its complement holds when each of them
fails, and a derivation fails when one of its conditions does: so there is a made-up atom for each
derivation that says "it fails", with a rule for each condition. Where facts rest on one another,
that one of them fails is taken for granted, so that the complement is never out of reach when it
could come about.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

from icarus_lite.planning.ground_task import GroundRule
from icarus_lite.planning.grounding.bits import Bits
from icarus_lite.planning.grounding.components import components
from icarus_lite.planning.grounding.instances import Derivation, Literals, fact_of
from icarus_lite.symbols import Belief

FAILS = "fails "
"""Begins the name of the made-up atom that a derivation fails."""


def rules_of(
    problem: Literals,
    derivations: Mapping[int, Sequence[Derivation]],
    needed: Collection[int],
    bits: Bits,
) -> Iterator[GroundRule]:
    """Give the rules by which derived facts and their complements come about, as far as needed."""
    group = _groups(derivations)
    for head, ways in derivations.items():
        if head in needed:
            for way in ways:
                conditions = tuple([bits.places[x] for x in way.conditions])
                yield GroundRule(bits.places[head], conditions)
        if ~head not in needed:
            continue
        place = bits.places[~head]
        if head in problem.variants:  # a rival value may win instead
            yield GroundRule(place, ())
            continue
        failing: list[int] = []
        for number, way in enumerate(ways):
            if any(group.get(fact_of(x)) == group[head] for x in way.conditions):
                continue
            opposites = [bits.places[~x] for x in way.conditions]
            if len(opposites) == 1:
                failing += opposites
                continue
            belief = bits.atoms[place].belief
            fails = bits.add(Belief(f"{FAILS}{belief} {number}"))
            failing.append(fails)
            for opposite in opposites:
                yield GroundRule(fails, (opposite,))
        yield GroundRule(place, tuple(dict.fromkeys(failing)))


def _groups(derivations: Mapping[int, Sequence[Derivation]]) -> dict[int, int]:
    """Number the derived facts, those alike that rest on one another; others get none alike."""
    uses = {
        head: [fact_of(x) for way in ways for x in way.conditions]
        for head, ways in derivations.items()
    }
    return {node: number for number, nodes in enumerate(components(uses)) for node in nodes}
