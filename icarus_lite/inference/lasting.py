"""What persists from cycle to cycle: the effects of actions, and the attachments."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property
from typing import TypeAlias

from icarus_lite.inference.attachment import Hierarchy, Link
from icarus_lite.inference.supports import Assertion, Support
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Belief, Value

Given: TypeAlias = Mapping[Belief, tuple[Support, ...]]
"""The beliefs that rest on actions, each with what asserted it."""


@dataclass(frozen=True)
class Lasting:
    """What persists in a cycle.

    Args:
        asserted: The effects, each with the action and cycle that asserted it.
        hierarchy: The attachments.
    """

    asserted: Mapping[Belief, Assertion]
    hierarchy: Hierarchy

    @cached_property
    def given(self) -> Given:
        """All of it as beliefs, attachments last."""
        given: dict[Belief, tuple[Support, ...]] = {b: (c,) for b, c in self.asserted.items()}
        for belief, link in self.hierarchy.beliefs():
            given[belief] = (Assertion(link.action, link.cycle),)
        return given

    def without_objects(self, gone: frozenset[str]) -> Lasting:
        """Leave out what speaks of objects that are gone."""
        if not gone:
            return self
        hierarchy = self.hierarchy
        return Lasting(
            {b: cause for b, cause in self.asserted.items() if gone.isdisjoint(b.args)},
            hierarchy.without(pair for pair in hierarchy.pairs() if not gone.isdisjoint(pair)),
        )

    def without(self, withdrawn: Iterable[Belief]) -> Lasting:
        """Leave out some beliefs."""
        gone = frozenset(withdrawn)
        if not gone:
            return self
        hierarchy = self.hierarchy
        return Lasting(
            {b: cause for b, cause in self.asserted.items() if b not in gone},
            hierarchy.without(pair for pair in hierarchy.pairs() if Belief(ATTACHED, pair) in gone),
        )


def hierarchy_of(given: Given) -> Hierarchy:
    """Give the attachments among the beliefs that rest on actions."""
    links: dict[Value, Link] = {}
    for belief, (cause, *_) in given.items():
        if belief.predicate == ATTACHED and isinstance(cause, Assertion):
            child, parent = belief.args
            links[child] = Link(parent, cause.action, cause.cycle)
    return Hierarchy(links)
