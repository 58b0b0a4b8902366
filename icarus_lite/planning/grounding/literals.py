"""From what could be reached to a planning problem in literals, its semantics complete.

Three things make a fact more than a bit that operators set and clear: concepts may derive what
effects also assert or end, attributes have one value at a time, and an attachment is refused
where it would be a circle. They are recognised here fact by fact, so that only those operators
pay for them that cannot do without.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.language.syntax import Atom, Condition, SkillClause
from icarus_lite.planning.grounding.clauses import GroundedClause
from icarus_lite.planning.grounding.effects import Effects
from icarus_lite.planning.grounding.facts import GIVEN, HELD, plain
from icarus_lite.planning.grounding.hierarchy import Forest
from icarus_lite.planning.grounding.instances import Absences, Derivation, Literals, rank_of
from icarus_lite.planning.grounding.merging import HELD_BY_HIERARCHY, PASSED_ON, merge
from icarus_lite.planning.grounding.prepared import Prepared
from icarus_lite.planning.grounding.reachability import Reached
from icarus_lite.planning.grounding.removals import Lookup, Removals, lookup
from icarus_lite.planning.grounding.views import Cells


class Translation:
    """Builds the literals of one planning problem."""

    def __init__(self, prepared: Prepared, reached: Reached) -> None:
        self._prepared, self._reached, self._base = prepared, reached, reached.base
        self._forest = Forest(reached.base, prepared.hierarchy)
        self._result = Literals(
            reached.base.atoms,
            initial=set(reached.initial),
            hierarchy=self._forest.pairs,
            recursive=prepared.recursive,
        )
        self._absences = Absences(self._result)
        self._removals: dict[int, Removals] = {}
        self._removed: dict[int, list[Sequence[int]]] = {}

    def literals(self) -> Literals:
        """Give the problem."""
        skills = [clause for clause in self._prepared.clauses if is_skill(clause)]
        self._removals = {
            clause.number: Removals(clause, self._prepared, self._base)
            for clause in skills
            if clause.removals
        }
        self._find_variants()
        self._find_constants(skills)
        for clause in self._prepared.clauses[len(skills) :]:
            self._derive(clause)
        self._pass_on()
        merged = merge(self._result, self._ended_concepts(skills), self._reached.permanent)
        for clause in skills:
            removals = self._removals.get(clause.number)
            effects = Effects(clause, removals, self._result, merged, self._forest)
            self._instantiate(clause, effects)
        return self._result

    def goal(self, goals: Iterable[Condition]) -> list[tuple[Condition, tuple[int, ...] | None]]:
        """Give each goal that speaks of what may change, with its literals; None if hopeless."""
        found: list[tuple[Condition, tuple[int, ...] | None]] = []
        for goal in goals:
            if goal.atom.predicate not in self._prepared.fluents:
                continue
            numbers = lookup(self._base, goal.atom, ()).of(())
            if goal.negated:
                found.append((goal, self._absences.of(numbers, goal.atom)))
            elif not numbers:
                found.append((goal, None))
            elif len(numbers) == 1:
                found.append((goal, (numbers[0],)))
            else:  # it has several values of attributes: any will do
                found.append((goal, (self._any_of(numbers, goal.atom),)))
        return found

    def _any_of(self, numbers: Sequence[int], pattern: Atom) -> int:
        made = len(self._result.atoms)
        self._result.atoms.append((f"any {pattern}", (), ()))
        self._result.derivations[made] = [Derivation(made, (number,)) for number in numbers]
        return made

    # What facts are.

    def _find_variants(self) -> None:
        """Find the beliefs that differ in attributes alone: of these, one holds at a time."""
        of: dict[tuple[str, Cells], list[int]] = {}
        attributed = {predicate for predicate, _, attributes in self._base.atoms if attributes}
        for number, (predicate, args, _) in enumerate(self._base.atoms):
            if predicate in attributed:
                of.setdefault((predicate, args), []).append(number)
        for numbers in of.values():
            if len(numbers) > 1:
                self._result.variants.update((number, tuple(numbers)) for number in numbers)

    def _find_constants(self, skills: Sequence[GroundedClause]) -> None:
        """Find the asserted facts that hold now and that nothing ends."""
        ended: set[int] = set()
        variants = self._result.variants
        for clause in skills:
            found = self._reached.found[clause.number]
            removals = self._removals.get(clause.number)
            if removals is not None:
                removed = self._removed[clause.number] = [removals.of(row) for row, _, _ in found]
                ended.update(*removed)
            if clause.attaching is not None:
                for row, _, _ in found:
                    ended.update(self._forest.may_end(self._forest.events(clause, row)))
            if variants:  # what is asserted anew takes the place of what was asserted before
                for _, _, made in found:
                    for number in made:
                        if not self._base.atoms[number][0].startswith(GIVEN):
                            ended.update(n for n in variants.get(number, ()) if n != number)
        self._result.constant = (self._result.initial - ended) | self._reached.permanent

    # What concepts derive.

    def _derive(self, clause: GroundedClause) -> None:
        denials = [lookup(self._base, atom, clause.variables) for atom in clause.denials]
        atoms, derivations = self._base.atoms, self._result.derivations
        for row, conditions, (head,) in self._reached.found[clause.number]:
            literals = self._with_denials(conditions, denials, row)
            if literals is None:
                continue
            rank: tuple[object, ...] = ()
            predicate = atoms[head][0]
            if head in self._result.variants or predicate in self._prepared.recursive:
                rank = rank_of(clause, dict(atoms[head][2]), clause.number)
            derivations.setdefault(head, []).append(Derivation(head, literals, rank))

    def _with_denials(
        self, conditions: tuple[int, ...], denials: Sequence[Lookup], row: Cells
    ) -> tuple[int, ...] | None:
        """Give conditions with what must not hold; None if that cannot be, or one cannot hold."""
        for denial in denials:
            absences = self._absences.of(denial.of(row), denial.pattern)
            if absences is None:
                return None
            conditions += absences
        return conditions

    def _pass_on(self) -> None:
        """Let beliefs that are asserted, or that the hierarchy holds, be believed."""
        for prefix, rank in ((HELD, HELD_BY_HIERARCHY), (GIVEN, PASSED_ON)):
            names = [name for name in self._base.numbers if name.startswith(prefix)]
            for number in [n for name in names for n in self._base.numbers[name].values()]:
                name, args, attributes = self._base.atoms[number]
                belief = self._base.note(plain(name), args, attributes)
                ways = self._result.derivations.setdefault(belief, [])
                ways.insert(0, Derivation(belief, (number,), rank))

    def _ended_concepts(self, skills: Sequence[GroundedClause]) -> set[int]:
        """Give the beliefs that concepts may derive and effects end."""
        ended: set[int] = set()
        for clause in skills:
            removals = self._removals.get(clause.number)
            if removals is not None and removals.of_concepts:
                for row, _, _ in self._reached.found[clause.number]:
                    ended.update(removals.derived(row))
        return ended

    # What skills do.

    def _instantiate(self, clause: GroundedClause, effects: Effects) -> None:
        """Give the instances of a skill, those that differ in nothing but names once."""
        denials = [lookup(self._base, atom, clause.variables) for atom in clause.denials]
        constant, instances = self._result.constant, self._result.instances
        found = self._reached.found[clause.number]
        removed = self._removed.get(clause.number) or [()] * len(found)
        head = set(clause.clause.head.variables)
        others = not head.issuperset(clause.variables)
        places = [place for place, name in enumerate(clause.variables) if name in head]
        seen: set[tuple[object, ...]] = set()
        for (row, needed, made), ended in zip(found, removed, strict=True):
            conditions = needed
            if not constant.isdisjoint(needed):
                conditions = tuple([number for number in needed if number not in constant])
            literals = self._with_denials(conditions, denials, row) if denials else conditions
            if literals is None:
                continue
            instance = effects.instance(row, literals, made, ended)
            if others:  # what else is bound may make no difference
                args = tuple([row[place] for place in places])
                key = (args, literals, instance.effects)
                if key in seen:
                    continue
                seen.add(key)
            instances.append(instance)


def is_skill(clause: GroundedClause) -> bool:
    """Tell whether a clause is a skill rather than a concept."""
    return isinstance(clause.clause, SkillClause)
