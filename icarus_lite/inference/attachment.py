"""Algorithm 1: the attachment hierarchy, from the actions that agents have executed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from icarus_lite.inference.effects import Change
from icarus_lite.inference.facts import resolve, unify
from icarus_lite.language.syntax import Atom, AttachmentRule
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import ATTACHED, Action, Belief, Value


@dataclass(frozen=True, slots=True)
class Link:
    """A child's bond to its one parent, and the action and cycle that made it."""

    parent: Value
    action: Action
    cycle: int


@dataclass(frozen=True, slots=True)
class Hierarchy:
    """A forest: each child has one parent, a parent may have many children, nothing circles.

    Source: Liang et al. 2021, sec. III and Algorithm 1.
    """

    links: Mapping[Value, Link] = field(default_factory=dict)

    def pairs(self) -> Iterator[tuple[Value, Value]]:
        """Give each (child, parent), oldest first."""
        for child, link in self.links.items():
            yield child, link.parent

    def beliefs(self) -> Iterator[tuple[Belief, Link]]:
        """Give each `(attached child parent)` with the link behind it, oldest first."""
        for child, link in self.links.items():
            yield Belief(ATTACHED, (child, link.parent)), link

    def ancestors(self, child: Value) -> Iterator[Value]:
        """Give a child's parent, that one's parent, and so on up to the root."""
        while child in self.links:
            child = self.links[child].parent
            yield child

    def attach(
        self, child: Value, parent: Value, action: Action, cycle: int
    ) -> tuple[Hierarchy, tuple[str, ...]]:
        """Bind a child to a parent; a new parent replaces the old one.

        Returns:
            The new hierarchy and no note; or, where the parent is the child itself or moves with
            it, this hierarchy unchanged and a sentence that says why it was refused.
        """
        if parent == child or child in self.ancestors(parent):
            why = f"{parent} already moves with {child}" if parent != child else "it is the same"
            return self, (f"refused: {action} would attach {child} to {parent}, but {why}",)
        links = {key: link for key, link in self.links.items() if key != child}
        links[child] = Link(parent, action, cycle)
        return Hierarchy(links), ()

    def without(self, gone: Iterable[tuple[Value, Value]]) -> Hierarchy:
        """Give the hierarchy without these (child, parent) pairs; pairs not in it are ignored."""
        pairs = set(gone)
        return Hierarchy({c: x for c, x in self.links.items() if (c, x.parent) not in pairs})

    def with_change(
        self, change: Change, action: Action, cycle: int
    ) -> tuple[Hierarchy, tuple[str, ...]]:
        """Let the explicit `(attached …)` effects of a skill work on the hierarchy as well."""
        gone = (pair for pair in self.pairs() if change.removes(Belief(ATTACHED, pair)))
        hierarchy = self.without(gone)
        refused: tuple[str, ...] = ()
        for belief in change.added:
            if belief.predicate == ATTACHED:
                child, parent = belief.args
                hierarchy, note = hierarchy.attach(child, parent, action, cycle)
                refused += note
        return hierarchy, refused


def advance(
    hierarchy: Hierarchy, rules: Sequence[AttachmentRule], action: Action, cycle: int
) -> tuple[Hierarchy, tuple[str, ...]]:
    """Apply one executed action to the hierarchy.

    A detach pattern that leaves child or parent open dissolves every pair it fits, so that
    `(contain ?cone ?o) :until (pick-place ?cone)` frees all that the cone holds.

    Returns:
        The new hierarchy, and a sentence for each attachment that was refused as circular.
    Source: Liang et al. 2021, Algorithm 1, lines 2-9.
    """
    refused: list[str] = []
    for rule in rules:
        attaching = _unify_action(rule.attach, action)
        if attaching is not None:
            child, parent = resolve(rule.child, attaching), resolve(rule.parent, attaching)
            if child is not None and parent is not None:  # the checker sees to it
                hierarchy, note = hierarchy.attach(child, parent, action, cycle)
                refused.extend(note)
            continue
        detaching = None if rule.until is None else _unify_action(rule.until, action)
        if detaching is not None:
            child, parent = resolve(rule.child, detaching), resolve(rule.parent, detaching)
            hierarchy = hierarchy.without(
                (c, p) for c, p in hierarchy.pairs() if child in (None, c) and parent in (None, p)
            )
    return hierarchy, tuple(refused)


def _unify_action(pattern: Atom, action: Action) -> dict[str, Value] | None:
    if pattern.predicate != action.name or len(pattern.args) != len(action.args):
        return None
    return unify(zip(pattern.args, action.args, strict=True))
