"""The skills of a domain, made ready to be called."""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.execution.effects import are_believed, effects_of, ways_believed
from icarus_lite.inference import (
    Bindings,
    Evaluator,
    FactStore,
    Matcher,
    Obstacle,
    bind_pattern,
    first_obstacle,
    resolve,
    unify,
)
from icarus_lite.language.syntax import Atom, Condition, Domain, SkillClause, Variable
from icarus_lite.symbols import Value


class Skill:
    """One clause of a skill with what is asked of it again and again.

    Args:
        clause: The clause.
        number: Its place among the skills of the domain, from 0.
        effects: Its effects, attachments included.
        start: Finds the ways in which its start conditions hold (`:elements`, `:tests`).
        hold: Finds the ways in which its hold conditions do (`:while`).
    """

    __slots__ = ("_evaluator", "_kept", "clause", "effects", "hold", "number", "start")

    def __init__(
        self, clause: SkillClause, number: int, domain: Domain, evaluator: Evaluator
    ) -> None:
        self.clause = clause
        self.number = number
        self.effects = effects_of(clause, domain.attachments)
        self.start = Matcher(clause.elements, clause.tests, evaluator=evaluator)
        self.hold = Matcher(clause.holds, evaluator=evaluator)
        self._evaluator = evaluator
        self._kept = frozenset(_names_of_objects(clause))

    def holds(self, facts: FactStore, bindings: Bindings) -> bool:
        """Tell whether its hold conditions are met; they are if it has none."""
        return any(True for _ in self.hold.matches(facts, bindings))

    def is_done(self, facts: FactStore, bindings: Bindings) -> bool:
        """Tell whether it has effects and all of them are believed."""
        return are_believed(self.effects, bindings, facts)

    def again(self, facts: FactStore, bindings: Bindings) -> dict[str, Value] | None:
        """Bind an instance anew, or give None if it could not start now.

        It stays the same instance: what it is about is kept, and only the values of attributes,
        such as a position, are read again.
        """
        for found in self.start.matches(facts, self._kept_of(bindings)):
            return dict(found.bindings)
        return None

    def obstacle(self, facts: FactStore, bindings: Bindings) -> Obstacle | None:
        """Give what keeps an instance from starting now; None if nothing does."""
        clause, kept = self.clause, self._kept_of(bindings)
        return first_obstacle(clause.elements, clause.tests, facts, kept, self._evaluator)

    def _kept_of(self, bindings: Bindings) -> dict[str, Value]:
        return {name: value for name, value in bindings.items() if name in self._kept}


class Repertoire:
    """All skills of a domain, by name and as a whole.

    Args:
        domain: A checked domain.
        evaluator: Evaluates the tests of the domain.
    """

    __slots__ = ("_by_clause", "_by_name", "evaluator", "skills")

    def __init__(self, domain: Domain, evaluator: Evaluator | None = None) -> None:
        self.evaluator = evaluator or Evaluator()
        self.skills = tuple(
            Skill(clause, number, domain, self.evaluator)
            for number, clause in enumerate(domain.skills)
        )
        self._by_clause = {id(skill.clause): skill for skill in self.skills}
        self._by_name: dict[str, tuple[Skill, ...]] = {}
        for skill in self.skills:
            name = skill.clause.head.predicate
            self._by_name[name] = (*self._by_name.get(name, ()), skill)

    def of(self, clause: SkillClause) -> Skill:
        """Give the skill made of a clause of this domain."""
        return self._by_clause[id(clause)]

    def named(self, call: Atom) -> tuple[Skill, ...]:
        """Give the clauses that a call may mean: those of its name and number of arguments."""
        named = self._by_name.get(call.predicate, ())
        return tuple(skill for skill in named if len(skill.clause.head.args) == len(call.args))

    def is_met(self, call: Atom, facts: FactStore) -> bool:
        """Tell whether what an intended skill is to bring about is believed already.

        Where it leaves an argument open, that something is so somewhere does not count unless the
        skill could start with it: what is to be moved anywhere is not there already.
        """
        return any(True for _ in self._ways(call, {}, facts, (), ended=False))

    def ways_met(
        self, call: Atom, bindings: Bindings, facts: FactStore, within: tuple[int, ...] = ()
    ) -> Iterator[dict[str, Value]]:
        """Give the ways in which what a call is to bring about is believed already.

        That is, the effects of a clause of that name; where a macro states none, those of all its
        subskills. An argument that the caller leaves open is for the skill to bind: the call is
        met if an instance that could start has nothing left to do, or if none could start and the
        effects are believed for any value.

        Returns:
            The caller's bindings, extended by what is passed back.
        """
        met = False
        for way in self._ways(call, bindings, facts, within, ended=False):
            met = True
            yield way
        is_open = any(resolve(term, bindings) is None for term in call.args)
        if is_open and not met and not any(self._startable(call, bindings, facts)):
            yield from self._ways(call, bindings, facts, within, ended=True)

    def _ways(
        self,
        call: Atom,
        bindings: Bindings,
        facts: FactStore,
        within: tuple[int, ...],
        *,
        ended: bool,
    ) -> Iterator[dict[str, Value]]:
        for skill in self.named(call):
            head = skill.clause.head
            given = passed_down(call, bindings, head)
            if given is None or skill.number in within:
                continue
            if not skill.effects:
                inside = (*within, skill.number)
                calls = skill.clause.subskills
                ways = self._all_met(calls, given, facts, inside) if calls else iter(())
            elif ended or given.keys() >= set(head.variables):
                ways = ways_believed(skill.effects, given, facts)
            else:
                found = (dict(match.bindings) for match in skill.start.matches(facts, given))
                ways = (bound for bound in found if skill.is_done(facts, bound))
            for way in ways:
                returned = passed_back(call, bindings, head, way)
                if returned is not None:
                    yield returned

    def _startable(self, call: Atom, bindings: Bindings, facts: FactStore) -> Iterator[bool]:
        for skill in self.named(call):
            given = passed_down(call, bindings, skill.clause.head)
            if given is not None:
                yield any(True for _ in skill.start.matches(facts, given))

    def _all_met(
        self,
        calls: tuple[Atom, ...],
        bindings: dict[str, Value],
        facts: FactStore,
        within: tuple[int, ...],
    ) -> Iterator[dict[str, Value]]:
        if not calls:
            yield bindings
            return
        for way in self.ways_met(calls[0], bindings, facts, within):
            yield from self._all_met(calls[1:], way, facts, within)

    def aims_of(self, call: Atom) -> tuple[Condition, ...]:
        """Give what a call is to bring about as goals: the effects of its first clause."""
        for skill in self.named(call):
            given = passed_down(call, {}, skill.clause.head)
            if given is not None and skill.effects:
                return tuple(
                    Condition(bind_pattern(effect.atom, given), effect.negated)
                    for effect in skill.effects
                )
        return ()


def passed_down(call: Atom, bindings: Bindings, head: Atom) -> dict[str, Value] | None:
    """Bind the variables of a head by a call; None if the head cannot stand for it.

    An argument that is still free in the caller stays free: the skill binds it by its own
    matching.
    """
    known = [
        (own, value)
        for own, term in zip(head.args, call.args, strict=True)
        if (value := resolve(term, bindings)) is not None
    ]
    return unify(known)


def passed_back(
    call: Atom, bindings: Bindings, head: Atom, own: Bindings
) -> dict[str, Value] | None:
    """Extend a caller's bindings by those of the skill it called; None if they disagree."""
    known = [
        (term, value)
        for term, mine in zip(call.args, head.args, strict=True)
        if (value := resolve(mine, own)) is not None
    ]
    return unify(known, bindings)


def _names_of_objects(clause: SkillClause) -> Iterator[str]:
    """Give the variables that stand for what an instance is about, not for what it measures."""
    conditions = (*clause.elements, *clause.effects)
    atoms = (clause.head, *clause.subskills, *(condition.atom for condition in conditions))
    for atom in atoms:
        for term in atom.args:
            if isinstance(term, Variable):
                yield term.name
