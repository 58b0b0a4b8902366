"""Ours: `tabletop.icr`, read, checked and compiled like any other domain."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from icarus_lite import Belief, Percept, load_domain
from icarus_lite.inference.network import (
    Changes,
    CompiledDomain,
    Delta,
    Network,
    compile_domain,
)
from tabletop.oracle import PREDICATES, Facts
from tabletop.scene import Frame, State, Thing, Verb

RULES = Path(__file__).parents[2] / "tabletop.icr"
_DERIVED = frozenset(PREDICATES)
_ASSERTED_BY = {Verb.GRASP: "holding", Verb.ATTACH: "fixed"}
_WITHDRAWN_BY = {Verb.RELEASE: "holding", Verb.DETACH: "fixed"}


def compiled_rules() -> CompiledDomain:
    """Read, check and compile the rules."""
    return compile_domain(load_domain(RULES))


class NetworkEngine:
    """Is given the things that have moved.

    Args:
        compiled: The rules.
        base: Where the arm stands.
        count: How many things there are.
        idle: Whether as many things of the type `obj-idle` are there as well, and never move.
    """

    def __init__(
        self,
        compiled: CompiledDomain,
        base: tuple[int, int, int],
        count: int,
        *,
        idle: bool = False,
    ) -> None:
        self.network: Network = compiled.network()
        self.changes: Changes | None = None
        self._base = Percept("base", "arm", dict(zip(("x", "y", "reach2"), base, strict=True)))
        self._names = [f"o{i}" for i in range(count)]
        self._idle = idle

    def begin(self, state: State) -> None:
        """Give the network everything as new."""
        percepts = self.percepts(state)
        if self._idle:
            percepts += [self._percept(thing, "obj-idle") for thing in state.things]
        self.changes = self.network.update(Delta(tuple(percepts), asserted=self._given(state)))

    def percepts(self, state: State) -> list[Percept]:
        """Give all that is perceived, idle things left out."""
        return [self._base, *(self._percept(thing) for thing in state.things)]

    def prepare(self, frame: Frame, state: State) -> Callable[[], None]:  # noqa: ARG002 - as `Engine`
        """Give what tells the network the places of what has moved, and the actions."""
        return lambda: self._step(frame)

    def facts(self) -> Facts:
        """Give all derived facts."""
        return _numbered(each for name in PREDICATES for each in self.network.facts(name))

    def counts(self) -> dict[str, int]:
        """Give how many beliefs there are of each concept."""
        return dict(Counter(belief.predicate for belief in self.network.beliefs()))

    def news(self) -> tuple[Facts, Facts]:
        """Give the derived facts that the last frame has added and removed."""
        assert self.changes is not None
        return _numbered(self.changes.added), _numbered(self.changes.removed)

    def _step(self, frame: Frame) -> None:
        things, x, y, z = zip(*frame.moved, strict=True)
        names = [self._names[thing] for thing in things]
        columns = {"x": x, "y": y, "z": z}
        asserted, withdrawn = self._changes(frame)
        self.changes = self.network.move("obj", names, columns, asserted, withdrawn)

    def _changes(self, frame: Frame) -> tuple[Sequence[Belief], Sequence[Belief]]:
        if not frame.actions:
            return (), ()
        asserted = [self._belief(_ASSERTED_BY, *each) for each in frame.actions]
        withdrawn = [self._belief(_WITHDRAWN_BY, *each) for each in frame.actions]
        return [b for b in asserted if b is not None], [b for b in withdrawn if b is not None]

    def _belief(self, table: dict[Verb, str], verb: Verb, things: tuple[int, ...]) -> Belief | None:
        name = table.get(verb)
        return Belief(name, tuple(self._names[each] for each in things)) if name else None

    def _given(self, state: State) -> tuple[Belief, ...]:
        holding = [Belief("holding", (self._names[each],)) for each in sorted(state.holding)]
        fixed = [Belief("fixed", (self._names[a], self._names[b])) for a, b in sorted(state.fixed)]
        return (*holding, *fixed)

    def _percept(self, thing: Thing, kind: str = "obj") -> Percept:
        given: dict[str, str | int] = {
            "type": thing.type, "x": thing.x, "y": thing.y, "z": thing.z,
            "w": thing.w, "d": thing.d, "h": thing.h,
        }  # fmt: skip
        return Percept(kind, self._names[thing.name], given)


def _numbered(beliefs: Iterable[Belief]) -> Facts:
    """Give derived beliefs with the numbers of the things; what was asserted is left out."""
    return frozenset(
        (each.predicate, *(int(str(arg)[1:]) for arg in each.args))
        for each in beliefs
        if each.predicate in _DERIVED
    )


class SnapshotEngine(NetworkEngine):
    """Is given all percepts and all assertions in each frame, and finds the difference itself."""

    def prepare(self, frame: Frame, state: State) -> Callable[[], None]:  # noqa: ARG002 - as `Engine`
        """Give what hands over a whole picture; making the picture is the camera's business."""
        percepts = self.percepts(state)
        asserted = self._given(state)

        def step() -> None:
            self.changes = self.network.update_snapshot(percepts, asserted)

        return step
