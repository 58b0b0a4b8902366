"""Proofs: the first reason is found without looking for all, and never goes round in a circle."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from icarus_lite import Belief, Percept
from icarus_lite.inference.network import Delta, Network, compile_domain
from icarus_lite.inference.network.proofs import MANY
from icarus_lite.inference.views import Row
from icarus_lite.language import parse_domain

TEXT = """
(percepts (obj ^x ^mark) (link ^from ^to))
(concepts
  ((beside ?a ?b) :elements ((obj ?a ^x ?x) (obj ?b ^x ?x)) :tests ((/= ?a ?b)))
  ((seen) :elements ((obj ?any)))
  ((company ?a) :elements ((beside ?a ?any)))
  ((marked ?a by) :elements ((obj ?a ^mark ?m)) :tests ((= ?m yes)))
  ((marked ?a ?how) :elements ((obj ?a ^mark ?m) (hint ?m ?how) (not (veto ?a ?other))))
  ((joined ?a ?b) :elements ((link ?l ^from ?a ^to ?b)))
  ((joined ?a ?c) :elements ((joined ?a ?b) (joined ?b ?c))))
"""
DOMAIN, PROBLEMS = parse_domain(TEXT)
assert DOMAIN is not None, PROBLEMS


def network(*percepts: Percept, asserted: tuple[Belief, ...] = ()) -> Network:
    made = compile_domain(DOMAIN).network()
    made.update(Delta(percepts, asserted=asserted))
    return made


def obj(name: str, x: int, **more: str) -> Percept:
    return Percept("obj", name, {"x": x, **more})


def crowd(count: int) -> Network:
    names = [f"o{number:03}" for number in range(count)]
    random.Random(3).shuffle(names)
    return network(*(obj(name, 0) for name in names))


@pytest.mark.parametrize("count", [2, MANY - 1, MANY, MANY + 1])
def test_of_few_ways_the_one_with_the_least_values_is_first(count: int) -> None:
    net = crowd(count)
    first, *_ = net.supports(Belief("seen"))
    assert net.support(Belief("seen")) == first
    if count <= MANY:
        assert str(first.matched[0]) == "(obj o000)"


def test_of_very_many_ways_only_some_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    net, given = crowd(500), []
    belief = Belief("company", ("o007",))
    assert net.support(belief) is not None  # the clauses are ready now
    (ways,) = net._proving()._of(("company", 1))
    prove = ways.rows

    def counting(*args: object) -> Iterator[Row]:
        for row in prove(*args):
            given.append(row)
            yield row

    monkeypatch.setattr(ways, "rows", counting)
    first = net.support(belief)
    assert len(given) == MANY
    every = net.supports(belief)
    assert len(every) == 499
    assert every[0] == first
    assert len({each.matched for each in every}) == 499


def test_the_clause_written_first_comes_first() -> None:
    hints = (Belief("hint", ("yes", "by")), Belief("hint", ("yes", "so")))
    net = network(obj("a", 1, mark="yes"), obj("b", 2, mark="no"), asserted=hints)
    by, other = net.supports(Belief("marked", ("a", "by")))
    assert (by.clause.span.line, other.clause.span.line) == (7, 8)
    assert net.support(Belief("marked", ("a", "by"))) == by
    assert by.bindings == {"?a": "a", "?m": "yes"}
    assert other.bindings == {"?a": "a", "?m": "yes", "?how": "by"}
    assert [str(each) for each in other.absent] == ["(veto a ?other)"]
    assert [dict(each.attributes) for each in other.matched] == [{"x": 1, "mark": "yes"}, {}]


def test_what_is_only_given_or_not_believed_has_no_derivation() -> None:
    hint = Belief("hint", ("yes", "so"))
    net = network(obj("a", 1), asserted=(hint,))
    for belief in (hint, Belief("marked", ("a", "so")), Belief("obj", ("a",)), Belief("joined")):
        assert net.support(belief) is None
        assert net.supports(belief) == ()


@pytest.mark.parametrize("seed", range(5))
def test_the_first_reasons_of_a_recursive_concept_end_at_percepts(seed: int) -> None:
    draw = random.Random(seed)
    net = network(*(Percept("link", f"l{i}", {"from": "a", "to": "b"}) for i in range(8)))
    for _ in range(40):
        name = f"l{draw.randrange(8)}"
        ends = {"from": [draw.choice("abcde")], "to": [draw.choice("abcde")]}
        net.move("link", [name], ends)
        for belief in net.facts("joined"):
            assert net.supports(belief)[0] == net.support(belief)
            open_, pending = set[Belief](), [(belief, True)]
            while pending:
                each, down = pending.pop()
                if not down:
                    open_.discard(each)
                    continue
                assert each not in open_, f"{belief} rests on {each}, which rests on itself"
                found = net.support(each)
                assert found is not None or each.predicate == "link"
                if found is not None:
                    open_.add(each)
                    pending.append((each, False))
                    pending += [(premise, True) for premise in found.matched]
