"""What grounding makes of a domain once and for all: its clauses, sorted and compiled.

Which clauses count depends on the predicates of the goals, so there is one such preparation for
each kind of goal; all of them together are a `PlanningDomain`, which whoever plans again and again
in one domain keeps.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from icarus_lite.inference import Evaluator
from icarus_lite.language.syntax import (
    Atom,
    ConceptClause,
    Condition,
    Domain,
    SkillClause,
)
from icarus_lite.planning.grounding.attaching import Attaching
from icarus_lite.planning.grounding.clauses import GroundedClause, is_bound, timed_tests
from icarus_lite.planning.grounding.facts import GIVEN, HELD
from icarus_lite.planning.grounding.program import Program, compile_program
from icarus_lite.planning.relevance import relevance
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import ATTACHED

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.inference import Closure

GOAL = "goal "
"""Begins the name of a made-up concept that stands for goals with variables."""


class LateClosure:
    """What derives concepts, compiled when it is first asked for: most of PDDL needs none."""

    __slots__ = ("_closure", "_concepts", "_evaluator")

    def __init__(self, concepts: Sequence[ConceptClause], evaluator: Evaluator) -> None:
        self._concepts, self._evaluator = concepts, evaluator
        self._closure: Closure | None = None

    def __call__(self) -> Closure:
        """Give it; the same each time."""
        if self._closure is None:
            from icarus_lite.inference import Closure  # noqa: PLC0415 - see above

            self._closure = Closure(self._concepts, self._evaluator)
        return self._closure


@dataclass(frozen=True, slots=True)
class Prepared:
    """The clauses that are ground for goals of one kind.

    Args:
        clauses: The skills in the order of the domain, then the concepts.
        program: The functions that find their instances.
        fluents: The predicates whose facts may change.
        concepts: Those of them that concepts define.
        hierarchy: The predicate of the facts that stand for the attachment hierarchy.
        recursive: Those of these that are used in their own definition, those alike that are
            defined by one another.
        goals: The goals; those that variables connect as one made-up literal.
        closure: Gives what derives the concepts, for whoever imagines what plans lead to.
    """

    clauses: tuple[GroundedClause, ...]
    program: Program
    fluents: frozenset[str]
    concepts: frozenset[str]
    hierarchy: str
    recursive: Mapping[str, int]
    goals: tuple[Condition, ...]
    closure: LateClosure


class PlanningDomain:
    """A domain with all that planning in it needs again and again.

    Args:
        domain: The domain.
        evaluator: Evaluates its tests.
    """

    __slots__ = ("_alone", "_evaluator", "_prepared", "domain")

    def __init__(self, domain: Domain, evaluator: Evaluator | None = None) -> None:
        self.domain = domain
        self._evaluator = evaluator or Evaluator()
        self._prepared: dict[tuple[tuple[Condition, ...], bool], Prepared] = {}
        self._alone: PlanningDomain | None = None

    def alone(self) -> PlanningDomain:
        """Give the same domain without what other agents do; itself if there are none."""
        if self._alone is None:
            own = tuple(clause for clause in self.domain.skills if clause.agent is None)
            if own == self.domain.skills:
                return self
            self._alone = PlanningDomain(replace(self.domain, skills=own), self._evaluator)
        return self._alone

    def prepare(
        self, goals: Sequence[Condition], watched: Sequence[str] = (), *, banning: bool = False
    ) -> Prepared:
        """Give the clauses that count for these goals, compiled.

        Args:
            goals: The conjunction to achieve.
            watched: Predicates whose facts are wanted beyond what the goals need.
            banning: Whether some actions must not be used.
        """
        wanted = (*goals, *(Condition(Atom(name)) for name in watched))
        prepared = self._prepared.get((wanted, banning))
        if prepared is None:
            prepared = _prepare(self.domain, tuple(goals), wanted, self._evaluator, banning=banning)
            self._prepared[wanted, banning] = prepared
        return prepared


def _prepare(
    domain: Domain,
    goals: tuple[Condition, ...],
    wanted: tuple[Condition, ...],
    evaluator: Evaluator,
    *,
    banning: bool,
) -> Prepared:
    skills = [clause for clause in relevance(domain, wanted).skills if _can_be_bound(clause)]
    attaching = {id(clause): Attaching(domain, clause) for clause in skills}
    fluents = {effect.atom.predicate for clause in skills for effect in clause.effects}
    if any(attaching.values()):
        fluents.add(ATTACHED)
    stood_for, made_up = _made_up(goals)
    every = (*domain.concepts, *made_up)
    _spread(fluents, every)
    fluents.update(clause.head.predicate for clause in made_up)
    defined = {clause.head.predicate for clause in every} & fluents
    hierarchy = HELD + ATTACHED if ATTACHED in defined else ATTACHED
    used = {condition.atom.predicate for condition in wanted}
    used.update(clause.head.predicate for clause in made_up)
    used.update(c.atom.predicate for clause in skills for c in clause.elements)
    used.update(effect.atom.predicate for clause in skills for effect in clause.effects)
    concepts = _used(used, [each for each in every if each.head.predicate in defined])
    grounded = []
    counted: tuple[SkillClause | ConceptClause, ...] = (*skills, *concepts)
    for number, clause in enumerate(counted):
        made = attaching.get(id(clause)) or None
        grounded.append(_ground_clause(number, clause, fluents, defined, made))
    program = compile_program(grounded, banning=banning)
    derived = tuple(each for each in concepts if not each.head.predicate.startswith(GOAL))
    return Prepared(
        tuple(grounded),
        program,
        frozenset(fluents),
        frozenset(defined),
        hierarchy,
        _recursive(concepts),
        stood_for,
        LateClosure(derived, evaluator),
    )


def _recursive(concepts: Sequence[ConceptClause]) -> Mapping[str, int]:
    """Give the concepts that depend on themselves, those that do so together a number."""
    if not concepts:
        return {}
    from icarus_lite.language.checking import stratification  # noqa: PLC0415 - else not needed

    recursive = stratification.recursive_concepts(concepts)
    groups = enumerate(stratification.strata(concepts))
    return {name: number for number, group in groups for name in group if name in recursive}


def _can_be_bound(clause: SkillClause) -> bool:
    """Tell whether instances of a skill have all arguments bound, so that they can be steps."""
    names = {name for c in clause.elements if not c.negated for name in c.atom.variables}
    return all(is_bound(atom, names) for atom in (clause.head, *clause.actions))


def _spread(fluents: set[str], concepts: Sequence[ConceptClause]) -> None:
    """Add the concepts that rest on what may change."""
    before = -1
    while before != len(fluents):
        before = len(fluents)
        for clause in concepts:
            if any(c.atom.predicate in fluents for c in clause.elements):
                fluents.add(clause.head.predicate)


def _used(used: set[str], concepts: Sequence[ConceptClause]) -> list[ConceptClause]:
    """Give the concepts that something asks for, directly or through others."""
    before = -1
    while before != len(used):
        before = len(used)
        for clause in concepts:
            if clause.head.predicate in used:
                used.update(c.atom.predicate for c in clause.elements)
    return [clause for clause in concepts if clause.head.predicate in used]


def _made_up(
    goals: tuple[Condition, ...],
) -> tuple[tuple[Condition, ...], tuple[ConceptClause, ...]]:
    """Turn goals that variables connect, or that speak of attributes, into concepts.

    Returns:
        The goals, such groups replaced by one literal each; and the concepts that define these.
    """
    shared = {name for goal in goals if not goal.negated for name in goal.atom.variables}
    groups: list[tuple[set[str], list[Condition]]] = []
    for goal in goals:
        names = shared.intersection(goal.atom.variables)
        touching = [group for group in groups if group[0] & names]
        for group in touching:
            groups.remove(group)
        members = [*(each for _, group in touching for each in group), goal]
        groups.append((names.union(*(group[0] for group in touching)), members))
    stood_for, concepts = list[Condition](), list[ConceptClause]()
    for names, members in groups:
        if not names and not members[0].atom.attributes:
            stood_for += members
            continue
        head = Atom(f"{GOAL}{len(concepts)}")
        in_order = tuple(goal for goal in goals if goal in members)
        concepts.append(ConceptClause(head, in_order))
        stood_for.append(Condition(head))
    return tuple(stood_for), tuple(concepts)


def _ground_clause(
    number: int,
    clause: SkillClause | ConceptClause,
    fluents: Iterable[str],
    concepts: Iterable[str],
    attaching: Attaching | None,
) -> GroundedClause:
    positive = tuple(c.atom for c in clause.elements if not c.negated)
    negative = tuple(c.atom for c in clause.elements if c.negated)
    effects: tuple[Atom, ...]
    removals: tuple[Atom, ...] = ()
    if isinstance(clause, ConceptClause):
        effects = (clause.head,)
    else:
        effects = tuple(_given(e.atom, concepts) for e in clause.effects if not e.negated)
        effects = tuple(atom for atom in effects if atom.predicate != ATTACHED)
        removals = tuple(effect.atom for effect in clause.effects if effect.negated)
    return GroundedClause(
        number,
        clause,
        tuple(dict.fromkeys(name for atom in positive for name in atom.variables)),
        positive,
        frozenset(place for place, atom in enumerate(positive) if atom.predicate in fluents),
        tuple(atom for atom in negative if atom.predicate in fluents),
        tuple(atom for atom in negative if atom.predicate not in fluents),
        timed_tests(clause.tests, positive),
        effects,
        removals,
        attaching,
    )


def _given(atom: Atom, concepts: Iterable[str]) -> Atom:
    """Give an effect as it is asserted: apart from what concepts derive, if they do."""
    if atom.predicate not in concepts:
        return atom
    return Atom(GIVEN + atom.predicate, atom.args, atom.attributes, atom.span)
