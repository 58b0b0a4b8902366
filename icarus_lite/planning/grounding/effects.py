"""The effects of skill instances, as literals."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from icarus_lite.inference import ground
from icarus_lite.planning.grounding.clauses import GroundedClause, is_bound
from icarus_lite.planning.grounding.facts import GIVEN, plain
from icarus_lite.planning.grounding.hierarchy import Forest, NumberedEvent
from icarus_lite.planning.grounding.instances import Instance, Literals
from icarus_lite.planning.grounding.merging import Merged
from icarus_lite.planning.grounding.removals import Removals
from icarus_lite.planning.grounding.views import Cells
from icarus_lite.symbols import ATTACHED


class Effects:
    """What the instances of one skill clause do.

    Args:
        clause: The clause.
        removals: What its effects end; None if they end nothing.
        problem: The problem, its constants known.
        merged: The beliefs that effects speak of although concepts define them.
        forest: The attachments that are possible.
    """

    __slots__ = (
        "_clause", "_count", "_forest", "_merged", "_problem", "_removals", "simple",
    )  # fmt: skip

    def __init__(
        self,
        clause: GroundedClause,
        removals: Removals | None,
        problem: Literals,
        merged: Merged,
        forest: Forest,
    ) -> None:
        self._clause, self._removals = clause, removals
        self._problem, self._merged, self._forest = problem, merged, forest
        # What is made true is told first, then come attachments.
        self._count = sum(1 for atom in clause.effects if is_bound(atom, clause.variables))
        given = any(atom.predicate.startswith(GIVEN) for atom in clause.effects)
        ends_concepts = removals is not None and removals.of_concepts
        self.simple = not (
            given or ends_concepts or clause.attaching is not None or problem.variants
        )

    def instance(
        self,
        row: Cells,
        conditions: tuple[int, ...],
        made: Sequence[int],
        removed: Sequence[int],
    ) -> Instance:
        """Give an instance with its effects.

        Args:
            row: What its variables are bound to.
            conditions: The literals it needs.
            made: What it makes true, as found when it was reached.
            removed: The asserted facts that it ends.
        """
        constant = self._problem.constant
        if self.simple:
            adds = tuple(made)
            if not constant.isdisjoint(adds):
                adds = tuple([n for n in made if n not in constant])
            deletes = tuple([n for n in removed if n not in made and n not in constant])
            return Instance(self._clause, row, conditions, adds, deletes)
        instance = Instance(self._clause, row, conditions, (), ())
        replaced = self._add(instance, made[: self._count])
        self._end(instance, made[: self._count], removed, replaced)
        if self._clause.attaching is not None:
            self._attach(instance)
        if instance.expected or instance.ended:
            self._put_off(instance)
        return instance

    def _add(self, instance: Instance, made: Sequence[int]) -> list[int]:
        """Say what is made true, and on which condition.

        Returns:
            The same beliefs with other attributes: what is asserted anew takes their place.
        """
        problem, merged = self._problem, self._merged
        adds, expected, replaced = list[int](), list[int](), list[int]()
        settled: set[int] = set()
        for asserted in made:
            number = merged.stands_for.get(asserted, asserted)
            name, args, _ = problem.atoms[number]
            if number in problem.constant:
                continue
            variants = problem.variants.get(number, (number,))
            if not settled.isdisjoint(variants):
                continue  # of several values the first is meant
            settled.add(number)
            if name.startswith(GIVEN):
                expected.append(number)
                undenied = merged.undenied.get((plain(name), args))
                adds += [] if undenied is None else [undenied]
            elif problem.constant.isdisjoint(variants):  # what is perceived keeps its attributes
                adds.append(number)
                replaced += [each for each in variants if each != number]
        instance.adds, instance.expected = tuple(dict.fromkeys(adds)), tuple(expected)
        return replaced

    def _end(
        self,
        instance: Instance,
        made: Sequence[int],
        removed: Sequence[int],
        replaced: Sequence[int],
    ) -> None:
        """Say what is ended: what effects add as well is not, except with other attributes."""
        problem, merged, row = self._problem, self._merged, instance.row
        added = {(plain(problem.atoms[n][0]), problem.atoms[n][1]) for n in made}
        added.update((ATTACHED, pair) for pair in self._asserted_pairs(row))
        derived = self._removals.derived(row) if self._removals is not None else []
        deletes, ended = list[int](replaced), list[tuple[int, int]]()
        for asserted in (*removed, *derived):
            name, args, _ = problem.atoms[asserted]
            number = merged.stands_for.get(asserted, asserted)
            if (plain(name), args) in added or number in problem.constant:
                continue
            undenied = merged.undenied.get((name, args))
            if undenied is not None:
                ended.append((number, undenied))
            elif number not in problem.derivations:
                deletes.append(number)
        instance.deletes, instance.ended = tuple(dict.fromkeys(deletes)), tuple(ended)

    def _attach(self, instance: Instance) -> None:
        """Say what happens to attachments: in sum, or step by step where that depends."""
        events: tuple[NumberedEvent, ...] = self._forest.events(self._clause, instance.row)
        net = self._forest.net(events)
        if net is None:
            instance.hierarchy = events
            return
        added, ended = net
        deletes = [number for number in instance.deletes if number not in added]
        instance.adds = tuple(dict.fromkeys((*instance.adds, *added)))
        instance.deletes = tuple(dict.fromkeys((*deletes, *ended)))

    def _put_off(self, instance: Instance) -> None:
        """Let what depends on derived beliefs be judged before effects on concepts take place."""
        never, always = self._merged.never, self._merged.always
        instance.expected += tuple(n for n in instance.adds if n in never)
        instance.adds = tuple(n for n in instance.adds if n not in never)
        instance.ended += tuple((n, n) for n in instance.deletes if n in always)
        instance.deletes = tuple(n for n in instance.deletes if n not in always)

    def _asserted_pairs(self, row: Cells) -> Iterator[Cells]:
        """Give the attachments that positive effects name."""
        bindings = dict(zip(self._clause.variables, row, strict=True))
        for effect in self._clause.skill.effects:
            if not effect.negated and effect.atom.predicate == ATTACHED:
                fact = ground(effect.atom, bindings)
                if fact is not None:
                    yield fact.args
