"""Rules followed together find what each would find from scratch, whichever way they go."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Sequence

import pytest

from icarus_lite import Belief, Percept
from icarus_lite.errors import InferenceError
from icarus_lite.inference.network import CompiledDomain, Delta, Network, compile_domain
from icarus_lite.inference.network.kernels import PairGroup
from icarus_lite.inference.network.kernels.costs import GroupCosts
from icarus_lite.language import parse_domain

RULES = """
((left-of ?a ?b) :elements ((box ?a ^x ?xa ^w ?wa) (box ?b ^x ?xb ^w ?wb))
  :tests ((/= ?a ?b) (<= (+ (* 2 ?xa) ?wa) (- (* 2 ?xb) ?wb))))
((above ?a ?b) :elements ((box ?a ^z ?za) (box ?b ^z ?zb)) :tests ((> ?za ?zb)))
((near ?a ?b) :elements ((box ?a ^x ?xa ^y ?ya) (box ?b ^x ?xb ^y ?yb))
  :tests ((/= ?a ?b) (< (distance ?xa ?ya ?xb ?yb) 30)))
((close ?a ?b) :elements ((box ?a ^x ?xa ^y ?ya ^z ?za) (box ?b ^x ?xb ^y ?yb ^z ?zb))
  :tests ((< (+ (* (- ?xa ?xb) (- ?xa ?xb)) (* (- ?ya ?yb) (- ?ya ?yb))
                (* (- ?za ?zb) (- ?za ?zb))) 700)))
((on ?a ?b) :elements ((box ?a ^x ?xa ^y ?ya ^z ?za) (box ?b ^x ?xb ^y ?yb ^z ?zb ^w ?wb ^h ?hb))
  :tests ((/= ?a ?b) (<= (abs (- ?za (+ ?zb ?hb))) 5)
          (< (* 2 (abs (- ?xa ?xb))) ?wb) (< (* 2 (abs (- ?ya ?yb))) ?wb)))
((steep ?a ?b) :elements ((box ?a ^y ?ya ^z ?za) (box ?b ^y ?yb ^z ?zb))
  :tests ((/= ?ya ?yb) (> (/ (- ?za ?zb) (- ?ya ?yb)) 3)))
((in-reach ?a ?arm) :elements ((box ?a ^x ?x ^y ?y) (arm ?arm ^x ?rx ^y ?ry ^reach ?r))
  :tests ((<= (distance ?x ?y ?rx ?ry) ?r)))
((serves ?arm ?a) :elements ((arm ?arm ^x ?rx) (box ?a ^x ?x ^w ?w))
  :tests ((< (abs (- ?x ?rx)) ?w)))
((free ?a) :elements ((box ?a) (not (on ?any ?a))))
((pair ?a ?b) :elements ((near ?a ?b) (left-of ?a ?b) (free ?b) (not (held ?a))))
((crowd ?a) :elements ((pair ?a ?b) (close ?b ?c) (not (above ?a ?c))))
"""
CONCEPTS = (
    *("left-of", "above", "near", "close", "on", "steep", "in-reach", "serves", "free", "pair"),
    *("crowd", "held"),
)
WAYS = ("few", "flat", "near", "whole", "alone", None)


@pytest.fixture(scope="module")
def compiled() -> CompiledDomain:
    domain, problems = parse_domain(
        f"(percepts (box ^x ^y ^z ^w ^h) (arm ^x ^y ^reach)) (concepts {RULES})"
    )
    assert not problems
    return compile_domain(domain)


class World:
    """Boxes and arms that come, go, move, and are sometimes odd."""

    def __init__(self, size: int, seed: int, *, whole_numbers: bool, odd: bool = True) -> None:
        self.rng = random.Random(seed)
        self.odd = odd
        self.whole_numbers = whole_numbers
        self.width = 30 * size**0.5
        self.boxes = {f"b{n}": self.box() for n in range(size)}
        self.arms = {f"a{n}": self.arm() for n in range(2)}
        self.held: set[str] = set()
        self.next = size

    def number(self, most: float) -> float:
        return self.rng.randint(0, int(most)) if self.whole_numbers else self.rng.uniform(0, most)

    def box(self) -> dict[str, float | str]:
        places = {name: self.number(self.width) for name in "xy"}
        sizes = {name: self.number(40) for name in "wh"}
        return {**places, "z": self.number(60), **sizes}

    def arm(self) -> dict[str, float | str]:
        places = {name: self.number(self.width) for name in "xy"}
        return {**places, "reach": self.number(60) * self.rng.choice([1, 1e9])}

    def step(self) -> list[tuple[list[str], dict[str, list], Delta]]:
        """Change something; give the moves, and what else is new."""
        names = list(self.boxes)
        kind = self.rng.random()
        count = len(names) if kind < 0.3 else self.rng.choice([1, 2, 3, len(names) // 2 or 1])
        moved = self.rng.sample(names, min(count, len(names)))
        if kind < 0.3:
            moved.sort(key=names.index)
        attributes = self.rng.choice([("x", "y", "z"), ("x", "y", "z"), ("x",), ("z", "w")])
        far = self.rng.random() < 0.2
        for name in moved:
            for attribute in attributes:
                step = self.number(self.width) if far else self.number(8) - 4
                self.boxes[name][attribute] = max(0, self.boxes[name][attribute] * (not far) + step)
        columns = {a: [self.boxes[name][a] for name in moved] for a in attributes}
        return moved, columns, self.others()

    def others(self) -> Delta:
        chance = self.rng.random()
        new, gone = [], []
        if chance < 0.08:
            self.boxes[f"b{self.next}"] = self.box()
            new = [f"b{self.next}"]
            self.next += 1
        elif chance < 0.14 and len(self.boxes) > 2:
            gone = [self.rng.choice(list(self.boxes))]
            del self.boxes[gone[0]]
        elif chance < 0.18 and self.odd:
            odd = self.rng.choice(list(self.boxes))
            self.boxes[odd]["w"] = self.rng.choice([2.0**21, 2**60, 33])
            new = [odd]
        percepts = [Percept("box", name, dict(self.boxes[name])) for name in new]
        if 0.2 < chance < 0.24:
            self.arms["a0"] = self.arm()
            percepts.append(Percept("arm", "a0", self.arms["a0"]))
        asserted = withdrawn = ()
        if chance > 0.9:
            name = self.rng.choice(list(self.boxes))
            belief = Belief("held", (name,))
            if name in self.held:
                withdrawn = (belief,)
            else:
                asserted = (belief,)
            self.held ^= {name}
        return Delta(tuple(percepts), tuple(("box", name) for name in gone), asserted, withdrawn)

    def everything(self) -> Delta:
        percepts = [Percept("box", name, dict(each)) for name, each in self.boxes.items()]
        percepts += [Percept("arm", name, dict(each)) for name, each in self.arms.items()]
        held = tuple(Belief("held", (name,)) for name in sorted(self.held))
        return Delta(tuple(percepts), asserted=held)


def fresh(compiled: CompiledDomain, world: World) -> Network:
    network = compiled.network()
    network.update(world.everything())
    return network


def held(network: Network) -> set[Belief]:
    return {belief for name in CONCEPTS for belief in network.facts(name)}


def watch(monkeypatch: pytest.MonkeyPatch, way: str | None) -> Counter[str]:
    """Count how rules were followed, and let them go one way where it can be gone."""
    went: Counter[str] = Counter()
    choose, follow = GroupCosts.choose, PairGroup.follow

    def choosing(self: GroupCosts, moved: int, size: int, *, arrays: bool) -> str:
        return choose(self, moved, size, arrays=arrays) if way is None else way

    def following(self: PairGroup, slots: Sequence[int], attributes: tuple[str, ...]) -> object:
        found = follow(self, slots, attributes)
        went["together" if found is not None else "alone"] += 1
        return found

    monkeypatch.setattr(GroupCosts, "choose", choosing)
    monkeypatch.setattr(PairGroup, "follow", following)
    return went


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("size", [3, 12, 60])
@pytest.mark.parametrize("whole_numbers", [True, False])
def test_each_cycle_is_what_a_fresh_network_says(
    compiled: CompiledDomain,
    monkeypatch: pytest.MonkeyPatch,
    way: str | None,
    size: int,
    *,
    whole_numbers: bool,
) -> None:
    went = watch(monkeypatch, way)
    world = World(size, size, whole_numbers=whole_numbers)
    network = fresh(compiled, world)
    before = held(network)
    for cycle in range(8 if size > 50 else 40):
        moved, columns, rest = world.step()
        changes = network.move("box", moved, columns, rest.asserted, rest.withdrawn)
        if rest.percepts or rest.gone:
            before = held(network)
            changes = network.update(Delta(rest.percepts, rest.gone))
        now = held(network)
        assert now == held(fresh(compiled, world)), cycle
        assert set(changes.added) == now - before
        assert set(changes.removed) == before - now
        before = now
    assert went["together"] > 5 or way == "alone"
    assert way != "alone" or not went["together"]


def test_whole_snapshots_are_followed_together_as_well(
    compiled: CompiledDomain, monkeypatch: pytest.MonkeyPatch
) -> None:
    went = watch(monkeypatch, None)
    world = World(20, 7, whole_numbers=False, odd=False)
    network = fresh(compiled, world)
    for _ in range(40):
        world.step()
        everything = world.everything()
        network.update_snapshot(everything.percepts, everything.asserted)
        assert held(network) == held(fresh(compiled, world))
    assert went["together"] > 20


def test_what_cannot_be_evaluated_is_an_error_and_changes_nothing(
    compiled: CompiledDomain,
) -> None:
    world = World(10, 3, whole_numbers=True)
    network = fresh(compiled, world)
    names = list(world.boxes)
    network.move("box", names[:2], {"x": [1, 2]})
    before = network.beliefs()
    with pytest.raises(InferenceError, match="number"):
        network.move("box", names[:1], {"z": ["high"]})
    assert network.beliefs() == before
    network.move("box", names[:2], {"x": [3, 4]})
    world.boxes[names[0]]["x"], world.boxes[names[1]]["x"] = 3, 4
    assert network.beliefs() == fresh(compiled, world).beliefs()


def test_the_code_can_be_read(compiled: CompiledDomain) -> None:
    of_boxes, of_arms = sorted(
        (group.source.text for group in compiled.form(frozenset()).groups),
        key=lambda text: "# Pair rules that see objects of type arm:" in text,
    )
    assert of_boxes in compiled.pair_source
    assert of_arms in compiled.pair_source
    assert "#   near_pairs: (< (distance ?xa ?ya ?xb ?yb) 30)" in of_boxes
    assert "# on_pairs, the mover on the right" in of_boxes
    for function in ("follow(slots, keys)", "whole(", "near_pairs(left, right, "):
        assert f"def {function}" in of_boxes


def test_a_limit_that_grows_widens_the_search(compiled: CompiledDomain) -> None:
    """How far `on` may reach depends on the widest box, which may grow by a move."""
    network = compiled.network()
    flat = {"x": 0, "y": 0, "z": 0, "w": 10, "h": 10}
    boxes = [Percept("box", "below", flat), Percept("box", "other", {**flat, "x": 300})]
    network.update(Delta((*boxes, Percept("box", "top", {**flat, "x": 100, "z": 10}))))
    network.move("box", ["top"], {"x": [90], "y": [0], "z": [10]})
    assert not network.holds(Belief("on", ("top", "below")))
    network.move("box", ["below"], {"w": [250]})
    assert network.holds(Belief("on", ("top", "below")))
    network.move("box", ["top"], {"x": [124], "y": [0], "z": [10]})
    assert network.holds(Belief("on", ("top", "below")))
    network.move("box", ["top"], {"x": [126], "y": [0], "z": [10]})
    assert not network.holds(Belief("on", ("top", "below")))


def test_few_of_many_are_followed_by_their_ranked_places(
    compiled: CompiledDomain, monkeypatch: pytest.MonkeyPatch
) -> None:
    went = watch(monkeypatch, "few")
    world = World(120, 5, whole_numbers=True, odd=False)
    network = fresh(compiled, world)
    for cycle in range(12):
        names = world.rng.sample(list(world.boxes), 3)
        places = {each: [world.number(world.width) for _ in names] for each in "xyz"}
        for each, values in places.items():
            for name, value in zip(names, values, strict=True):
                world.boxes[name][each] = value
        network.move("box", names, places)
        assert held(network) == held(fresh(compiled, world)), cycle
    assert went["together"] == 12


def test_a_bound_beyond_all_numbers_is_none() -> None:
    domain, problems = parse_domain(
        "(percepts (box ^x)) (concepts ((faint ?a ?b)"
        " :elements ((box ?a ^x ?xa) (box ?b ^x ?xb))"
        " :tests ((/= ?a ?b) (< (* 1e-320 (abs (- ?xa ?xb))) 1))))"
    )
    assert not problems
    network = compile_domain(domain).network()
    network.update(Delta(tuple(Percept("box", name, {"x": 0}) for name in "abc")))
    network.move("box", ["a"], {"x": [2**19]})
    assert len(set(network.facts("faint"))) == 6
