"""The words that random domains are made of: predicates, with the kind of each of their places.

Places are of two kinds, symbols and numbers, so that a test never compares what cannot be
compared; in a domain `of symbols` all places take both, and tests say no more than equal or not.
The names are such as a compiler of domains might trip over: `load`, `class`, `near-by`, `near_by`.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum


class Kind(StrEnum):
    """What may stand in a place."""

    SYMBOL = "s"
    NUMBER = "n"
    ANY = "x"


class Flavour(StrEnum):
    """What is special about a random domain.

    A crowd has many objects and many numbers; a mass has so many that the rules over pairs of
    them, which are all it has, are followed by other means than in a small scene. A scene has
    several such rules over the same columns, and concepts that rest on them. In a plain
    domain no concept has attributes. In a deep one recursive concepts have some, and may read them
    while they recur; in all others they have none: which round of inference a belief first follows
    in decides then which values it has, and clingo knows no rounds.
    """

    USUAL = "usual"
    CROWD = "crowd"
    MASS = "mass"
    SCENE = "scene"
    PLAIN = "plain"
    DEEP = "deep"


@dataclass(frozen=True, slots=True)
class Signature:
    """A predicate: the kinds of its arguments, and of its attributes by name."""

    name: str
    args: tuple[Kind, ...]
    attributes: tuple[tuple[str, Kind], ...] = ()


@dataclass(frozen=True, slots=True)
class Layer:
    """Derived predicates that may depend on one another, if `recursive`, and on lower layers."""

    predicates: tuple[Signature, ...]
    recursive: bool


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """All predicates of a random domain.

    Args:
        percepts: The percept types; `part` is an `obj`.
        asserted: What only actions assert.
        layers: What concepts define, lowest first.
        typed: Whether symbols and numbers have places of their own.
        symbols: The symbols that occur, the names of percepts among them.
        numbers: The numbers that occur in facts.
        flavour: What is special about the domain.
    """

    percepts: tuple[Signature, ...]
    asserted: tuple[Signature, ...]
    layers: tuple[Layer, ...]
    typed: bool
    symbols: tuple[str, ...]
    numbers: tuple[int, ...]
    flavour: Flavour = Flavour.USUAL

    @property
    def signatures(self) -> Mapping[str, Signature]:
        """All predicates by name."""
        derived = (each for layer in self.layers for each in layer.predicates)
        return {each.name: each for each in (*self.percepts, *self.asserted, *derived)}


SUPERTYPE = {"part": "obj"}
"""The percept types that are special cases of others."""

_S, _N = Kind.SYMBOL, Kind.NUMBER
_OBJ = (("class", _S), ("h", _N), ("len", _N), ("is-on", _S))
PERCEPTS = (
    Signature("obj", (_S,), _OBJ),
    Signature("part", (_S,), (*_OBJ, ("grip", _N))),
    Signature("spot", (_S,), (("h", _N), ("at", _S))),
)
ASSERTED = (
    Signature("e", (_S, _S)),
    Signature("f", (_S,)),
    Signature("index", (_S, _N, _S)),
    Signature("k", (_N,)),
    Signature("None", ()),
)
_LAYERS = (("p", "load", "near-by"), ("near_by", "class"), ("len", "u", "t-1"), ("rows", "w"))


def draw_vocabulary(draw: random.Random, flavour: Flavour = Flavour.USUAL) -> Vocabulary:
    """Draw the derived predicates, and whether places are typed."""
    crowd = flavour in (Flavour.CROWD, Flavour.MASS)
    typed = crowd or draw.random() < 0.75
    layers = []
    for names in _LAYERS:
        recursive = draw.random() < 0.6
        plain = flavour is Flavour.PLAIN or (recursive and flavour is not Flavour.DEEP)
        derived = tuple(_derived(draw, name, 0 if plain else 2) for name in names)
        layers.append(Layer(derived, recursive))
    count = draw.randint(16, 30) if crowd else draw.randint(3, 5)
    if flavour is Flavour.MASS:
        count = draw.randint(70, 130)
    symbols = tuple(f"o{i}" for i in range(count)) if crowd else tuple("abcde"[:count])
    numbers = tuple(range(0, 200, 7)) if crowd else tuple(range(1, draw.randint(4, 6)))
    found = Vocabulary(PERCEPTS, ASSERTED, tuple(layers), typed, symbols, numbers, flavour)
    return found if typed else _untyped(found)


def _derived(draw: random.Random, name: str, most: int) -> Signature:
    """Draw the signature of a concept with so many attributes at most."""
    kinds = (Kind.SYMBOL, Kind.SYMBOL, Kind.NUMBER)
    args = tuple(draw.choice(kinds) for _ in range(draw.choice((0, 1, 1, 2, 2, 2, 3))))
    chosen = sorted(draw.sample(("n", "m"), min(most, draw.choice((0, 0, 1, 1, 2)))))
    return Signature(name, args, tuple((each, draw.choice(kinds)) for each in chosen))


def _untyped(vocabulary: Vocabulary) -> Vocabulary:
    def loose(each: Signature) -> Signature:
        return Signature(
            each.name,
            tuple(Kind.ANY for _ in each.args),
            tuple((name, Kind.ANY) for name, _ in each.attributes),
        )

    return replace(
        vocabulary,
        percepts=tuple(map(loose, vocabulary.percepts)),
        asserted=tuple(map(loose, vocabulary.asserted)),
        layers=tuple(
            Layer(tuple(map(loose, layer.predicates)), layer.recursive)
            for layer in vocabulary.layers
        ),
    )
