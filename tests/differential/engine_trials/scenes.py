"""Random domains of the kind a scene asks for: relations between objects, flags, and chains.

Several rules over pairs of objects read the same columns, as "near", "left of" and "on" do; flags
are true of single objects; chains are conjunctions of both, with negation, and rest on chains.
All of it can be followed in bulk, by other means than fact by fact.
"""

from __future__ import annotations

import random

from engine_trials.vocabulary import ASSERTED, PERCEPTS, Flavour, Kind, Layer, Signature, Vocabulary
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Expression,
    Term,
    Variable,
)

_S = Kind.SYMBOL
_A, _B = Variable("?a"), Variable("?b")
_LAYERS = (
    (Signature("near-by", (_S, _S)), Signature("left", (_S, _S)), Signature("on", (_S, _S))),
    (Signature("covered", (_S,)), Signature("low", (_S,)), Signature("load", (_S,))),
    (Signature("beside", (_S, _S)), Signature("class", (_S,)), Signature("clear", (_S,))),
    (Signature("fits", (_S, _S)), Signature("loose", (_S,)), Signature("w", (_S, _S))),
)
_COMPARISONS = ("<", "<=", ">", ">=")
_SELECTIVE_FROM = 20
"""From so many objects on, relations are drawn that few pairs meet."""

_FAR = Signature("t-1", (_S, _S))

LAYERS = (
    *(Layer(predicates, recursive=False) for predicates in _LAYERS),
    Layer((_FAR,), recursive=True),
)
"""What the concepts of a scene are called: relations, flags, two layers of chains, a closure."""


def scene_vocabulary(draw: random.Random) -> Vocabulary:
    """Draw the words of a scene of 2 to 60 objects, few mostly."""
    count = draw.randint(*draw.choice(((2, 6), (5, 15), (10, 24), (20, 60))))
    numbers = range(1, 9) if count < 8 else range(0, 7 * count, 7)
    symbols = tuple(f"o{i}" for i in range(count))
    return Vocabulary(
        PERCEPTS,
        ASSERTED,
        LAYERS,
        typed=True,
        symbols=symbols,
        numbers=tuple(numbers),
        flavour=Flavour.SCENE,
    )


class SceneDraw:
    """Draws the clauses of a domain about a scene.

    Args:
        draw: Where chance comes from.
        vocabulary: Its layers are those of a scene.
    """

    def __init__(self, draw: random.Random, vocabulary: Vocabulary) -> None:
        self._draw = draw
        self._words = vocabulary
        self._large = len(vocabulary.symbols) >= _SELECTIVE_FROM
        self._kinds = draw.choice(
            (("obj", "obj"), ("obj", "obj"), ("obj", "part"), ("obj", "spot"))
        )

    def clauses(self) -> tuple[ConceptClause, ...]:
        """Draw all clauses, in no order of layers."""
        draw = self._draw
        found = [self._relation() for _ in range(draw.randint(2, 5))]
        found += [self._flag() for _ in range(draw.randint(1, 4))]
        found += [self._chain(2) for _ in range(draw.randint(1, 3))]
        found += [self._chain(3) for _ in range(draw.randint(0, 3))]
        if not self._large and draw.random() < 0.3:
            found += self._recursion()
        draw.shuffle(found)
        return tuple(found)

    # -- relations -----------------------------------------------------------------------------

    def _relation(self) -> ConceptClause:
        """Draw a rule over two objects and the arithmetic between them."""
        draw = self._draw
        chosen = []
        for kind in self._kinds:
            numbers = self._numbers(kind)
            chosen.append(draw.sample(numbers, draw.randint(1, min(2, len(numbers)))))
        patterns = [
            Atom(kind, (term,), tuple((n, Variable(f"{term}-{n}")) for n in names))
            for kind, term, names in zip(self._kinds, (_A, _B), chosen, strict=True)
        ]
        tests: list[Call] = [Call("/=", (_A, _B))] if draw.random() < 0.7 else []
        tests += [self._between(*chosen) for _ in range(draw.choice((1, 1, 2, 3)))]
        elements = [Condition(atom) for atom in patterns]
        if draw.random() < 0.3:
            elements.append(Condition(Atom("f", (draw.choice((_A, _B)),)), negated=True))
        args = (_B, _A) if draw.random() < 0.15 else (_A, _B)
        return ConceptClause(Atom(self._head(0, 2).name, args), tuple(elements), tuple(tests))

    def _numbers(self, kind: str) -> list[str]:
        attributes = self._words.signatures[kind].attributes
        return [name for name, its in attributes if its is Kind.NUMBER]

    def _between(self, left: list[str], right: list[str]) -> Call:
        draw = self._draw
        a, b = Variable(f"?a-{draw.choice(left)}"), Variable(f"?b-{draw.choice(right)}")
        gap: Expression = Call("-", (a, b))
        limit = self._limit()
        shape = draw.randrange(5)
        if shape == 0:
            return Call(draw.choice(_COMPARISONS[:2]), (Call("abs", (gap,)), limit))
        if shape == 1:
            other: Expression = Call("-", (Variable(f"?a-{left[-1]}"), Variable(f"?b-{right[-1]}")))
            squares = Call("+", (Call("*", (gap, gap)), Call("*", (other, other))))
            return Call(draw.choice(_COMPARISONS[:2]), (squares, Call("*", (limit, limit))))
        if shape == 2:
            top = Call("+", (b, Variable(f"?b-{right[-1]}")))
            return Call("<=", (Call("abs", (Call("-", (a, top)),)), limit))
        if shape == 3:
            doubled = Call("*", (Constant(2), Call("abs", (gap,))))
            return Call("<", (doubled, limit if self._large else b))
        return Call(draw.choice(_COMPARISONS), (Call("+", (a, limit)), b))

    def _limit(self) -> Constant:
        numbers = self._words.numbers
        return Constant(self._draw.choice(numbers[:4] if self._large else numbers))

    # -- flags ---------------------------------------------------------------------------------

    def _flag(self) -> ConceptClause:
        """Draw a rule about one object: what it measures, what is related to it, what is not."""
        draw = self._draw
        head = Atom(self._head(1, 1).name, (_A,))
        thing = Condition(Atom("obj", (_A,)))
        shape = draw.randrange(4)
        if shape == 0:
            name = draw.choice(self._numbers("obj"))
            value = Variable("?n")
            test = Call(
                draw.choice(_COMPARISONS), (value, Constant(draw.choice(self._words.numbers)))
            )
            return ConceptClause(head, (Condition(Atom("obj", (_A,), ((name, value),))),), (test,))
        related = self._pattern(self._head(0, 2), draw.choice(((_A, _B), (_B, _A))))
        if shape == 1:
            return ConceptClause(head, (Condition(related),))
        if shape == 2:
            return ConceptClause(head, (thing, Condition(related, negated=True)))
        given = Condition(Atom("f", (_A,)), negated=draw.random() < 0.5)
        return ConceptClause(head, (thing, given))

    # -- chains --------------------------------------------------------------------------------

    def _chain(self, height: int) -> ConceptClause:
        """Draw a conjunction of relations and flags of lower layers."""
        draw = self._draw
        pairs = [s for layer in _LAYERS[:height] for s in layer if len(s.args) == 2]
        flags = [s for layer in _LAYERS[1:height] for s in layer if len(s.args) == 1]
        elements = [Condition(self._pattern(draw.choice(pairs), (_A, _B)))]
        for _ in range(draw.randint(0, 2)):
            args = draw.choice(((_A, _B), (_A, _B), (_B, _A)))
            denied = draw.random() < 0.25
            elements.append(Condition(self._pattern(draw.choice(pairs), args), negated=denied))
        for _ in range(draw.randint(0, 3)):
            denied = draw.random() < 0.35
            term: Term = draw.choice((_A, _B))
            elements.append(Condition(Atom(draw.choice(flags).name, (term,)), negated=denied))
        if draw.random() < 0.4:
            word = Constant(draw.choice(self._words.symbols))
            elements.append(Condition(Atom("obj", (draw.choice((_A, _B)),), (("class", word),))))
        if draw.random() < 0.2:
            denied = Condition(
                self._pattern(draw.choice(pairs), (_A, Variable("?any"))), negated=True
            )
            elements.append(denied)
        draw.shuffle(elements)
        head = draw.choice(_LAYERS[height])
        args = draw.choice(((_A, _B), (_A, _B), (_B, _A))) if len(head.args) == 2 else (_A,)
        tests = (Call("/=", (_A, _B)),) if draw.random() < 0.15 else ()
        return ConceptClause(Atom(head.name, args), tuple(elements), tests)

    def _recursion(self) -> list[ConceptClause]:
        """Draw a relation that is passed on."""
        step = self._pattern(self._head(0, 2), (_A, _B))
        far, rest = (self._pattern(_FAR, (each, Variable("?c"))) for each in (_A, _B))
        return [
            ConceptClause(self._pattern(_FAR, (_A, _B)), (Condition(step),)),
            ConceptClause(far, (Condition(step), Condition(rest))),
        ]

    def _head(self, height: int, arity: int) -> Signature:
        return self._draw.choice([s for s in _LAYERS[height] if len(s.args) == arity])

    def _pattern(self, each: Signature, args: tuple[Term, ...]) -> Atom:
        return Atom(each.name, args)
