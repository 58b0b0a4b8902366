"""CLIPS through clipspy: rules whose conclusions stand as long as their conditions do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable

import clips

from tabletop.oracle import PREDICATES, Facts
from tabletop.scene import Frame, State, Thing, Verb

TEMPLATE = """(deftemplate obj
  (slot id) (slot type) (slot x) (slot y) (slot z) (slot w) (slot d) (slot h))"""

RULES = """
(defrule left-of
  (logical (obj (id ?a) (x ?xa) (w ?wa)) (obj (id ?b&~?a) (x ?xb) (w ?wb))
           (test (<= (+ (* 2 ?xa) ?wa) (- (* 2 ?xb) ?wb))))
  => (assert (left-of ?a ?b)))
(defrule near
  (logical (obj (id ?a) (x ?xa) (y ?ya) (z ?za)) (obj (id ?b&~?a) (x ?xb) (y ?yb) (z ?zb))
           (test (< (+ (* (- ?xa ?xb) (- ?xa ?xb)) (* (- ?ya ?yb) (- ?ya ?yb))
                       (* (- ?za ?zb) (- ?za ?zb))) 90000)))
  => (assert (near ?a ?b)))
(defrule on
  (logical (obj (id ?a) (x ?xa) (y ?ya) (z ?za))
           (obj (id ?b&~?a) (x ?xb) (y ?yb) (z ?zb) (w ?wb) (d ?db) (h ?hb))
           (test (and (<= (abs (- ?za (+ ?zb ?hb))) 5)
                      (< (* 2 (abs (- ?xa ?xb))) ?wb) (< (* 2 (abs (- ?ya ?yb))) ?db)))
           (not (holding ?a)))
  => (assert (on ?a ?b)))
(defrule covered (logical (on ?a ?b)) => (assert (covered ?b)))
(defrule clear (logical (obj (id ?b)) (not (covered ?b))) => (assert (clear ?b)))
(defrule connected (logical (attached ?a ?b)) => (assert (connected ?a ?b)))
(defrule connected-further
  (logical (attached ?a ?b) (connected ?b ?c)) => (assert (connected ?a ?c)))
(defrule linked (logical (connected ?a ?b)) => (assert (linked ?a)))
(defrule reachable
  (logical (base ?rx ?ry ?reach2) (obj (id ?a) (x ?x) (y ?y) (z ?z))
           (test (<= (+ (* (- ?x ?rx) (- ?x ?rx)) (* (- ?y ?ry) (- ?y ?ry)) (* ?z ?z)) ?reach2)))
  => (assert (reachable ?a)))
(defrule graspable
  (logical (clear ?a) (reachable ?a) (not (holding ?a))) => (assert (graspable ?a)))
(defrule adjacent (logical (near ?a ?b) (left-of ?a ?b)) => (assert (adjacent ?a ?b)))
(defrule candidate
  (logical (adjacent ?a ?b) (graspable ?a) (clear ?b)) => (assert (candidate ?a ?b)))
(defrule has-candidate (logical (candidate ?a ?b)) => (assert (has-candidate ?a)))
(defrule loose (logical (has-candidate ?a) (not (linked ?a))) => (assert (loose ?a)))
(defrule assembly
  (logical (loose ?a) (loose ?b) (near ?a ?b) (left-of ?a ?b)
           (obj (id ?a) (type peg)) (obj (id ?b) (type hole)))
  => (assert (assembly ?a ?b)))
"""


class ClipsEngine:
    """A move is a `modify`; an action asserts or retracts a fact.

    Args:
        base: Where the arm stands.
        templates: The templates of the things.
        rules: The rules.
        idle: Whether as many things of the kind `obj-idle` are there as well, and never move.
    """

    def __init__(
        self,
        base: tuple[int, int, int],
        templates: str = TEMPLATE,
        rules: str = RULES,
        *,
        idle: bool = False,
    ) -> None:
        self._facts: dict[object, clips.Fact] = {}
        self._environment = clips.Environment()
        for word, text in (("(deftemplate", templates), ("(defrule", rules)):
            for construct in text.split(word)[1:]:
                self._environment.build(word + construct)
        self._base = base
        self._idle = idle

    def begin(self, state: State) -> None:
        """Assert everything, and let the rules fire."""
        template = self._environment.find_template("obj")
        self._assert("base", *self._base)
        for thing in state.things:
            self._facts[thing.name] = template.assert_fact(**_slots(thing))
        if self._idle:
            template = self._environment.find_template("obj-idle")
            for thing in state.things:
                self._facts["idle", thing.name] = template.assert_fact(**_slots(thing))
        for name in sorted(state.holding):
            self._assert("holding", name)
        for pair in sorted(state.fixed):
            self._assert("attached", *pair)
        self._environment.run()

    def prepare(self, frame: Frame, state: State) -> Callable[[], None]:  # noqa: ARG002 - as `Engine`
        """Give what tells CLIPS of moves and actions."""
        return lambda: self._step(frame)

    def facts(self) -> Facts:
        """Give all derived facts."""
        wanted = frozenset(PREDICATES)
        found = []
        for fact in self._environment.facts():
            name = fact.template.name
            if name in wanted:
                found.append((name, *map(int, fact)))
        return frozenset(found)

    def counts(self) -> dict[str, int]:
        """Give how many facts there are of each relation, named as in our rules."""
        names = (fact.template.name for fact in self._environment.facts())
        renamed = (name.replace("attached", "fixed") for name in names)
        return dict(Counter(n for n in renamed if not n.startswith(("obj", "base"))))

    def _step(self, frame: Frame) -> None:
        facts = self._facts
        for name, x, y, z in frame.moved:
            facts[name].modify_slots(x=x, y=y, z=z)
        for verb, things in frame.actions:
            match verb:
                case Verb.GRASP:
                    self._assert("holding", *things)
                case Verb.RELEASE:
                    facts.pop(("holding", *things)).retract()
                case Verb.ATTACH:
                    if ("attached", *things) not in facts:
                        self._assert("attached", *things)
                case Verb.DETACH:
                    facts.pop(("attached", *things)).retract()
        self._environment.run()

    def _assert(self, name: str, *values: int) -> None:
        text = f"({' '.join([name, *map(str, values)])})"
        self._facts[(name, *values)] = self._environment.assert_string(text)


def _slots(thing: Thing) -> dict[str, int | str]:
    return {
        "id": thing.name, "type": clips.Symbol(thing.type), "x": thing.x, "y": thing.y,
        "z": thing.z, "w": thing.w, "d": thing.d, "h": thing.h,
    }  # fmt: skip
