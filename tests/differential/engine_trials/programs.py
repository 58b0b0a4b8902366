"""Random stratified domains with all that makes inference hard.

Recursion alone, in pairs and through attributes of other concepts; negation with local variables;
several strata; arithmetic tests, also nested in `and`, `or` and `not`; `:binds`, for arguments and
for attributes; percept types and a subtype; constants; variables repeated inside a pattern;
clauses without a body; pairs of percepts related by arithmetic.
"""

from __future__ import annotations

import random

from engine_trials.vocabulary import Flavour, Kind, Layer, Signature, Vocabulary
from icarus_lite.language.syntax import (
    Atom,
    Bind,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Expression,
    Term,
    Variable,
)

_NAMES = {
    Kind.SYMBOL: ("a", "load", "class", "b-1"),
    Kind.NUMBER: ("i", "len", "row", "k-1"),
    Kind.ANY: ("x", "self", "is", "x-1"),
}
_COMPARISONS = ("<", "<=", ">", ">=", "=", "/=")


class ProgramDraw:
    """Draws the clauses of a domain.

    Args:
        draw: Where chance comes from.
        vocabulary: The predicates to use.
    """

    def __init__(self, draw: random.Random, vocabulary: Vocabulary) -> None:
        self._draw = draw
        self._words = vocabulary
        self._most = 3

    def clauses(self) -> tuple[ConceptClause, ...]:
        """Draw all clauses: in no order of strata, as a person would write them."""
        if self._words.flavour is Flavour.MASS:
            return tuple(self._pair() for _ in range(self._draw.randint(1, 3)))
        crowd = self._words.flavour is Flavour.CROWD
        self._most = 2 if crowd else 3  # three patterns over a crowd could make a million rows
        found = [self._clause() for _ in range(self._draw.randint(2, 5 if crowd else 14))]
        if crowd:
            found += [self._pair() for _ in range(self._draw.randint(1, 4))]
        elif self._words.typed:
            found += [self._pair() for _ in range(self._draw.choice((0, 0, 1, 1, 2)))]
        self._draw.shuffle(found)
        return tuple(found)

    def _clause(self) -> ConceptClause:
        """Draw a clause over anything at or below its head's layer."""
        height = self._draw.randrange(len(self._words.layers))
        layer = self._words.layers[height]
        head = self._draw.choice(layer.predicates)
        below = self._below(height)
        usable = [*below, *(layer.predicates * 2 if layer.recursive else ())]
        count = min(self._most, self._draw.choice((0, 1, 1, 1, 2, 2, 2, 3, 3)))
        positive = [self._pattern(self._draw.choice(usable), (), layer=layer) for _ in range(count)]
        return self._completed(head, positive, below, layer)

    def _pair(self) -> ConceptClause:
        """Draw a clause over two percepts and the arithmetic between them."""
        height = self._draw.randrange(len(self._words.layers))
        layer = self._words.layers[height]
        head = self._draw.choice(layer.predicates)
        patterns, sides = [], []
        for name, letter in (("a", "i"), ("b", "j")):
            percept = self._draw.choice(self._words.percepts)
            numbers = [each for each, kind in percept.attributes if kind is Kind.NUMBER]
            chosen = self._draw.sample(numbers, self._draw.randint(1, len(numbers)))
            attributes: list[tuple[str, Term]] = [
                (each, Variable(f"?{letter}{each}")) for each in chosen
            ]
            if self._draw.random() < 0.15:
                symbol = next(each for each, kind in percept.attributes if kind is Kind.SYMBOL)
                attributes.append((symbol, Constant(self._draw.choice(self._words.symbols))))
            patterns.append(Atom(percept.name, (Variable(f"?{name}"),), tuple(attributes)))
            sides.append([f"?{letter}{each}" for each in chosen])
        tests = [self._relation(*sides) for _ in range(self._draw.randint(1, 2))]
        if self._draw.random() < 0.6:
            tests.insert(0, Call("/=", (Variable("?a"), Variable("?b"))))
        below = self._below(height)
        further = 0 if self._words.flavour is Flavour.MASS else self._draw.choice((0, 0, 1))
        more = [self._pattern(self._draw.choice(below), ()) for _ in range(further)]
        return self._completed(head, [*patterns, *more], below, layer, tuple(tests))

    def _relation(self, left: list[str], right: list[str]) -> Call:
        a, b = Variable(self._draw.choice(left)), Variable(self._draw.choice(right))
        gap: Expression = Call("-", (a, b))
        limit = Constant(self._draw.choice(self._words.numbers))
        shape = self._draw.randrange(5)
        if shape == 0:
            return Call(self._draw.choice(_COMPARISONS[:4]), (Call("abs", (gap,)), limit))
        if shape == 1:
            other: Expression = Call("-", (Variable(left[-1]), Variable(right[-1])))
            squares = Call("+", (Call("*", (gap, gap)), Call("*", (other, other))))
            return Call(self._draw.choice(("<", "<=")), (squares, Call("*", (limit, limit))))
        if shape == 2:
            doubled = Call("*", (Constant(2), Call("abs", (gap,))))
            return Call("<", (doubled, Variable(self._draw.choice(right))))
        if shape == 3:
            one = Call("+", (Call("*", (Constant(2), a)), Variable(left[-1])))
            other = Call("-", (Call("*", (Constant(2), b)), Variable(right[-1])))
            return Call(self._draw.choice(_COMPARISONS), (one, other))
        return Call(self._draw.choice(_COMPARISONS), (a, b))

    def _below(self, height: int) -> list[Signature]:
        """Give what a `not` in this layer may speak of; given facts count more than the rest."""
        given = [*self._words.percepts, *self._words.asserted]
        lower = [each for layer in self._words.layers[:height] for each in layer.predicates]
        return [*given, *lower, *lower]

    def _completed(
        self,
        head: Signature,
        positive: list[Atom],
        below: list[Signature],
        layer: Layer,
        tests: tuple[Call, ...] = (),
    ) -> ConceptClause:
        """Add negations, tests, binds and the head to positive conditions."""
        bound = _bound(positive, self._words)
        elements = [Condition(atom) for atom in positive]
        for _ in range(self._draw.choice((0, 0, 1, 1, 2))):
            denied = Condition(self._pattern(self._draw.choice(below), bound), negated=True)
            elements.insert(self._draw.randint(0, len(elements)), denied)
        more = [self._test(bound, 0) for _ in range(self._draw.choice((0, 0, 1, 2)))]
        binds: list[Bind] = []
        may_compute = self._words.typed and not layer.recursive
        args = tuple(self._value(k, bound, binds, compute=may_compute) for k in head.args)
        attributes = [
            (name, self._value(kind, bound, binds, compute=self._words.typed))
            for name, kind in head.attributes
        ]
        self._draw.shuffle(attributes)
        every = (*tests, *(test for test in more if test is not None))
        atom = Atom(head.name, args, tuple(attributes))
        return ConceptClause(atom, tuple(elements), every, tuple(binds))

    def _pattern(
        self, each: Signature, bound: tuple[tuple[str, Kind], ...], layer: Layer | None = None
    ) -> Atom:
        """Draw a pattern; attributes of the layer's own concepts are read in deep domains only."""
        args = tuple(self._term(kind, bound) for kind in each.args)
        attributes: list[tuple[str, Term]] = []
        deep = self._words.flavour is Flavour.DEEP
        if deep or layer is None or each not in layer.predicates:
            most = min(2, len(each.attributes))
            chosen = self._draw.sample(each.attributes, self._draw.randint(0, most))
            attributes = [(name, self._term(kind, bound)) for name, kind in chosen]
        return Atom(each.name, args, tuple(attributes))

    def _term(self, kind: Kind, bound: tuple[tuple[str, Kind], ...]) -> Term:
        chance = self._draw.random()
        if chance < 0.1:
            return Constant(self._constant(kind))
        likely = [name for name, other in bound if other is kind]
        if likely and chance < 0.8:
            return Variable(self._draw.choice(likely))
        return Variable(f"?{self._draw.choice(_NAMES[kind])}")

    def _constant(self, kind: Kind) -> str | int:
        if kind is Kind.ANY:
            kind = self._draw.choice((Kind.SYMBOL, Kind.NUMBER))
        values = self._words.symbols if kind is Kind.SYMBOL else self._words.numbers
        return self._draw.choice(values)

    def _value(
        self,
        kind: Kind,
        bound: tuple[tuple[str, Kind], ...],
        binds: list[Bind],
        *,
        compute: bool,
    ) -> Term:
        """Draw what stands in a place of the head."""
        likely = [name for name, other in bound if other is kind]
        if not likely or self._draw.random() < 0.1:
            return Constant(self._constant(kind))
        if compute and kind is Kind.NUMBER and self._draw.random() < 0.3:
            variable = Variable(f"?c{len(binds)}")
            binds.append(Bind(variable, self._computed(likely)))
            return variable
        return Variable(self._draw.choice(likely))

    def _computed(self, numbers: list[str]) -> Expression:
        """Draw what `:binds` computes; small, as clingo's numbers have 32 bits."""
        a, b = (Variable(self._draw.choice(numbers)) for _ in range(2))
        shape = self._draw.randrange(4)
        if shape == 0:
            return Call("+", (a, Constant(self._draw.choice((1, 2, -3)))))
        if shape == 1:
            return Call("abs", (Call("-", (a, b)),))
        return Call(("min", "max")[shape - 2], (a, b))

    def _test(self, bound: tuple[tuple[str, Kind], ...], depth: int) -> Call | None:
        if not bound:
            return None
        if depth < 2 and self._draw.random() < 0.15:
            name = self._draw.choice(("and", "or", "not"))
            parts = [self._test(bound, depth + 1) for _ in range(1 if name == "not" else 2)]
            return Call(name, tuple(part for part in parts if part is not None))
        numbers = [name for name, kind in bound if kind is Kind.NUMBER]
        if numbers and self._draw.random() < 0.8:
            count = self._draw.choice((2, 2, 2, 3))
            sides = tuple(self._arithmetic(numbers, 0) for _ in range(count))
            return Call(self._draw.choice(_COMPARISONS), sides)
        name, kind = self._draw.choice(bound)
        same = [other for other, its in bound if its is kind]
        other: Term = Variable(self._draw.choice(same))
        if self._draw.random() < 0.3:
            other = Constant(self._constant(kind))
        return Call(self._draw.choice(("=", "/=")), (Variable(name), other))

    def _arithmetic(self, numbers: list[str], depth: int) -> Expression:
        chance = self._draw.random()
        if chance < 0.35 and depth < 2:
            name = self._draw.choice(("+", "-", "*", "abs", "min", "max"))
            if name == "*":  # of two variables at most, so that no value leaves 32 bits
                return Call(name, (self._arithmetic(numbers, 2), self._arithmetic(numbers, 2)))
            count = 1 if name == "abs" else 2
            return Call(name, tuple(self._arithmetic(numbers, depth + 1) for _ in range(count)))
        if chance < 0.5:
            return Constant(self._draw.choice(self._words.numbers))
        return Variable(self._draw.choice(numbers))


def _bound(positive: list[Atom], words: Vocabulary) -> tuple[tuple[str, Kind], ...]:
    """Give the variables of patterns with their kinds, in order of occurrence."""
    found: dict[str, Kind] = {}
    for atom in positive:
        signature = words.signatures[atom.predicate]
        kinds = dict(signature.attributes)
        places = [*zip(atom.args, signature.args, strict=True)]
        places += [(term, kinds[name]) for name, term in atom.attributes]
        for term, kind in places:
            if isinstance(term, Variable):
                found.setdefault(term.name, kind)
    return tuple(found.items())
