"""Symbols where numbers are wanted, and comparisons that can never hold.

An object's name is a symbol. What an attribute or an argument holds is read off the constants that
the file itself writes there, in patterns, effects and tests: only where these all agree is anything
concluded, and a domain that never names a value is left alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TypeAlias

from icarus_lite.language.checking.report import Report
from icarus_lite.language.functions import Function, Kind
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import (
    Atom,
    Bind,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Domain,
    DomainTest,
    Expression,
    LaterCycle,
    SkillClause,
    Span,
    Term,
    Variable,
)
from icarus_lite.records import dataclass, field

_Slot: TypeAlias = tuple[str, str | int]  # a predicate, and an attribute or argument of it

_SYMBOL, _NUMBER = "a symbol", "a number"
_UNKNOWN = "something unknown"  # stands among the kinds of a slot that a clause fills


@dataclass(frozen=True, slots=True)
class _Evidence:
    """What a slot or variable holds, and how that is known."""

    kind: str
    because: str
    certain: bool = False


@dataclass(slots=True)
class _Slots:
    """What is known of each slot: the first constant of each kind written there."""

    constants: dict[_Slot, dict[str, Span]] = field(default_factory=dict)
    defined: dict[_Slot, _Evidence] = field(default_factory=dict)

    def evidence(self, slot: _Slot) -> _Evidence | None:
        """Give what a slot holds, or None if that is unknown or mixed."""
        if slot in self.defined:
            return self.defined[slot]
        known = self.constants.get(slot, {})
        if len(known) != 1 or _UNKNOWN in known:
            return None
        ((kind, span),) = known.items()
        what = f"`^{slot[1]}` of `{slot[0]}`" if isinstance(slot[1], str) else f"`{slot[0]}`"
        return _Evidence(kind, f"{what} has {kind} in {span.in_line}")


def check_kinds(domain: Domain, functions: Mapping[str, Function], report: Report) -> None:
    """Report tests of the wrong type.

    An object's name where a number is wanted is an error, for evaluation would stop there; what
    is only concluded from constants is a warning.
    """
    _Kinds(domain, functions, report).check()


class _Kinds:
    """One analysis of one domain."""

    def __init__(self, domain: Domain, functions: Mapping[str, Function], report: Report) -> None:
        self._domain = domain
        self._functions = functions
        self._report = report
        self._slots = _Slots()
        self._chains = lineages(domain.percepts)
        self._owners = {
            (percept.name, attribute): percept.name
            for percept in domain.percepts
            for attribute in percept.attributes
        }

    def check(self) -> None:
        """Collect what the file says about its values, then check each clause."""
        for atom in _written(self._domain):
            for slot, term in self._places(atom):
                if isinstance(term, Constant):
                    kind = _SYMBOL if isinstance(term.value, str) else _NUMBER
                    self._slots.constants.setdefault(slot, {}).setdefault(kind, term.span)
        for concept in self._domain.concepts:
            self._define(concept)
        clauses: list[ConceptClause | SkillClause] = [*self._domain.concepts, *self._domain.skills]
        for clause in clauses:
            known = self._variables(clause.elements, _binds(clause))
            for call in (*clause.tests, *_computed(clause)):
                self._check_call(call, known)
        for contradiction in self._domain.contradictions:
            patterns = (Condition(contradiction.head), *contradiction.elements)
            known = self._variables(patterns, ())
            for call in contradiction.tests:
                self._check_call(call, known)

    def _places(self, atom: Atom) -> Iterator[tuple[_Slot, Term]]:
        name = atom.predicate
        for number, term in enumerate(atom.args):
            yield (name, number), term
        for attribute, term in atom.attributes:
            chain = self._chains.get(name, (name,))
            owners = [each for each in chain if (each, attribute) in self._owners]
            yield (owners[0] if owners else name, attribute), term

    def _define(self, concept: ConceptClause) -> None:
        """Carry what a clause computes, or takes from objects, to the slots of its head."""
        known = self._variables(concept.elements, concept.binds)
        for slot, term in self._places(concept.head):
            evidence = known.get(term.name) if isinstance(term, Variable) else None
            if evidence is None or not evidence.certain:
                self._slots.defined.pop(slot, None)
                self._slots.constants.setdefault(slot, {}).setdefault(_UNKNOWN, concept.span)
            elif slot not in self._slots.constants:
                self._slots.defined.setdefault(slot, evidence)

    def _variables(
        self, elements: Iterable[Condition], binds: Iterable[Bind]
    ) -> dict[str, _Evidence]:
        """Give what each variable of a clause holds, as far as it is known."""
        known: dict[str, _Evidence] = {}
        for element in elements:
            if element.negated:
                continue
            for slot, term in self._places(element.atom):
                if not isinstance(term, Variable):
                    continue
                if slot[0] in self._chains and slot[1] == 0:
                    because = f"it is the name of a percept of type `{slot[0]}`"
                    known[term.name] = _Evidence(_SYMBOL, because, certain=True)
                    continue
                evidence = self._slots.evidence(slot)
                if evidence is not None:
                    known.setdefault(term.name, evidence)
        for bind in binds:
            kind = self._kind(bind.expression, known)
            if kind is not None:
                known[bind.variable.name] = kind
        return known

    def _kind(self, expression: Expression, known: Mapping[str, _Evidence]) -> _Evidence | None:
        if isinstance(expression, Variable):
            return known.get(expression.name)
        if isinstance(expression, Constant):
            kind = _SYMBOL if isinstance(expression.value, str) else _NUMBER
            return _Evidence(kind, f"{expression} is {kind}", certain=True)
        function = self._functions.get(expression.function)
        if function is None or function.gives is not Kind.NUMBER:
            return None
        because = f"`{expression.function}` gives {_NUMBER}"
        return _Evidence(_NUMBER, because, certain=True)

    def _check_call(self, call: Call, known: Mapping[str, _Evidence]) -> None:
        function = self._functions.get(call.function)
        for argument in call.args:
            if isinstance(argument, Call):
                self._check_call(argument, known)
        if function is None:
            return
        if function.takes is Kind.NUMBER:
            self._check_numbers(call, known)
        elif call.function in ("=", "/="):
            self._check_equality(call, known)

    def _check_numbers(self, call: Call, known: Mapping[str, _Evidence]) -> None:
        for argument in call.args:
            evidence = known.get(argument.name) if isinstance(argument, Variable) else None
            if evidence is None or evidence.kind != _SYMBOL:
                continue
            message = f"{argument} is {_SYMBOL}, but `{call.function}` takes numbers"
            hint = f"{evidence.because}; was another variable or attribute meant?"
            tell = self._report.error if evidence.certain else self._report.warning
            tell(argument.span, "ICR044", message, hint)

    def _check_equality(self, call: Call, known: Mapping[str, _Evidence]) -> None:
        kinds = [self._kind(argument, known) for argument in call.args]
        told = [kind for kind in kinds if kind is not None]
        if len(told) < len(kinds) or len({kind.kind for kind in told}) < 2:
            return
        always = "never" if call.function == "=" else "always"
        message = f"{call} {always} holds: a symbol is never equal to a number"
        because = [
            kind.because
            for kind, argument in zip(told, call.args, strict=True)
            if isinstance(argument, Variable)
        ]
        self._report.warning(call.span, "ICR044", message, "; ".join(because))


def _binds(clause: ConceptClause | SkillClause) -> tuple[Bind, ...]:
    return clause.binds if isinstance(clause, ConceptClause) else ()


def _computed(clause: ConceptClause | SkillClause) -> Iterator[Call]:
    for bind in _binds(clause):
        if isinstance(bind.expression, Call):
            yield bind.expression


def _written(domain: Domain) -> Iterator[Atom]:
    """Give every pattern over percepts and beliefs that the file writes down."""
    conditions: list[Condition] = [*domain.goals]
    for concept in domain.concepts:
        conditions += concept.elements
        yield concept.head
    for skill in domain.skills:
        conditions += (*skill.elements, *skill.holds, *skill.effects)
    for contradiction in domain.contradictions:
        conditions += contradiction.elements
        yield contradiction.head
    for task in domain.tasks:
        conditions += task.goals
        yield from task.init
    for test in domain.tests:
        yield from test.init
        yield from _tested(test)
        for later in test.then:
            yield from _tested(later)
        conditions += test.goals
    for condition in conditions:
        yield condition.atom


def _tested(test: DomainTest | LaterCycle) -> Iterator[Atom]:
    yield from (*(test.percepts or ()), *test.expect, *test.expect_not)
