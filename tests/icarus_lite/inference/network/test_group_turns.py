"""Pair rules followed together: all objects at once, then a few, in turn."""

from __future__ import annotations

import random

import pytest

from icarus_lite import Percept
from icarus_lite.inference.network import CompiledDomain, Delta, compile_domain
from icarus_lite.language import parse_domain

TEXT = """
(percepts (obj ^x ^h) (spot ^x ^h))
(concepts
  ((on ?a ?b)
   :elements ((obj ?a ^x ?xa) (obj ?b ^x ?xb ^h ?hb))
   :tests ((/= ?a ?b) (<= (abs (- ?xa (+ ?xb ?hb))) 4)))
  ((near ?a ?b)
   :elements ((obj ?a ^x ?xa ^h ?ha) (obj ?b ^x ?xb ^h ?hb))
   :tests ((/= ?a ?b) (< (+ (* (- ?xa ?xb) (- ?xa ?xb)) (* (- ?ha ?hb) (- ?ha ?hb))) 900)))
  ((left-of ?a ?b)
   :elements ((obj ?a ^x ?xa ^h ?ha) (obj ?b ^x ?xb))
   :tests ((/= ?a ?b) (<= (+ (* 2 ?xa) ?ha) (* 2 ?xb))))
  ((over ?a ?s)
   :elements ((obj ?a ^x ?xa ^h ?ha) (spot ?s ^x ?xs ^h ?hs))
   :tests ((<= (abs (- (+ ?xa ?ha) (+ ?xs ?hs))) 9)))
  ((beside ?a ?b) :elements ((near ?a ?b) (left-of ?a ?b) (not (on ?a ?b)))))
"""


@pytest.fixture(scope="module")
def compiled() -> CompiledDomain:
    domain, problems = parse_domain(TEXT)
    assert domain is not None, problems
    return compile_domain(domain)


def percepts(there: dict[tuple[str, str], dict[str, int]]) -> tuple[Percept, ...]:
    return tuple(Percept(type_, name, values) for (type_, name), values in there.items())


@pytest.mark.parametrize("count", [5, 50, 130])
@pytest.mark.parametrize("seed", range(2))
def test_whatever_turn_many_and_few_movers_take(
    compiled: CompiledDomain, count: int, seed: int
) -> None:
    draw = random.Random(seed)
    names = {"obj": [f"o{i}" for i in range(count)], "spot": [f"s{i}" for i in range(count // 3)]}
    there = {
        (type_, name): {"x": draw.randrange(0, 400, 7), "h": draw.randrange(0, 60)}
        for type_, every in names.items()
        for name in every
    }
    net = compiled.network()
    net.update(Delta(percepts(there)))
    for _ in range(16):
        type_ = draw.choice(("obj", "obj", "spot"))
        every = names[type_]
        movers = draw.sample(every, draw.choice((1, 1, max(1, len(every) // 4), len(every))))
        attributes = draw.choice((["x"], ["h"], ["x", "h"], ["x", "h"]))
        for name in movers:
            there[type_, name] |= {each: draw.randrange(0, 400, 7) for each in attributes}
        columns = {each: [there[type_, name][each] for name in movers] for each in attributes}
        net.move(type_, movers, columns)
        fresh = compiled.network()
        fresh.update(Delta(percepts(there)))
        assert net.beliefs() == fresh.beliefs()


def test_a_rule_that_is_symmetric_across_two_attributes() -> None:
    domain, problems = parse_domain("""
        (percepts (obj ^w ^h))
        (concepts
          ((swaps ?a ?b)
           :elements ((obj ?a ^w ?wa ^h ?ha) (obj ?b ^w ?wb ^h ?hb))
           :tests ((/= ?a ?b)
                   (<= (+ (* (- ?ha ?wb) (- ?ha ?wb)) (* (- ?wa ?hb) (- ?wa ?hb))) 441))))""")
    assert domain is not None, problems
    draw = random.Random(5)
    for count in (3, 20, 60, 150):
        sizes = {f"o{i}": (draw.randrange(0, 400, 7), draw.randrange(400)) for i in range(count)}
        net = compile_domain(domain).network()
        net.update(Delta(tuple(Percept("obj", n, {"w": w, "h": h}) for n, (w, h) in sizes.items())))
        assert {each.args for each in net.beliefs()} == {
            (a, b)
            for a, (wa, ha) in sizes.items()
            for b, (wb, hb) in sizes.items()
            if a != b and (ha - wb) ** 2 + (wa - hb) ** 2 <= 441
        }


def test_derived_columns_of_many_partners_are_read_up_to_date() -> None:
    domain, _ = parse_domain("""(percepts (obj ^h) (spot ^h))
(concepts ((on ?a ?b) :elements ((obj ?a ^h ?ah) (spot ?b ^h ?bh))
           :tests ((< (abs (- ?ah ?bh)) 14) (< (+ ?ah 14) ?bh))))""")
    assert domain is not None
    network = compile_domain(domain, {}).network(None)
    objects = [Percept("obj", f"o{n}", {"h": 7 * n}) for n in range(30)]
    for height in (14, 175, 100):
        spot = Percept("spot", "o19", {"h": height})
        assert network.update_snapshot([*objects, spot], {}).added == ()


FILTERED = """
(percepts (obj ^x ^h) (spot ^x ^h ^u))
(concepts
  ((level ?a ?s) :elements ((obj ?a ^h ?ah) (spot ?s ^h ?sh ^u ?_u))
                 :tests ((<= (abs (- ?ah (+ ?sh ?sh))) 30)))
  ((beneath ?a ?s) :elements ((obj ?a ^x ?ax) (spot ?s ^x ?sx ^u ?_u))
                   :tests ((> (+ ?ax 4) ?sx)))
  ((tall ?a ?s) :elements ((obj ?a ^x ?ax) (spot ?s ^x ?sx ^h ?v))
                :tests ((> ?v 200) (<= (abs (- ?ax ?sx)) 60)))
  ((far ?a ?s) :elements ((obj ?a ^x ?ax) (spot ?s ^x ?sx ^u ?v))
               :tests ((> ?v 200) (> (abs (- ?ax ?sx)) 60))))
"""


@pytest.mark.parametrize("seed", range(3))
def test_rules_that_leave_out_different_objects_of_one_type(seed: int) -> None:
    domain, problems = parse_domain(FILTERED)
    assert domain is not None, problems
    net, draw = compile_domain(domain).network(), random.Random(seed)
    there: dict[tuple[str, str], dict[str, int]] = {}
    for _ in range(12):
        for number in draw.sample(range(40), 12):
            there["obj", f"o{number}"] = {each: draw.randrange(0, 400, 7) for each in "xh"}
        for number in draw.sample(range(12), 4):
            there["spot", f"s{number}"] = {
                each: draw.randrange(0, 400, 7) for each in "xhu" if draw.random() < 0.8
            }
        net.update_snapshot(percepts(there), ())
        movers = [name for type_, name in there if type_ == "obj"]
        for few in (draw.sample(movers, 2), movers):
            for name in few:
                there["obj", name] = {each: draw.randrange(0, 400, 7) for each in "xh"}
            net.move("obj", few, {x: [there["obj", name][x] for name in few] for x in "xh"})
        found = {(each.predicate, *each.args) for each in net.beliefs()}
        assert found == {
            (concept, a, s)
            for (type_, a), obj in there.items()
            for (other, s), spot in there.items()
            if (type_, other) == ("obj", "spot")
            for concept, holds in {
                "level": spot.keys() >= {"h", "u"} and abs(obj["h"] - 2 * spot["h"]) <= 30,
                "beneath": spot.keys() >= {"x", "u"} and obj["x"] + 4 > spot["x"],
                "tall": spot.keys() >= {"x", "h"}
                and spot["h"] > 200
                and abs(obj["x"] - spot["x"]) <= 60,
                "far": spot.keys() >= {"x", "u"}
                and spot["u"] > 200
                and abs(obj["x"] - spot["x"]) > 60,
            }.items()
            if holds
        }
