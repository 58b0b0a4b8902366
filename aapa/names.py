"""Names for anchors: unique, and never given twice, but for the one object of a unique type."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace

from aapa.errors import AnchoringError


@dataclass(frozen=True, slots=True)
class NameRegister:
    """Which names have been given so far, those of anchors long removed included.

    Numbers only go up, so that the counts stand for all numbered names and the register stays
    as small as the number of types, however long it runs.

    Args:
        counts: The highest number that each type has reached.
        bare: The types whose bare name is taken.
        bodies: The names that bodies brought along.
    """

    counts: Mapping[str, int] = field(default_factory=dict)
    bare: frozenset[str] = frozenset()
    bodies: frozenset[str] = frozenset()

    @classmethod
    def of(cls, named: Iterable[tuple[str, str]]) -> NameRegister:
        """Give the register of names that stand already; names given up before are not known.

        Args:
            named: Name and type of each anchor.

        Example:
            >>> NameRegister.of([("case", "case"), ("cone-3", "cone"), ("hand1", "hand")]).counts
            {'case': 1, 'cone': 3}
        """
        counts: dict[str, int] = {}
        bare: set[str] = set()
        bodies: set[str] = set()
        for name, type_ in named:
            stem, _, number = name.rpartition("-")
            if name == type_:
                bare.add(name)
                counts[type_] = max(1, counts.get(type_, 0))
            elif stem == type_ and number.isdecimal():
                counts[type_] = max(int(number), counts.get(type_, 0))
            else:
                bodies.add(name)
        return cls(counts, frozenset(bare), frozenset(bodies))

    def __contains__(self, name: str) -> bool:
        return name in self.bodies or self._is_object(name)

    def with_bodies(self, names: frozenset[str]) -> NameRegister:
        """Give the register in which bodies hold the names they came with.

        Raises:
            AnchoringError: An anchor that is not a body has, or had, such a name.
        """
        for name in sorted(names - self.bodies):
            if self._is_object(name):
                raise AnchoringError(
                    f"the name {name!r} already stands for an anchored object; "
                    "a body that reports its own place needs a name of its own"
                )
        return self if names <= self.bodies else replace(self, bodies=self.bodies | names)

    def with_new(
        self, type_: str, *, unique: bool, anchored: Collection[str] = ()
    ) -> tuple[str, NameRegister]:
        """Name a new anchor, and give the register in which the name is taken.

        Args:
            type_: The anchor's type.
            unique: Whether one object of this type is expected. It goes by the bare type, and
                is the same object again when it reappears after its anchor was given up.
            anchored: The names that anchors have now.

        Example:
            >>> first, register = NameRegister().with_new("case", unique=True)
            >>> second, _ = register.with_new("case", unique=True, anchored=["case"])
            >>> first, second
            ('case', 'case-2')
        """
        if unique and type_ in self.bare and type_ not in anchored:
            return type_, self
        count = self.counts.get(type_, 0) + 1
        bare = unique and count == 1 and type_ not in self
        # A body, or another type, may hold a name that looks like one of ours.
        while not bare and f"{type_}-{count}" in self:
            count += 1
        register = replace(
            self,
            counts={**self.counts, type_: count},
            bare=self.bare | {type_} if bare else self.bare,
        )
        return type_ if bare else f"{type_}-{count}", register

    def _is_object(self, name: str) -> bool:
        if name in self.bare:
            return True
        type_, _, number = name.rpartition("-")
        return (
            number.isdecimal()
            and str(int(number)) == number
            and 1 <= int(number) <= self.counts.get(type_, 0)
        )
