"""A network at work: the stores of one network, and the generated functions over them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import count
from typing import TYPE_CHECKING, Any

from icarus_lite.inference.closure import Closure, Limits
from icarus_lite.inference.expressions import compile_bind, compile_test
from icarus_lite.inference.network.attributed import ASSERTED, Attributes, Telling
from icarus_lite.inference.network.contents import Contents
from icarus_lite.inference.network.design import Keeping
from icarus_lite.inference.network.history import Event, Kind, belief_of, key_of
from icarus_lite.inference.network.parts import Functions, Known, Move, Parts, Show
from icarus_lite.inference.network.recomputed import Recomputed
from icarus_lite.inference.network.relations import Facts, Pairs
from icarus_lite.inference.network.scene import Scene, Turn
from icarus_lite.inference.network.watch import Watch
from icarus_lite.symbols import Belief, Value

if TYPE_CHECKING:
    from icarus_lite.inference.network.compiled import Compiled

_Settling = tuple[Callable[[], None], Callable[[], None]]
"""What settles a concept in each cycle, and what loads it."""


class Running(Contents):
    """The stores of one network and the functions that keep them up to date.

    It knows what is effectively there: one set of attributes for each object and each given fact.
    Where these come from, and taking back what goes wrong, is its owner's business.

    Args:
        compiled: What runs.
        watch: Watches over the budget.

    Attributes:
        functions: The generated functions.
    """

    def __init__(self, compiled: Compiled, watch: Watch) -> None:
        super().__init__(compiled.design)
        self.compiled = compiled
        self._events: list[tuple[Any, Sequence[Any], Sequence[Any], Sequence[Any]]] = []
        self._scene = Scene(compiled.design, compiled.module, compiled.groups)
        self.objects = self._scene.objects
        self.parts = self._parts(watch)
        self.functions: Functions = compiled.module.connect(self.parts)
        self._cycle: Callable[[], None] = self.functions["cycle"]
        self._scene.connect(compiled.design, compiled.module, self.functions, self.parts.rows)
        self._tellings = self._given_tellings()
        self._kinds = list(self.heads)

    # -- making --------------------------------------------------------------------------------

    def _parts(self, watch: Watch) -> Parts:
        design, tables = self.compiled.design, self._scene.tables
        evaluator = design.vocabulary.evaluator
        asked = {
            name: (compile_bind if name.startswith("bind_") else compile_test)(
                expression,
                {variable: place for place, variable in enumerate(order)},
                evaluator.functions,
                evaluator.path,
            )
            for name, (expression, order) in self.compiled.module.wiring.asked.items()
        }
        return Parts(
            rows={r.name: {} for r in design.relations if not isinstance(r, Pairs)},
            pairs=self._scene.pairs,
            names={type_: table.objects.columns.names for type_, table in tables.items()},
            columns={
                (type_, attribute): column
                for type_, table in tables.items()
                for attribute, column in table.lists.items()
            },
            asked=asked,
            record=self._events.append,
            stale={head.component: False for head in design.heads},
            stage=count(),
            tick=watch.tick,
            too_many=watch.too_many,
            most=watch.budget.facts,
            attributed=self._attributed,
            recomputed=self._recomputed,
        )

    def _attributed(
        self,
        number: int,
        changes: dict[Any, int],
        fill: Callable[[], None],
        tellings: Sequence[tuple[Any, ...]],
    ) -> _Settling:
        """Make what keeps a concept with attributes; the generated module asks for it."""
        names = {
            body.number: tuple(name for name, _ in body.clause.head.attributes)
            for body in self.compiled.design.heads[number].bodies
        }
        made = Attributes(
            number, names, changes, fill, [Telling(*each) for each in tellings], self._events.append
        )
        self.attributes[number] = made
        return made.settle, made.load

    def _recomputed(
        self, component: int, tellings: Sequence[Sequence[tuple[Any, ...]]]
    ) -> _Settling:
        """Make what keeps a component from scratch; the generated module asks for it."""
        design = self.compiled.design
        heads = [head for head in design.heads if head.component == component]
        bodies = sorted((b for head in heads for b in head.bodies), key=lambda b: b.number)
        clauses = [body.clause for body in bodies]
        own = {head.facts.predicate for head in heads}
        lower = dict.fromkeys(
            (c.atom.predicate, len(c.atom.args))
            for clause in clauses
            for c in clause.elements
            if c.atom.predicate not in own
        )

        def given() -> Iterator[Belief]:
            for kind, facts in self.given.items():
                if kind[0] in own:
                    for key, ranked in facts.items():
                        yield belief_of(kind, key, ranked[min(ranked)])
            for kind in lower:
                yield from self.facts(kind)

        def is_asserted(fact: Belief) -> bool:
            known = self.given.get((fact.predicate, len(fact.args)), {})
            return ASSERTED in known.get(key_of(fact.args), {})

        parts = self.parts
        made = Recomputed(
            [(head.number, (head.facts.predicate, head.facts.arity)) for head in heads],
            Closure(clauses, design.vocabulary.evaluator),
            Limits(
                parts.most,
                lambda clause: parts.tick(bodies[clause].number),
                lambda clause: parts.too_many(bodies[clause].number),
            ),
            given,
            is_asserted,
            [[Telling(*each) for each in of_head] for of_head in tellings],
            self._events.append,
        )
        self.recomputed[component] = made

        def settle() -> None:
            self.parts.stale[component] = False
            made.settle()

        return settle, made.load

    def _given_tellings(self) -> dict[Kind, list[Telling]]:
        """Give the relations of facts that are only ever given."""
        found: dict[Kind, list[Telling]] = {}
        for relation in self.compiled.design.relations:
            if not isinstance(relation, Facts):
                continue
            kind, name = (relation.predicate, relation.arity), relation.name
            if kind not in self.heads:
                telling = Telling(
                    relation.cells,
                    self.parts.rows[name],
                    self.functions[f"show_{name}"],
                    self.functions[f"withdraw_{name}"],
                    self.functions[f"insert_{name}"],
                )
                found.setdefault(kind, []).append(telling)
        return found

    # -- loading -------------------------------------------------------------------------------

    def load(
        self,
        objects: Iterable[tuple[str, Value, Mapping[str, Value]]],
        given: Iterable[tuple[Kind, Any, int, Mapping[str, Value]]],
    ) -> None:
        """Take in everything at once, into a network that believes nothing.

        Args:
            objects: The objects of every type: type, name and attributes.
            given: The facts that are given: kind, key, rank and attributes.

        Raises:
            InferenceError: a test cannot be evaluated, or the budget is spent.
        """
        self._scene.load(objects)
        for kind, key, rank, attributes in given:
            self.given.setdefault(kind, {}).setdefault(key, {})[rank] = attributes
            self._count(kind, key, rank, attributes, 1)
        for kind, tellings in self._tellings.items():
            for key, ranked in self.given.get(kind, {}).items():
                for telling in tellings:
                    value = telling.value(ranked[min(ranked)])
                    if value is not None:
                        telling.rows[key] = value
        for name, function in self.functions.items():
            if name.startswith("index_"):
                function()
        self._scene.load_pairs(self._check_size)
        self.functions["load"]()
        self._events.clear()

    def follow_alone(self) -> None:
        """Let pair rules follow each by itself from now on, so that they can be told apart."""
        self._scene.follow_alone()

    def _check_size(self, size: int, clause: int) -> None:
        if size > self.parts.most:
            self.parts.too_many(clause)

    def _count(
        self, kind: Kind, key: Any, rank: int, attributes: Mapping[str, Value], by: int
    ) -> None:
        """Count what is given of a concept with attributes among its derivations."""
        head = self.heads.get(kind)
        if head is not None and head.keeping is Keeping.ATTRIBUTED:
            changes: Any = self.functions[f"{head.facts.name}_changes"]
            candidate = key, (rank, tuple(sorted(attributes.items())))
            changes[candidate] = changes.get(candidate, 0) + by

    # -- following -----------------------------------------------------------------------------

    def update(
        self,
        objects: Sequence[tuple[str, Value, Known]],
        given: Sequence[tuple[Kind, Any, int, Known]],
        moves: Sequence[Move] = (),
    ) -> list[Event]:
        """Follow what is effectively there; give what changed in the beliefs of concepts.

        Args:
            objects: The objects that may have changed: type, name, and attributes, None if gone.
            given: Likewise the facts that are given: kind, key, rank and attributes.
            moves: Objects of which only some attributes have changed.

        Raises:
            InferenceError: a test cannot be evaluated, or the budget is spent.
        """
        turn, scene, events = Turn(), self._scene, self._events
        for move in moves:
            scene.move(move, turn)
        if objects:
            scene.change(objects, turn)
        for each in given:
            self._give(*each, turn.shows)
        scene.follow(turn, events.append, self._check_size)
        self._cycle()
        scene.settle()
        if not events:
            return []
        kinds = self._kinds
        found: list[Event] = [(kinds[n], gained, lost, x) for n, gained, lost, x in events]
        events.clear()
        return found

    def _give(self, kind: Kind, key: Any, rank: int, attributes: Known, shows: list[Show]) -> None:
        """Follow a fact that is given, or no longer; withdraw its row, or note it to be shown."""
        known = self.given.setdefault(kind, {})
        ranked = known.setdefault(key, {})
        own, old = ranked.get(rank), ranked[min(ranked)] if ranked else None
        if attributes is not None:
            ranked[rank] = attributes
        else:
            ranked.pop(rank, None)
        now = ranked[min(ranked)] if ranked else None
        if not ranked:
            del known[key]
        head = self.heads.get(kind)
        if head is None:
            for telling in self._tellings.get(kind, ()):
                _replace(telling, key, old, now, shows)
        elif head.keeping is Keeping.RECOMPUTED:
            self.parts.stale[head.component] = True
        else:
            for state, by in ((own, -1), (attributes, 1)):
                if state is not None:
                    self._count(kind, key, rank, state, by)


def _replace(telling: Telling, key: Any, old: Known, now: Known, shows: list[Show]) -> None:
    before = None if old is None else telling.value(old)
    after = None if now is None else telling.value(now)
    if before == after:
        return
    if before is not None:
        telling.withdraw(key, before)
    if after is not None:
        shows.append((telling.show, key, after))
