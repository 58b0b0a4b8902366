"""How long inference from scratch takes, as the scene grows.

    python benchmarks/engine_scaling.py

Three scenes: a tower of n blocks with the recursive `above`; the shipped gearbox domain with ten
parts; and "table-top beliefs", n objects in 3-D with fourteen derived predicates in three strata,
`left-of` over all pairs among them. Every set of beliefs on the table top is compared with a
computation that shares nothing with the engine. Times are processor time in ms: the least and the
median of several runs.
"""

from __future__ import annotations

import argparse
import math
import platform
import random
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import permutations
from pathlib import Path

from icarus_lite import Belief, Percept
from icarus_lite.inference import (
    Closure,
    FactStore,
    InferenceEngine,
    Memory,
    percept_fact,
)
from icarus_lite.language import parse_domain

GEARBOX = Path(__file__).parents[1] / "domains" / "gearbox.icr"
TOWER = """(concepts
  ((above ?a ?b) :elements ((on ?a ?b)))
  ((above ?a ?c) :elements ((on ?a ?b) (above ?b ?c))))"""

TABLE_TOP = """
(percepts (obj ^type ^x ^y ^z ^w ^d ^h) (base ^x ^y ^reach2))
(concepts
  ((left-of ?a ?b)
   :elements ((obj ?a ^x ?xa ^w ?wa) (obj ?b ^x ?xb ^w ?wb))
   :tests ((/= ?a ?b) (<= (+ (* 2 ?xa) ?wa) (- (* 2 ?xb) ?wb))))
  ((near ?a ?b)
   :elements ((obj ?a ^x ?xa ^y ?ya ^z ?za) (obj ?b ^x ?xb ^y ?yb ^z ?zb))
   :tests ((/= ?a ?b) (< (+ (* (- ?xa ?xb) (- ?xa ?xb)) (* (- ?ya ?yb) (- ?ya ?yb))
                            (* (- ?za ?zb) (- ?za ?zb))) 90000)))
  ((on ?a ?b)
   :elements ((obj ?a ^x ?xa ^y ?ya ^z ?za) (obj ?b ^x ?xb ^y ?yb ^z ?zb ^w ?wb ^d ?db ^h ?hb)
              (not (holding ?a)))
   :tests ((/= ?a ?b) (<= (abs (- ?za (+ ?zb ?hb))) 5)
           (< (* 2 (abs (- ?xa ?xb))) ?wb) (< (* 2 (abs (- ?ya ?yb))) ?db)))
  ((covered ?b) :elements ((on ?a ?b)))
  ((clear ?b) :elements ((obj ?b) (not (covered ?b))))
  ((connected ?a ?b) :elements ((attached ?a ?b)))
  ((connected ?a ?c) :elements ((attached ?a ?b) (connected ?b ?c)))
  ((linked ?a) :elements ((connected ?a ?b)))
  ((reachable ?a)
   :elements ((obj ?a ^x ?x ^y ?y ^z ?z) (base ?_ ^x ?rx ^y ?ry ^reach2 ?reach2))
   :tests ((<= (+ (* (- ?x ?rx) (- ?x ?rx)) (* (- ?y ?ry) (- ?y ?ry)) (* ?z ?z)) ?reach2)))
  ((graspable ?a) :elements ((obj ?a) (clear ?a) (reachable ?a) (not (holding ?a))))
  ((adjacent ?a ?b) :elements ((left-of ?a ?b) (near ?a ?b)))
  ((candidate ?a ?b) :elements ((adjacent ?a ?b) (graspable ?a) (clear ?b)))
  ((has-candidate ?a) :elements ((candidate ?a ?b)))
  ((loose ?a) :elements ((has-candidate ?a) (not (linked ?a))))
  ((assembly ?a ?b)
   :elements ((loose ?a) (loose ?b) (near ?a ?b) (left-of ?a ?b)
              (obj ?a ^type peg) (obj ?b ^type hole))))
"""


@dataclass(frozen=True, slots=True)
class Thing:
    """An object on the table: centre x, y and bottom z, sizes w, d, h, all in whole mm."""

    name: int
    type: str
    x: int
    y: int
    z: int
    w: int
    d: int
    h: int


@dataclass(frozen=True, slots=True)
class Scene:
    """A table top: the objects, which of them is held, what is fixed to what, the arm's base."""

    things: tuple[Thing, ...]
    held: frozenset[int]
    attached: frozenset[tuple[int, int]]
    base: tuple[int, int, int]

    def facts(self) -> list[Belief]:
        """Give the scene as percepts and asserted beliefs."""
        x, y, reach2 = self.base
        facts = [percept_fact(Percept("base", "robot", {"x": x, "y": y, "reach2": reach2}))]
        for thing in self.things:
            given = {name: getattr(thing, name) for name in ("type", "x", "y", "z", "w", "d", "h")}
            facts.append(Belief("obj", (thing.name,), given))
        facts += [Belief("holding", (name,)) for name in sorted(self.held)]
        return facts + [Belief("attached", pair) for pair in sorted(self.attached)]


def table_top(count: int, seed: int = 1) -> Scene:
    """Draw a scene: sixteen objects a square metre, three in ten stacked, towers up to three."""
    draw = random.Random(seed)  # noqa: S311 - a benchmark, not a secret
    side = round(250 * math.sqrt(count))
    things: list[Thing] = []
    floor: dict[int, int] = {}
    for name in range(count):
        w, d, h = (draw.randrange(40, 81) for _ in range(3))
        x, y, z = draw.randrange(side), draw.randrange(side), 0
        tops = [t for t in things if floor[t.name] < 2 and not _bears(t, things)]
        if tops and draw.random() < 0.3:
            below = draw.choice(tops)
            x, y, z = below.x, below.y, below.z + below.h
            floor[name] = floor[below.name] + 1
        floor.setdefault(name, 0)
        things.append(Thing(name, ("peg", "hole", "block", "box")[name % 4], x, y, z, w, d, h))
    attached = set()
    for _ in range(count // 5):
        one, other = sorted(draw.sample(range(count), 2))
        attached.add((one, other))
    reach2 = round((0.4 * side) ** 2)
    held = frozenset({draw.randrange(count)})
    return Scene(tuple(things), held, frozenset(attached), (side // 2, side // 2, reach2))


def _bears(below: Thing, things: Sequence[Thing]) -> bool:
    return any(
        (t.x, t.y, t.z) == (below.x, below.y, below.z + below.h) and t is not below for t in things
    )


def expected(scene: Scene) -> set[str]:
    """Compute all beliefs of a table top by set comprehensions."""
    things = {t.name: t for t in scene.things}
    pairs = list(permutations(scene.things, 2))
    rx, ry, reach2 = scene.base
    left = {(a.name, b.name) for a, b in pairs if 2 * a.x + a.w <= 2 * b.x - b.w}
    near = {
        (a.name, b.name)
        for a, b in pairs
        if (a.x - b.x) ** 2 + (a.y - b.y) ** 2 + (a.z - b.z) ** 2 < 300 * 300
    }
    on = {
        (a.name, b.name)
        for a, b in pairs
        if abs(a.z - b.z - b.h) <= 5
        and 2 * abs(a.x - b.x) < b.w
        and 2 * abs(a.y - b.y) < b.d
        and a.name not in scene.held
    }
    covered = {b for _, b in on}
    clear = set(things) - covered
    connected = set(scene.attached)
    while True:
        longer = {(a, c) for a, b in scene.attached for other, c in connected if other == b}
        if longer <= connected:
            break
        connected |= longer
    linked = {a for a, _ in connected}
    reachable = {
        t.name
        for t in scene.things
        if (t.x - rx) ** 2 + (t.y - ry) ** 2 + t.z**2 <= reach2
    }  # fmt: skip
    graspable = (clear & reachable) - scene.held
    adjacent = left & near
    candidate = {(a, b) for a, b in adjacent if a in graspable and b in clear}
    has = {a for a, _ in candidate}
    loose = has - linked
    assembly = {
        (a, b)
        for a, b in adjacent
        if a in loose and b in loose and things[a].type == "peg" and things[b].type == "hole"
    }
    unary = {
        "covered": covered, "clear": clear, "linked": linked, "reachable": reachable,
        "graspable": graspable, "has-candidate": has, "loose": loose,
    }  # fmt: skip
    binary = {
        "left-of": left, "near": near, "on": on, "connected": connected,
        "adjacent": adjacent, "candidate": candidate, "assembly": assembly,
    }  # fmt: skip
    return {f"({name} {a})" for name, row in unary.items() for a in row} | {
        f"({name} {a} {b})" for name, row in binary.items() for a, b in row
    }


def closure(text: str) -> Closure:
    """Compile the concepts of a text."""
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    return Closure(domain.concepts)


def tower(height: int) -> Callable[[], int]:
    """Give the work of inferring a tower from scratch; it gives the number of beliefs."""
    compiled = closure(TOWER)
    facts = [Belief("on", (f"b{i}", f"b{i + 1}")) for i in range(height - 1)]
    return lambda: len(compiled.derive(FactStore(facts)))


def gearbox() -> Callable[[], int]:
    """Give the work of a first cycle of the gearbox domain with a hand and ten parts."""
    domain, problems = parse_domain(GEARBOX.read_text(encoding="utf-8"), str(GEARBOX))
    assert domain is not None, problems
    engine = InferenceEngine(domain)
    kinds = ("case", "hubcover", "plug", "input", "output", "bearing")
    hand = {"x": 0.0, "y": 0.0, "z": 0.3, "reach": 0.85, "gripping": "no"}
    percepts = [Percept("hand", "hand1", hand)]
    for i in range(10):
        place = {"x": 0.3 + 0.02 * i, "y": 0.1 * (i % 3), "z": 0.01, "width": 0.05, "height": 0.05}
        seen = "yes" if i % 4 else "no"
        given = {"type": kinds[i % 6], **place, "seen": seen, "status": "visible"}
        percepts.append(Percept("object", f"o{i}", given))
    return lambda: len(engine.step(Memory(), percepts).state.supports)


def beliefs_of(count: int) -> Callable[[], int]:
    """Give the work of inferring a table top from scratch, checked once.

    Raises:
        AssertionError: the engine is wrong.
    """
    compiled, scene = closure(TABLE_TOP), table_top(count)
    facts = scene.facts()
    found = {str(belief) for belief in compiled.derive(FactStore(facts))}
    assert found == expected(scene), found ^ expected(scene)
    return lambda: len(compiled.derive(FactStore(facts)))


def measured(name: str, work: Callable[[], int], repeats: int) -> str:
    """Time some work and write a row of the table."""
    times, beliefs = [], 0
    for _ in range(repeats):
        begin = time.process_time()
        beliefs = work()
        times.append(1000 * (time.process_time() - begin))
    return f"| {name} | {beliefs} | {min(times):.2f} | {statistics.median(times):.2f} |"


def report(repeats: int, counts: Sequence[int]) -> str:
    """Measure everything and write it as a table."""
    rows = [measured(f"tower of {n}", tower(n), repeats) for n in (10, 20, 40)]
    rows.append(measured("gearbox, ten parts", gearbox(), repeats))
    rows += [measured(f"table top, {n} objects", beliefs_of(n), repeats) for n in counts]
    head = f"Processor time in ms, {repeats} runs, Python {platform.python_version()}."
    table = ["| scene | beliefs | least | median |", "|---|---|---|---|", *rows]
    return "\n".join([head, "", *table, ""])


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description="How inference from scratch grows.")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--objects", type=int, nargs="*", default=[15, 50])
    options = parser.parse_args()
    print(report(options.repeats, options.objects))


if __name__ == "__main__":
    main()
