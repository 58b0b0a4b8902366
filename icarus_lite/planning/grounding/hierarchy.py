"""The attachment hierarchy over numbered facts: what excludes one another, and what may circle."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.planning.grounding.attaching import Attach, Detach
from icarus_lite.planning.grounding.clauses import GroundedClause
from icarus_lite.planning.grounding.facts import FactBase
from icarus_lite.planning.grounding.views import Cells
from icarus_lite.symbols import Value

NumberedEvent = tuple[Attach | Detach, tuple[int, ...]]
"""An event with the facts it is about: the one it makes, or all that it may end."""


class Forest:
    """All attachments that are possible.

    Args:
        base: The facts.
        predicate: The predicate of those that stand for the hierarchy.
    """

    __slots__ = ("_above", "_numbers", "_of_child", "_parents", "pairs")

    def __init__(self, base: FactBase, predicate: str) -> None:
        self._numbers = base.numbers_of(predicate)
        self.pairs: dict[int, tuple[Value, Value]] = {}
        self._of_child: dict[Value, list[int]] = {}
        self._parents: dict[Value, list[Value]] = {}
        self._above: dict[Value, frozenset[Value]] = {}
        for number in base.numbers_of(predicate).values():
            child, parent = base.atoms[number][1]
            self.pairs[number] = child, parent
            self._of_child.setdefault(child, []).append(number)
            self._parents.setdefault(child, []).append(parent)

    def events(self, clause: GroundedClause, row: Cells) -> tuple[NumberedEvent, ...]:
        """Give what an instance does to attachments, in order, each with the facts it is about.

        What can have no effect in any situation is left out.
        """
        if clause.attaching is None:
            return ()
        found: list[NumberedEvent] = []
        for event in clause.attaching.events(dict(zip(clause.variables, row, strict=True))):
            if isinstance(event, Attach):
                if event.child != event.parent:
                    found.append((event, (self._numbers[event.child, event.parent],)))
                continue
            of_child = self.pairs if event.child is None else self.of_child(event.child)
            numbers = tuple(
                [n for n in of_child if event.parent is None or self.pairs[n][1] == event.parent]
            )
            if numbers:
                found.append((event, numbers))
        return tuple(found)

    def of_child(self, child: Value) -> Sequence[int]:
        """Give the attachments that a child can have, one at a time."""
        return self._of_child.get(child, ())

    def may_circle(self, child: Value, parent: Value) -> bool:
        """Tell whether, in some situation, the parent might move with the child."""
        above = self._above.get(parent)
        if above is None:
            found: dict[Value, None] = {}
            pending = list(self._parents.get(parent, ()))
            while pending:
                ancestor = pending.pop()
                if ancestor not in found:
                    found[ancestor] = None
                    pending += self._parents.get(ancestor, ())
            above = self._above[parent] = frozenset(found)
        return child in above

    def may_end(self, events: Iterable[NumberedEvent]) -> set[int]:
        """Give the attachments that events may end."""
        ended: set[int] = set()
        for event, numbers in events:
            if isinstance(event, Attach):
                ended.update(each for each in self.of_child(event.child) if each not in numbers)
            else:
                ended.update(numbers)
        return ended

    def net(self, events: Sequence[NumberedEvent]) -> tuple[list[int], list[int]] | None:
        """Give what events add and what they end; None if that depends on the situation."""
        added: list[int] = []
        ended: dict[int, None] = {}
        for event, numbers in events:
            gone = numbers
            if isinstance(event, Attach):
                if self.may_circle(event.child, event.parent):
                    return None
                gone = tuple(self.of_child(event.child))
            ended.update(dict.fromkeys(gone))
            added = [number for number in added if number not in gone]
            if isinstance(event, Attach):
                added += numbers
        return added, [number for number in ended if number not in added]
