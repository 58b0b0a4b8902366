"""Beliefs against clingo's, on random programs.

Each program is stratified and has what makes inference hard: recursion alone and in pairs,
negation with local variables, several strata, numeric tests, constants, variables repeated inside
a literal, attributes that may be missing. A stratified program has one model, and grounding alone
finds it. `make fuzz-engine` tries 10,000 programs, `make test` a few hundred.
"""

from __future__ import annotations

import os
import random

import clingo
import pytest

from icarus_lite import Belief
from icarus_lite.inference import Closure, FactStore
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Expression,
    Variable,
)

_PROGRAMS = int(os.environ.get("ICARUS_FUZZ_PROGRAMS", "400"))
_PARTS = 4

_GIVEN = {"e": 2, "f": 1, "o": 1, "g": 3}
_STRATA = ({"p": 1, "q": 2}, {"r": 2, "s": 0}, {"t": 3, "u": 1}, {"v": 2, "w": 1})
_ARITY = {**_GIVEN, **{name: n for stratum in _STRATA for name, n in stratum.items()}}
_ATTRIBUTES = ("height", "width")
_VARIABLES = ("?x", "?y", "?z", "?w")


class Draw:
    """Draws programs and facts; one seed, one program."""

    def __init__(self, seed: int) -> None:
        self.random = random.Random(seed)
        # Tests compare numbers only, so a program has either tests or symbols.
        self.numeric = self.random.random() < 0.6
        self.constants = (1, 2, 3, 4) if self.numeric else (1, 2, "a", "b")

    def term(self, likely: list[str]) -> Variable | Constant:
        chance = self.random.random()
        if chance < 0.1:
            return Constant(self.random.choice(self.constants))
        return Variable(self.random.choice(likely if likely and chance < 0.8 else _VARIABLES))

    def atom(self, name: str, likely: list[str]) -> Atom:
        chosen = self.random.sample(_ATTRIBUTES, self.random.randint(0, 2)) if name == "o" else ()
        return Atom(
            name,
            tuple(self.term(likely) for _ in range(_ARITY[name])),
            tuple((attribute, self.term(likely)) for attribute in chosen),
        )

    def clause(self) -> ConceptClause:
        height = self.random.randrange(len(_STRATA))
        head = self.random.choice(sorted(_STRATA[height]))
        below = [*_GIVEN, *(name for stratum in _STRATA[:height] for name in stratum)]
        usable = [*below, *_STRATA[height], *_STRATA[height]]
        count = self.random.randint(1, 3)
        positive = [self.atom(self.random.choice(usable), []) for _ in range(count)]
        bound = sorted({name for atom in positive for name in atom.variables})
        elements = [Condition(atom) for atom in positive]
        for _ in range(self.random.choice((0, 0, 1, 1, 2))):
            denied = Condition(self.atom(self.random.choice(below), bound), negated=True)
            elements.insert(self.random.randint(0, len(elements)), denied)
        args = tuple(
            Variable(self.random.choice(bound))
            if bound and self.random.random() < 0.9
            else Constant(self.random.choice(self.constants))
            for _ in range(_ARITY[head])
        )
        tests = [self.test(bound) for _ in range(self.random.choice((0, 0, 1, 2)))] if bound else []
        return ConceptClause(Atom(head, args), tuple(elements), tuple(tests))

    def test(self, bound: list[str]) -> Call:
        names = ("<", "<=", ">", ">=", "=", "/=") if self.numeric else ("=", "/=")
        sides = (self.expression(bound, 0), self.expression(bound, 0))
        return Call(self.random.choice(names), sides)

    def expression(self, bound: list[str], depth: int) -> Expression:
        chance = self.random.random()
        if self.numeric and chance < 0.3 and depth < 2:
            name = self.random.choice(("+", "-", "*"))
            return Call(
                name, (self.expression(bound, depth + 1), self.expression(bound, depth + 1))
            )
        if chance < 0.45:
            return Constant(self.random.choice(self.constants))
        return Variable(self.random.choice(bound))

    def facts(self) -> list[Belief]:
        found: dict[Belief, None] = {}
        # Concepts may be given as well as derived: an effect of an action is.
        names = [*_GIVEN, *_GIVEN, *_GIVEN, *_GIVEN, "e", "f", *(n for s in _STRATA for n in s)]
        for _ in range(self.random.randint(15, 60)):
            name = self.random.choice(names)
            args = tuple(self.random.choice(self.constants) for _ in range(_ARITY[name]))
            chosen = [a for a in _ATTRIBUTES if name == "o" and self.random.random() < 0.6]
            values = {attribute: self.random.choice(self.constants) for attribute in chosen}
            found.setdefault(Belief(name, args, values))
        return list(found)


def as_clingo(clauses: list[ConceptClause], facts: list[Belief]) -> str:
    """Write a program for clingo; attributes become predicates, a `not` a predicate of its own."""
    lines = []
    for fact in facts:
        lines.append(f"{_literal(fact.predicate, fact.args)}.")
        for name, value in fact.attributes.items():
            lines.append(f"{_literal(f'{fact.predicate}_{name}', (*fact.args, value))}.")
    for number, clause in enumerate(clauses):
        positive = [c.atom for c in clause.elements if not c.negated]
        bound = {name for atom in positive for name in atom.variables}
        body = [_pattern(atom) for atom in positive]
        for place, condition in enumerate(clause.elements):
            if condition.negated:
                shared = [Variable(n) for n in dict.fromkeys(condition.atom.variables)]
                some = _literal(f"some_{number}_{place}", [v for v in shared if v.name in bound])
                lines.append(f"{some} :- {_pattern(condition.atom)}.")
                body.append(f"not {some}")
        body += map(_expression, clause.tests)
        lines.append(f"{_literal(clause.head.predicate, clause.head.args)} :- {', '.join(body)}.")
    return "\n".join(lines)


def _pattern(atom: Atom) -> str:
    parts = [_literal(atom.predicate, atom.args)]
    parts += [_literal(f"{atom.predicate}_{n}", (*atom.args, t)) for n, t in atom.attributes]
    return ", ".join(parts)


def _literal(name: str, args: tuple | list) -> str:
    return f"{name}({', '.join(map(_term, args))})" if args else name


def _term(term: Variable | Constant | str | float) -> str:
    if isinstance(term, Variable):
        return term.name[1:].upper()
    return str(term.value if isinstance(term, Constant) else term)


def _expression(expression: Expression) -> str:
    if not isinstance(expression, Call):
        return _term(expression)
    name = {"/=": "!="}.get(expression.function, expression.function)
    text = f" {name} ".join(map(_expression, expression.args))
    return text if name in ("<", "<=", ">", ">=", "=", "!=") else f"({text})"


def clingo_model(text: str) -> set[str]:
    """Give the atoms that follow by grounding; it is a mistake if that leaves any open."""
    control = clingo.Control(logger=lambda _code, _text: None)
    control.add("base", [], text)
    control.ground([("base", [])])
    atoms = [(atom.symbol, atom.is_fact) for atom in control.symbolic_atoms]
    assert all(is_fact for _, is_fact in atoms)
    return {str(symbol) for symbol, _ in atoms if symbol.name in _ARITY}


def our_model(clauses: list[ConceptClause], facts: list[Belief]) -> set[str]:
    store = FactStore(facts)
    Closure(clauses).derive(store)
    return {
        f"{fact.predicate}({','.join(map(str, fact.args))})" if fact.args else fact.predicate
        for fact in store
    }


@pytest.mark.parametrize("part", range(_PARTS))
def test_our_beliefs_are_those_of_clingo(part: int) -> None:
    derived = 0
    for seed in range(part, _PROGRAMS, _PARTS):
        draw = Draw(seed)
        clauses = [draw.clause() for _ in range(draw.random.randint(4, 14))]
        facts = draw.facts()
        text = as_clingo(clauses, facts)
        ours = our_model(clauses, facts)
        assert ours == clingo_model(text), f"seed {seed}:\n{text}"
        derived += len(ours) - len(facts)
    assert derived > 2 * _PROGRAMS / _PARTS  # the programs are not idle
