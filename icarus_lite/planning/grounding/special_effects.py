"""Effects that depend on the state: what an operator does beyond setting and clearing bits."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.planning.ground_task import State
from icarus_lite.planning.grounding.attaching import Attach
from icarus_lite.planning.grounding.bits import Bits
from icarus_lite.planning.grounding.closing import Closing
from icarus_lite.planning.grounding.instances import Instance, Literals
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value


@dataclass(frozen=True, slots=True)
class Links:
    """The attachment hierarchy on bits.

    Args:
        of_child: For each child the bits of its attachments.
        parents: For each such bit the parent.
        complements: For each such bit that of its complement, 0 if there is none.
    """

    of_child: dict[Value, State]
    parents: dict[State, Value]
    complements: dict[State, State]

    def moves_with(self, state: State, what: Value, child: Value) -> bool:
        """Tell whether something is the child, or is attached to it directly or through others."""
        while what != child:
            link = state & self.of_child.get(what, 0)
            if not link:
                return False
            what = self.parents[link]
        return True

    def without(self, state: State, links: State) -> State:
        """Give a state without some attachments."""
        links &= state
        state &= ~links
        while links:
            link = links & -links
            links ^= link
            state |= self.complements[link]
        return state

    def attach(self, state: State, link: State, child: Value) -> State:
        """Give a state in which a child has this attachment and no other."""
        if self.moves_with(state, self.parents[link], child):
            return state
        state = self.without(state, self.of_child[child])
        return (state | link) & ~self.complements[link]


def links_of(problem: Literals, bits: Bits) -> Links:
    """Give the hierarchy of a problem on bits."""
    of_child: dict[Value, State] = {}
    parents: dict[State, Value] = {}
    complements: dict[State, State] = {}
    for number, (child, parent) in problem.hierarchy.items():
        link = bits.masks.get(number, 0)
        if link:
            of_child[child] = of_child.get(child, 0) | link
            parents[link] = parent
            complements[link] = bits.masks.get(~number, 0)
    return Links(of_child, parents, complements)


@dataclass(frozen=True, slots=True)
class Special:
    """The effects of one operator that depend on the state.

    Args:
        links: The attachment hierarchy.
        hierarchy: What it attaches, a bit and the child, or detaches, bits and None; in order.
        expected: For each belief it asserts that concepts may derive: the bit that it is
            asserted, its complement, and the bits of the belief with whatever value.
        ended: For each belief it ends that concepts may derive: its bit, the bit that it has not
            been ended, and the complement of that.
        closing: Brings derived facts up to date; None if there are none.
    """

    links: Links
    hierarchy: tuple[tuple[State, Value | None], ...]
    expected: tuple[tuple[State, State, State], ...]
    ended: tuple[tuple[State, State, State], ...]
    closing: Closing | None

    def __call__(self, _: State, state: State) -> State:
        """Give the state after the operator, from that after its ordinary effects."""
        for link, child in self.hierarchy:
            if child is None:
                state = self.links.without(state, link)
            else:
                state = self.links.attach(state, link, child)
        closed = state if self.closing is None else self.closing(state)
        changed = closed
        for asserted, complement, belief in self.expected:
            if not closed & belief:
                changed = (changed | asserted) & ~complement
        for belief, undenied, complement in self.ended:
            if closed & belief:
                changed = changed & ~undenied | complement
        if changed == closed or self.closing is None:
            return changed
        return self.closing(changed)


def special_effects(
    instance: Instance,
    bits: Bits,
    links: Links,
    closing: Closing | None,
    beliefs: dict[int, Sequence[int]],
) -> Special | None:
    """Give the effects of an instance that depend on the state, or None if it has none.

    Args:
        instance: The operator.
        bits: Which bit is which.
        links: The attachment hierarchy.
        closing: Brings derived facts up to date.
        beliefs: For the fact that a belief is asserted: the belief, with each of its values.
    """
    if not instance.depends_on_state:
        return None
    masks = bits.masks
    hierarchy: list[tuple[State, Value | None]] = []
    for event, numbers in instance.hierarchy:
        child = event.child if isinstance(event, Attach) else None
        mask = bits.mask(numbers)
        if mask:
            hierarchy.append((mask, child))
    expected = [
        (masks[number], masks.get(~number, 0), bits.mask(beliefs.get(number, (number,))))
        for number in instance.expected
        if number in masks
    ]
    ended = [
        (masks[belief], masks[undenied], masks.get(~undenied, 0))
        for belief, undenied in instance.ended
        if belief in masks and undenied in masks
    ]
    if not (hierarchy or expected or ended):
        return None
    return Special(links, tuple(hierarchy), tuple(expected), tuple(ended), closing)
