"""Random histories: what is perceived and asserted, changing from cycle to cycle."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from engine_trials.vocabulary import SUPERTYPE, Flavour, Kind, Signature, Vocabulary
from icarus_lite import Belief, Percept
from icarus_lite.inference.network import Delta
from icarus_lite.symbols import Value


@dataclass(frozen=True, slots=True)
class Change:
    """What is different in a cycle.

    Args:
        percepts: Percepts that are new, or have other attributes than before.
        gone: Type and name of percepts that are there no longer.
        asserted: Beliefs that are asserted from now on.
        withdrawn: Beliefs that are asserted no longer.
    """

    percepts: tuple[Percept, ...] = ()
    gone: tuple[tuple[str, str], ...] = ()
    asserted: tuple[Belief, ...] = ()
    withdrawn: tuple[Belief, ...] = ()


@dataclass(frozen=True, slots=True)
class World:
    """What is perceived and asserted in a cycle, in the order in which it came to be."""

    percepts: tuple[Percept, ...] = ()
    asserted: tuple[Belief, ...] = ()

    def after(self, change: Change) -> World:
        """Give the world after a change."""
        percepts = {(each.type, each.name): each for each in self.percepts}
        for key in change.gone:
            percepts.pop(key, None)
        for percept in change.percepts:
            percepts[percept.type, percept.name] = percept
        asserted = {each: each for each in self.asserted}
        for belief in change.withdrawn:
            asserted.pop(belief, None)
        for belief in change.asserted:
            asserted.pop(belief, None)
            asserted[belief] = belief
        return World(tuple(percepts.values()), tuple(asserted.values()))


def worlds(history: Iterable[Change]) -> list[World]:
    """Give the world of each cycle of a history."""
    found, world = [], World()
    for change in history:
        world = world.after(change)
        found.append(world)
    return found


def as_delta(change: Change) -> Delta:
    """Give a change as a network is told it."""
    return Delta(change.percepts, change.gone, change.asserted, change.withdrawn)


def as_columns(
    change: Change, before: World
) -> tuple[str, list[str], dict[str, list[Value]]] | None:
    """Give a change as columns of values, if it only gives values to objects already there."""
    known = {(each.type, each.name): each.attributes for each in before.percepts}
    kinds = {each.type for each in change.percepts}
    keys = {tuple(sorted(each.attributes)) for each in change.percepts}
    if change.gone or len(kinds) != 1 or len(keys) != 1:
        return None
    for each in change.percepts:
        if not known.get((each.type, each.name), {"": 0}).keys() <= each.attributes.keys():
            return None
    names = [each.name for each in change.percepts]
    columns = {key: [each.attributes[key] for each in change.percepts] for key in keys.pop()}
    return kinds.pop(), names, columns


def changed_columns(
    kind: str, names: Sequence[str], columns: Mapping[str, list[Value]], before: World
) -> dict[str, list[Value]]:
    """Leave out the columns in which no value is new."""
    known = {each.name: each.attributes for each in before.percepts if each.type == kind}
    return {
        attribute: values
        for attribute, values in columns.items()
        if any(known[n].get(attribute) != v for n, v in zip(names, values, strict=True))
    }


def draw_history(draw: random.Random, vocabulary: Vocabulary, cycles: int) -> tuple[Change, ...]:
    """Draw a history: a first cycle with much in it, then changes, small ones mostly."""
    drawing = _HistoryDraw(draw, vocabulary)
    history = [drawing.beginning()]
    world = World().after(history[0])
    while len(history) < cycles:
        history.append(drawing.change(world))
        world = world.after(history[-1])
    return tuple(history)


class _HistoryDraw:
    def __init__(self, draw: random.Random, vocabulary: Vocabulary) -> None:
        self._draw = draw
        self._words = vocabulary
        derived = [each for layer in vocabulary.layers for each in layer.predicates]
        # Concepts may be given as well as derived: what a person tells the agent is.
        self._assertable = [*vocabulary.asserted * 4, *derived]

    def beginning(self) -> Change:
        percepts = []
        for name in self._words.symbols:
            if self._draw.random() < 0.85:
                percepts.append(self._percept(self._draw.choice(("obj", "obj", "part")), name))
            if self._draw.random() < 0.3:
                percepts.append(self._percept("spot", name))
        count = self._draw.randint(5, 25)
        asserted = dict.fromkeys(self._belief() for _ in range(count))
        return Change(tuple(percepts), asserted=tuple(asserted))

    def change(self, world: World) -> Change:
        if self._words.flavour is Flavour.SCENE and self._draw.random() < 0.75:
            return self._movement(world)
        share = self._draw.choice((0.1, 0.1, 0.3, 1.0))
        percepts: dict[tuple[str, str], Percept] = {}
        gone: list[tuple[str, str]] = []
        for old in world.percepts:
            if self._draw.random() >= share:
                continue
            fate = self._draw.random()
            if fate < 0.15:
                gone.append((old.type, old.name))
            elif fate < 0.22 and old.type in ("obj", "part"):  # it turns out to be the other
                gone.append((old.type, old.name))
                new = self._percept("part" if old.type == "obj" else "obj", old.name)
                percepts[new.type, new.name] = new
            else:
                percepts[old.type, old.name] = self._moved(old)
        there = {(SUPERTYPE.get(each.type, each.type), each.name) for each in world.percepts}
        for name in self._words.symbols:
            for kind in ("obj", "spot"):
                if (kind, name) not in there and self._draw.random() < 0.15:
                    new = self._percept(
                        self._draw.choice(("obj", "part")) if kind == "obj" else kind, name
                    )
                    percepts[new.type, new.name] = new
        most = self._draw.choice((0, 0, 1, 2, 5))
        withdrawn = [each for each in world.asserted if self._draw.random() < 0.08 * most]
        asserted = dict.fromkeys(self._belief() for _ in range(self._draw.randint(0, most)))
        fresh = [each for each in asserted if each not in withdrawn]
        return Change(tuple(percepts.values()), tuple(gone), tuple(fresh), tuple(withdrawn))

    def _movement(self, world: World) -> Change:
        """Move some objects of one type, or all of them, as what carries them would."""
        kind = self._draw.choice(("obj", "obj", "obj", "part", "spot"))
        there = [each for each in world.percepts if each.type == kind]
        share = self._draw.choice((0.1, 0.1, 0.4, 1.0, 1.0))
        moved = [each for each in there if self._draw.random() < share]
        numbers = [n for n, its in self._words.signatures[kind].attributes if its is Kind.NUMBER]
        names = self._draw.sample(numbers, self._draw.randint(1, len(numbers)))
        found = []
        for old in moved:
            new = {name: self._value(Kind.NUMBER) for name in names}
            found.append(Percept(old.type, old.name, {**old.attributes, **new}))
        asserted = [self._belief()] if self._draw.random() < 0.3 else []
        going = [each for each in world.asserted if self._draw.random() < 0.03]
        withdrawn = [each for each in going if each not in asserted]
        return Change(tuple(found), asserted=tuple(asserted), withdrawn=tuple(withdrawn))

    def _percept(self, kind: str, name: str) -> Percept:
        signature = self._words.signatures[kind]
        likely = 1.0 if self._words.flavour is Flavour.SCENE else 0.85
        given = {
            each: self._value(its)
            for each, its in signature.attributes
            if self._draw.random() < likely
        }
        return Percept(kind, name, given)

    def _moved(self, old: Percept) -> Percept:
        """Give a percept with one attribute or more changed, gained or lost."""
        if self._draw.random() < 0.1:
            return self._percept(old.type, old.name)
        given = dict(old.attributes)
        kinds = self._words.signatures[old.type].attributes
        for name, kind in self._draw.sample(kinds, self._draw.randint(1, 2)):
            given[name] = self._value(kind)
        return Percept(old.type, old.name, given)

    def _belief(self) -> Belief:
        signature: Signature = self._draw.choice(self._assertable)
        args = tuple(self._value(kind) for kind in signature.args)
        attributes = {name: self._value(kind) for name, kind in signature.attributes}
        return Belief(signature.name, args, attributes)

    def _value(self, kind: Kind) -> Value:
        if kind is Kind.ANY:
            kind = self._draw.choice((Kind.SYMBOL, Kind.NUMBER))
        return self._draw.choice(
            self._words.symbols if kind is Kind.SYMBOL else self._words.numbers
        )
