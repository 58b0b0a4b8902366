"""A plan that has worked, as a macro skill: the same for other objects, without search.

The plan is generalised by what it rests on (explanation-based generalisation): its goal, taken
back through all steps, gives the start conditions; what the plan merely happened to be about
becomes a variable, while what the domain names itself stays as it is. Objects that were different
stay different, so that wherever the start conditions hold the plan works as it did.

Nothing adopts a macro but the person to whom its text is shown.

Source: Mitchell, Keller and Kedar-Cabelli 1986; Fikes, Hart and Nilsson 1972 (MACROPs).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from icarus_lite.inference import Derivation, Support
from icarus_lite.language.formatting.formatter import format_text
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Domain,
    Expression,
    SkillClause,
    Term,
    Variable,
)
from icarus_lite.planning.causes import Requirement, pattern_of
from icarus_lite.planning.plan import Plan
from icarus_lite.planning.projection import Stage
from icarus_lite.planning.steps import PlanStep
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value

_UNFIT = re.compile(r"[^\w-]+", re.ASCII)


@dataclass(frozen=True, slots=True)
class Macro:
    """A plan as a macro skill.

    Args:
        clause: The skill.
        remarks: What a person should know before adopting it.
    """

    clause: SkillClause
    remarks: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The skill as a form for a domain file, in the canonical layout."""
        fields: list[tuple[str, Sequence[object]]] = [
            (":elements", self.clause.elements),
            (":tests", self.clause.tests),
            (":subskills", self.clause.subskills),
            (":effects", self.clause.effects),
        ]
        shown = " ".join(f"{word} ({' '.join(map(str, v))})" for word, v in fields if v)
        lines = [f"; {remark}" for remark in self.remarks]
        return format_text("\n".join([*lines, f"(skills ({self.clause.head} {shown}))"]) + "\n")


def macro(domain: Domain, plan: Plan, start: Stage, name: str = "") -> Macro:
    """Generalise a plan.

    Args:
        domain: The domain, which the macro could be put into.
        plan: A plan of at least one step, with its links.
        start: What was believed before its first step.
        name: What the skill shall be called; by what it achieves, if empty.

    Raises:
        ValueError: the plan has no steps or no links.
    """
    if not plan.steps or not plan.needs:
        raise ValueError("only a plan with steps and links can be made a macro skill")
    goals = tuple(need.literal for need in plan.needs[-1].conditions)
    naming = _Naming(plan, start)
    required = _without_implied(plan.required(0), start)
    elements, remarks = [], []
    for requirement in required:
        literal = naming.literal(requirement.literal)
        held = [fact for fact in requirement.excepting if fact in start.facts]
        if held:
            shown = ", ".join(str(naming.atom(pattern_of(fact))) for fact in held)
            remarks.append(f"{literal}: not asked for at the start, where {shown} holds")
        else:
            elements.append(literal)
    subskills = tuple(naming.call(step) for step in plan.steps)
    effects = tuple(naming.literal(goal) for goal in goals)
    known = {n for c in elements if not c.negated for n in c.atom.variables}
    tests = (*naming.distinct(start), *_tests(plan, naming, known))
    arguments = dict.fromkeys(n for effect in effects for n in effect.atom.variables)
    head = Atom(name or _name(domain, goals), tuple(Variable(each) for each in arguments))
    clause = SkillClause(
        head,
        tuple(dict.fromkeys(elements)),
        tuple(dict.fromkeys(tests)),
        subskills=subskills,
        effects=effects,
    )
    return Macro(clause, tuple(dict.fromkeys(remarks)))


class _Naming:
    """What the values of a plan are called in the macro."""

    def __init__(self, plan: Plan, start: Stage) -> None:
        fixed, self._fixed_values = _named_by_domain(plan, start)
        values = dict.fromkeys(
            term.value
            for atom in _atoms(plan)
            for term in atom.args
            if isinstance(term, Constant) and term.value not in fixed
        )
        self._names: dict[Value, str] = {}
        for value in values:
            self._names[value] = self._fresh(str(value))

    def _fresh(self, wish: str) -> str:
        stem = "?" + (_UNFIT.sub("-", wish).strip("-") or "x")
        name, number = stem, 1
        while name in self._names.values():
            number += 1
            name = f"{stem}-{number}"
        return name

    def literal(self, literal: Condition) -> Condition:
        """Give a literal with its objects as variables."""
        return Condition(self.atom(literal.atom), literal.negated)

    def atom(self, atom: Atom) -> Atom:
        """Give an atom with its objects as variables; what it measures is named after them."""
        args = tuple(self._term(term) for term in atom.args)
        whose = str(args[0]) if args else "?it"
        attributes = tuple((n, self._value(whose, n, term)) for n, term in atom.attributes)
        return Atom(atom.predicate, args, attributes)

    def _value(self, whose: str, attribute: str, term: Term) -> Term:
        if isinstance(term, Variable):
            return self.measure(whose, attribute)
        return term if (attribute, term.value) in self._fixed_values else self._term(term)

    def measure(self, whose: str, attribute: str) -> Variable:
        """Name the value of an attribute, the same wherever it is asked for."""
        return Variable(f"?{_UNFIT.sub('-', whose.lstrip('?'))}-{attribute}")

    def call(self, step: PlanStep) -> Atom:
        """Give a step as a subskill; what it measures, it binds itself."""
        args = (
            self._argument(t, v)
            for t, v in zip(step.clause.head.args, step.action.args, strict=True)
        )
        return Atom(step.action.name, tuple(args))

    def term_of(self, value: Value) -> Term:
        """Give the variable, or the constant, that stands for a value."""
        return self._term(Constant(value))

    def distinct(self, start: Stage) -> Iterator[Call]:
        """Give the tests that keep objects of one kind apart."""
        kinds_of: dict[Value, list[str]] = {}
        for fact in start.percepts:
            kinds_of.setdefault(fact.args[0], []).append(fact.predicate)
        kinds: dict[frozenset[str], list[str]] = {}
        for value, name in self._names.items():
            types = frozenset(kinds_of.get(value, ()))
            kinds.setdefault(types, []).append(name)
        for names in kinds.values():
            if len(names) > 1:
                yield Call("/=", tuple(map(Variable, names)))

    def _argument(self, own: Term, value: Value) -> Term:
        if value in self._names or isinstance(own, Constant):
            return self._term(Constant(value))
        return Constant(value) if isinstance(value, str) else Variable(f"?_{own.name[1:]}")

    def _term(self, term: Term) -> Term:
        if isinstance(term, Constant) and term.value in self._names:
            return Variable(self._names[term.value])
        return term


def _atoms(plan: Plan) -> Iterator[Atom]:
    """Give all that the plan speaks of, the goals first."""
    for need in plan.needs[-1].conditions:
        yield need.literal.atom
    for requirement in plan.required(0):
        yield requirement.literal.atom


def _named_by_domain(plan: Plan, start: Stage) -> tuple[set[Value], set[tuple[str, Value]]]:
    """Give the objects, and the attributes' values, that the clauses behind the plan name."""
    clauses: list[SkillClause | ConceptClause] = [step.clause for step in plan.steps]
    clauses += [
        support.clause
        for supports in start.supports.values()
        for support in supports
        if isinstance(support, Derivation)
    ]
    objects, values = set[Value](), set[tuple[str, Value]]()
    for clause in {id(each): each for each in clauses}.values():
        atoms = [clause.head, *(condition.atom for condition in clause.elements)]
        if isinstance(clause, SkillClause):
            atoms += [*clause.actions, *(effect.atom for effect in clause.effects)]
        for atom in atoms:
            objects.update(term.value for term in atom.args if isinstance(term, Constant))
            values.update((n, t.value) for n, t in atom.attributes if isinstance(t, Constant))
    return objects, values


def _without_implied(required: Sequence[Requirement], start: Stage) -> list[Requirement]:
    """Leave out what another required belief rests on: where that holds, this does."""
    implied: set[Condition] = set()
    waiting = [each.literal for each in required if not each.literal.negated]
    for literal in waiting:
        for support in _first(start, literal):
            parts = [Condition(pattern_of(fact)) for fact in support.matched]
            parts += [Condition(atom, negated=True) for atom in support.absent]
            fresh = [part for part in parts if part not in implied]
            implied.update(fresh)
            waiting += [part for part in fresh if not part.negated]
    return [each for each in required if each.literal not in implied]


def _first(start: Stage, literal: Condition) -> Iterable[Derivation]:
    belief = next((fact for _, fact in start.facts.matches(literal.atom, {})), None)
    if belief is None or belief in start.given:
        return ()
    supports: Sequence[Support] = start.supports.get(belief, ())
    # With several supports, another one may hold elsewhere.
    return [s for s in supports if isinstance(s, Derivation)] if len(supports) == 1 else ()


def _tests(plan: Plan, naming: _Naming, known: set[str]) -> Iterator[Call]:
    """Give the tests of the steps that are about what the start conditions bind."""
    for step in plan.steps:
        names = _names_in(step, naming)
        for test in step.clause.tests:
            lifted = _replaced(test, names)
            if isinstance(lifted, Call) and known.issuperset(_variables(lifted)):
                yield lifted


def _names_in(step: PlanStep, naming: _Naming) -> dict[str, Term]:
    """Say what the variables of a step's clause are called in the macro."""
    bindings, names = dict(step.bindings), dict[str, Term]()
    conditions = [condition.atom for condition in step.clause.elements if not condition.negated]
    for atom in conditions:
        for term in atom.args:
            if isinstance(term, Variable):
                names[term.name] = naming.term_of(bindings[term.name])
    for atom in conditions:
        for attribute, term in atom.attributes:
            if isinstance(term, Variable):
                whose = str(_replaced(atom.args[0], names))
                names.setdefault(term.name, naming.measure(whose, attribute))
    return names


def _replaced(expression: Expression, names: dict[str, Term]) -> Expression:
    if isinstance(expression, Variable):
        return names.get(expression.name, expression)
    if isinstance(expression, Call):
        return Call(expression.function, tuple(_replaced(a, names) for a in expression.args))
    return expression


def _variables(expression: Expression) -> Iterator[str]:
    if isinstance(expression, Variable):
        yield expression.name
    elif isinstance(expression, Call):
        for argument in expression.args:
            yield from _variables(argument)


def _name(domain: Domain, goals: Sequence[Condition]) -> str:
    """Name a macro by what it achieves, other than any skill of the domain."""
    parts = [("not-" if goal.negated else "") + goal.atom.predicate for goal in goals]
    stem = name = "achieve-" + "-and-".join(dict.fromkeys(parts))
    taken, number = {clause.head.predicate for clause in domain.skills}, 1
    while name in taken:
        number += 1
        name = f"{stem}-{number}"
    return name
