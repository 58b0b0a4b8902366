"""PDDL into a domain of this language: types are perceived, actions are skills, rules concepts.

An object is a percept of its type; the facts of the initial state are given by the task. So the
one file that comes out holds everything that a plan needs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from icarus_lite.language.checking.report import Report
from icarus_lite.language.checking.stratification import negation_cycles
from icarus_lite.language.pddl.conditions import (
    Alternative,
    Alternatives,
    Literal,
    is_implied,
)
from icarus_lite.language.pddl.names import Names
from icarus_lite.language.pddl.scope import RefusedError, Scope
from icarus_lite.language.pddl.syntax import (
    OBJECT,
    Equal,
    Fact,
    PddlAction,
    PddlDomain,
    PddlProblem,
    Rule,
    Typed,
)
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Domain,
    PerceptType,
    SkillClause,
    Task,
    Term,
    Variable,
)
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import ATTACHED

TASK = "problem"
"""The name of the task that an imported problem becomes."""

_REACHED = "goal-reached"


def import_problem(
    domain: PddlDomain, problem: PddlProblem, domain_report: Report, problem_report: Report
) -> Domain | None:
    """Make a domain with one task, named `problem`, of a PDDL domain and problem.

    Args:
        domain: The PDDL domain.
        problem: The PDDL problem.
        domain_report: Where findings about the domain go.
        problem_report: Where findings about the problem go.

    Returns:
        The domain; or None, with the reasons reported as errors.
    """
    return _Import(domain, problem, domain_report, problem_report).run()


@dataclass(slots=True)
class _Import:
    """One import.

    The names of predicates and types are kept unless two of them, or one of ours, coincide.
    """

    domain: PddlDomain
    problem: PddlProblem
    domain_report: Report
    problem_report: Report
    names: Names = field(default_factory=lambda: Names([ATTACHED, "not"]))
    used_types: dict[str, None] = field(default_factory=dict)
    asked: dict[str, None] = field(default_factory=dict)

    def run(self) -> Domain | None:
        """Import everything; what cannot be imported is reported, all of it."""
        self._name_predicates()
        scope = self._scope(self.domain_report)
        concepts: list[ConceptClause] = []
        skills: list[SkillClause] = []
        sound = True
        for rule in self.domain.rules:
            try:
                concepts += self._concept(rule, scope)
            except RefusedError:
                sound = False
        for action in self.domain.actions:
            try:
                skills += self._skills(action, scope)
            except RefusedError:
                sound = False
        try:
            goals, extra = self._goal()
        except RefusedError:
            sound = False
        if not sound or not self._is_stratified(concepts):
            return None
        concepts += [*extra, *self._never_true()]
        return Domain(
            name=self.domain.name,
            percepts=tuple(self._percepts()),
            concepts=tuple(concepts),
            skills=tuple(skills),
            tasks=(Task(TASK, self.problem.name, None, goals, init=tuple(self._facts())),),
            documentation=f"Imported from PDDL: {self.domain.name}, {self.problem.name}.",
        )

    def _scope(self, report: Report) -> Scope:
        return Scope(
            report,
            {each.name: each.type for each in self.domain.types},
            {each.name: each.type for each in self._objects()},
            {each.name: each for each in self.domain.predicates},
            set(self.domain.derived),
        )

    def _objects(self) -> Iterator[Typed]:
        yield from self.domain.constants
        yield from self.problem.objects

    def _name_predicates(self) -> None:
        for predicate in self.domain.predicates:
            wish = "attached-to" if predicate.name == ATTACHED else predicate.name
            name = self._predicate(predicate.name, wish)
            if name != predicate.name:
                message = f"`{predicate.name}` becomes `{name}`"
                hint = f"`{ATTACHED}` obeys rules of its own here: one parent for each child"
                self.domain_report.note(predicate.span, "PDDL016", message, hint)

    def _predicate(self, name: str, wish: str = "") -> str:
        return self.names.of(("predicate", name), wish or name)

    def _type(self, name: str) -> str:
        self.used_types[name] = None
        return self.names.of(("type", name), name)

    def _skills(self, action: PddlAction, scope: Scope) -> Iterator[SkillClause]:
        head = Atom(action.name, tuple(Variable(each.name) for each in action.parameters))
        splitter = Alternatives(scope, {each.name for each in action.parameters})
        for alternative in splitter.of(action.precondition):
            elements, tests = self._body(action.parameters, alternative, scope)
            yield SkillClause(
                head,
                elements,
                tests,
                actions=(head,),
                effects=tuple(self._effects(action)),
                span=action.span,
            )

    def _effects(self, action: PddlAction) -> Iterator[Condition]:
        taken = {each.name for each in action.parameters}
        for effect in action.effects:
            # A name that begins with ?any says that whatever matches is removed.
            free = {each.name: f"?any-{each.name[1:]}" for each in effect.every}
            while taken & set(free.values()):
                free = {name: f"{new}-2" for name, new in free.items()}
            yield Condition(self._atom(effect.fact, free), effect.negated)
            self.asked[effect.fact.predicate] = None

    def _concept(self, rule: Rule, scope: Scope) -> Iterator[ConceptClause]:
        head = self._atom(Fact(rule.predicate, tuple(each.name for each in rule.parameters)))
        splitter = Alternatives(scope, {each.name for each in rule.parameters})
        for alternative in splitter.of(rule.body):
            elements, tests = self._body(rule.parameters, alternative, scope)
            yield ConceptClause(head, elements, tests, span=rule.span)

    def _goal(self) -> tuple[tuple[Condition, ...], list[ConceptClause]]:
        """Give the goal; where it is no conjunction of literals, also a concept that is one."""
        scope = self._scope(self.problem_report)
        alternatives = Alternatives(scope).of(self.problem.goal)
        bodies = [self._body((), alternative, scope) for alternative in alternatives]
        if len(bodies) == 1 and bodies[0][0] and not bodies[0][1]:
            return bodies[0][0], []
        head = Atom(self._predicate(_REACHED))
        return (Condition(head),), [ConceptClause(head, *body) for body in bodies]

    def _body(
        self, parameters: Sequence[Typed], alternative: Alternative, scope: Scope
    ) -> tuple[tuple[Condition, ...], tuple[Call, ...]]:
        """Give the elements and tests of a clause.

        Types come after the positive literals, which bind the variables, and only where these do
        not imply them.
        """
        literals = alternative.literals
        names = _local_names(parameters, alternative)
        positive: list[Condition] = []
        negative: list[Condition] = []
        tests: list[Call] = []
        for literal in literals:
            match literal.formula:
                case Fact() as fact:
                    self.asked[fact.predicate] = None
                    chosen = negative if literal.negated else positive
                    chosen.append(Condition(self._atom(fact, names), literal.negated))
                case Equal(left, right):
                    terms = (_term(left, names), _term(right, names))
                    tests.append(Call("/=" if literal.negated else "=", terms))
        bound = {name for condition in positive for name in condition.atom.variables}
        types = [
            Condition(Atom(self._type(each.type), (Variable(names.get(each.name, each.name)),)))
            for each in (*parameters, *alternative.variables)
            if not is_implied(scope, literals, each)
            and not (each.type == OBJECT and names.get(each.name, each.name) in bound)
        ]
        return (*positive, *types, *negative), tuple(tests)

    def _atom(self, fact: Fact, names: dict[str, str] | None = None) -> Atom:
        args = tuple(_term(term, names or {}) for term in fact.args)
        return Atom(self._predicate(fact.predicate), args)

    def _percepts(self) -> Iterator[PerceptType]:
        """Declare the types of objects and conditions, and those between them."""
        above = {each.name: each.type for each in self.domain.types}
        needed = set(self.used_types) | {each.type for each in self._objects()}
        for name in tuple(needed):
            chain = [name]
            while chain[-1] in above:
                chain.append(above[chain[-1]])
            tops = [i for i, each in enumerate(chain) if each in needed]
            needed.update(chain[: tops[-1]])
        if OBJECT in needed:
            yield PerceptType(self._type(OBJECT), ())
        for each in self.domain.types:
            if each.name in needed:
                supertype = self._type(each.type) if each.type in needed else None
                yield PerceptType(self._type(each.name), (), supertype)

    def _facts(self) -> Iterator[Atom]:
        for each in self._objects():
            yield Atom(self._type(each.type), (Constant(each.name),))
        for fact in self.problem.init:
            if fact.predicate in self.asked:
                yield self._atom(fact)

    def _never_true(self) -> Iterator[ConceptClause]:
        """Define what is asked for and can never be true, so that it is not unknown."""
        possible = self.domain.derived | {fact.predicate for fact in self.problem.init}
        for action in self.domain.actions:
            possible |= {each.fact.predicate for each in action.effects if not each.negated}
        for predicate in self.domain.predicates:
            if predicate.name in self.asked and predicate.name not in possible:
                head = self._atom(Fact(predicate.name, tuple(p.name for p in predicate.parameters)))
                yield ConceptClause(head, (Condition(head),))

    def _is_stratified(self, concepts: Iterable[ConceptClause]) -> bool:
        for cycle in negation_cycles(tuple(concepts)):
            message = f"`{cycle.clause.head.predicate}` depends on its own negation: {cycle}"
            hint = "a derived predicate must be decided before `not` asks for it"
            self.domain_report.error(cycle.clause.span, "PDDL012", message, hint)
            return False
        return True


def _term(name: str, names: dict[str, str]) -> Term:
    return Variable(names.get(name, name)) if name.startswith("?") else Constant(name)


def _local_names(parameters: Iterable[Typed], alternative: Alternative) -> dict[str, str]:
    """Rename the variables that stand for whatever there is: `?any-z`, as one reads it here."""
    taken = {each.name for each in (*parameters, *alternative.variables)}
    uses: list[str] = []
    for literal in alternative.literals:
        match literal:
            case Literal(Fact(_, args)):
                uses += args
            case Literal(Equal(left, right)):
                uses += [left, right]
    lonely = [each.name for each in alternative.variables if uses.count(each.name) == 1]
    lonely += [name for literal in alternative.literals for name in literal.absent]
    names: dict[str, str] = {}
    for name in lonely:
        new = f"?any-{name[1:]}"
        while new in taken:
            new += "-2"
        taken.add(new)
        names[name] = new
    return names
