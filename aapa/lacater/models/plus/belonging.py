"""Who stands in what: as it is reported, and where nothing is, as it is inferred."""

from __future__ import annotations

from collections.abc import Sequence

from aapa.anchors import Attachment
from aapa.hierarchy import parents_of


class Belonging:
    """The parents of all that is contained. What is reported counts for more."""

    def __init__(self) -> None:
        self._pairs: Sequence[Attachment] | None = None
        self._reported: dict[str, str] = {}
        self._inferred: dict[str, str] = {}
        self._denied: set[tuple[str, str]] = set()
        self.parents: dict[str, str] = {}
        """Child to parent; following it from any child comes to an end."""

    def report(self, pairs: Sequence[Attachment]) -> None:
        """Take in the attachments that are believed.

        Raises:
            AnchoringError: A child has two parents, or they run in a circle.
        """
        if pairs is self._pairs:
            return
        self._pairs = pairs
        reported = parents_of(pairs)
        self._denied &= set(reported.items())
        self._reported = {c: p for c, p in reported.items() if (c, p) not in self._denied}
        self._unite()

    def deny(self, parent: str) -> None:
        """Believe of nothing that it is in something, until it is reported anew."""
        for child in [child for child, its in self.parents.items() if its == parent]:
            if self._reported.pop(child, None) is not None:
                self._denied.add((child, parent))
            self._inferred.pop(child, None)
        self._unite()

    def infer(self, child: str, parent: str) -> None:
        """Believe, without a report, that something is in something else."""
        self._inferred[child] = parent
        self._unite()

    def forget(self, *children: str) -> None:
        """No longer believe what was inferred of some things."""
        for child in children:
            self._inferred.pop(child, None)
        self._unite()

    def is_reported(self, child: str) -> bool:
        """Tell whether something is reported to be in something else."""
        return child in self._reported

    @property
    def inferred(self) -> tuple[str, ...]:
        """What is believed to be in something without a report."""
        return tuple(self._inferred)

    def children_of(self, parent: str) -> tuple[str, ...]:
        """Give what stands in something, directly or not, the outer first."""
        children: list[str] = []
        for child, its in self.parents.items():
            if its == parent:
                children += [child, *self.children_of(child)]
        return tuple(children)

    def outermost(self, child: str) -> str:
        """Give what something stands in and can be seen; itself if it stands in nothing."""
        while child in self.parents:
            child = self.parents[child]
        return child

    def _unite(self) -> None:
        self.parents = dict(self._reported)
        for child, parent in list(self._inferred.items()):
            if child in self._reported or self.outermost(parent) == child:
                del self._inferred[child]
            else:
                self.parents[child] = parent
