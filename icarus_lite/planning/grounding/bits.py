"""Which bit of the state stands for which literal."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from icarus_lite.planning.ground_task import GroundAtom, State
from icarus_lite.planning.grounding.instances import Literals
from icarus_lite.records import dataclass
from icarus_lite.symbols import Belief


@dataclass(frozen=True, slots=True)
class Bits:
    """The bits of the state.

    Args:
        atoms: What each bit stands for.
        places: The place of the bit of each literal.
        masks: The same as masks. A literal without a bit has the mask 0.
    """

    atoms: list[GroundAtom]
    places: dict[int, int]
    masks: dict[int, State]

    def mask(self, literals: Iterable[int]) -> State:
        """Give the bits of literals; those that have none are ignored."""
        mask = 0
        for literal in literals:
            mask |= self.masks.get(literal, 0)
        return mask

    def opposite(self, literals: Iterable[int]) -> State:
        """Give the bits that stand for the opposite of literals."""
        return self.mask(~literal for literal in literals)

    def add(self, belief: Belief) -> int:
        """Give the place of a new bit that stands for something the heuristic counts with."""
        self.atoms.append(GroundAtom(belief, derived=True))
        return len(self.atoms) - 1


def assign_bits(problem: Literals, needed: set[int], derived: Mapping[int, object]) -> Bits:
    """Give each fact that is needed its bit, and its complement one where that is needed."""
    atoms, places, masks = list[GroundAtom](), dict[int, int](), dict[int, State]()
    for number in sorted({n if n >= 0 else ~n for n in needed}):
        predicate, args, attributes = problem.atoms[number]
        belief = Belief(predicate, args, dict(attributes))
        for literal in (number, ~number):
            if literal >= 0 or literal in needed:
                places[literal] = len(atoms)
                masks[literal] = 1 << len(atoms)
                atoms.append(GroundAtom(belief, literal < 0, number in derived))
    return Bits(atoms, places, masks)
