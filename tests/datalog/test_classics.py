"""The classical Datalog exercises, each against a computation of its own in plain Python.

The facts come and go one or a few at a time, and after each step the network must have what the
other computation makes of the facts that are there.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable
from itertools import pairwise, product

import pytest
from datalog_programs import RefusedError, domain_of

from icarus_lite import Belief
from icarus_lite.inference.network import Delta, compile_domain

Pair = tuple[int, int]
Model = dict[str, set[tuple]]
_NODES = range(8)


def steps(seed: int, possible: list[Belief], length: int = 25) -> Iterable[Delta]:
    """Draw a history of facts that come and go; in the end half of them are there."""
    draw = random.Random(seed)
    there: dict[Belief, None] = {}
    for _ in range(length):
        chosen = draw.sample(possible, min(len(possible), draw.choice((1, 1, 2, 5))))
        new = [each for each in chosen if each not in there]
        old = [each for each in chosen if each in there]
        if len(there) > len(possible) // 2:
            new = new[:1]
            old += draw.sample([each for each in there if each not in old], min(3, len(there) // 4))
        for each in new:
            there[each] = None
        for each in old:
            del there[each]
        yield Delta(asserted=tuple(new), withdrawn=tuple(old))


def agree(
    rules: list[str], facts: dict[str, list[tuple]], expected: Callable[[Model], Model], seed: int
) -> None:
    """Tell a network a history; compare after each step the predicates that are expected."""
    network = compile_domain(domain_of(rules, facts)).network()
    possible = [Belief(name, row) for name, rows in facts.items() for row in rows]
    there: Model = {name: set() for name in facts}
    grown = 0
    for delta in steps(seed, possible):
        network.update(delta)
        for each in delta.asserted:
            there[each.predicate].add(each.args)
        for each in delta.withdrawn:
            there[each.predicate].discard(each.args)
        for name, rows in expected(there).items():
            assert {belief.args for belief in network.facts(name)} == rows, (name, there)
            grown += len(rows)
    assert grown > 0


def edges(name: str = "edge") -> dict[str, list[tuple]]:
    return {name: [(a, b) for a, b in product(_NODES, _NODES) if (3 * a + 5 * b) % 4 < 2]}


def reached(pairs: Iterable[Pair], avoid: int | None = None) -> set[Pair]:
    """Walk from each node along the pairs, never through one to avoid."""
    follows: dict[int, list[int]] = {}
    for a, b in pairs:
        if avoid not in (a, b):
            follows.setdefault(a, []).append(b)
    found = set()
    for start in follows:
        pending = [start]
        while pending:
            for each in follows.get(pending.pop(), ()):
                if (start, each) not in found:
                    found.add((start, each))
                    pending.append(each)
    return found


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    "step",
    ["edge(X, Z), path(Z, Y)", "path(X, Z), edge(Z, Y)", "path(X, Z), path(Z, Y)"],
    ids=["right", "left", "both"],
)
def test_transitive_closure(step: str, seed: int) -> None:
    rules = ["path(X, Y) :- edge(X, Y).", f"path(X, Y) :- {step}."]
    agree(rules, edges(), lambda there: {"path": reached(there["edge"])}, seed)


@pytest.mark.parametrize("seed", range(3))
def test_what_cannot_be_reached(seed: int) -> None:
    rules = [
        "path(X, Y) :- edge(X, Y).",
        "path(X, Y) :- edge(X, Z), path(Z, Y).",
        "node(X) :- edge(X, _).",
        "node(X) :- edge(_, X).",
        "apart(X, Y) :- node(X), node(Y), not path(X, Y).",
        "source(X) :- node(X), not edge(_, X).",
        "acyclic() :- edge(_, _), not cyclic().",
        "cyclic() :- path(X, X).",
    ]

    def expected(there: Model) -> Model:
        path = reached(there["edge"])
        nodes = {node for edge in there["edge"] for node in edge}
        return {
            "apart": {(a, b) for a, b in product(nodes, nodes) if (a, b) not in path},
            "source": {(a,) for a in nodes if a not in {b for _, b in there["edge"]}},
            "acyclic": {()} if nodes and not any(a == b for a, b in path) else set(),
        }

    agree(rules, edges(), expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_same_generation(seed: int) -> None:
    rules = [
        "same(X, X) :- parent(X, _).",
        "same(X, X) :- parent(_, X).",
        "same(X, Y) :- parent(X, U), same(U, V), parent(Y, V).",
    ]

    def expected(there: Model) -> Model:
        people = {each for pair in there["parent"] for each in pair}
        same = {(each, each) for each in people}
        while True:
            more = {
                (x, y) for x, u in there["parent"] for y, v in there["parent"] if (u, v) in same
            }
            if more <= same:
                return {"same": same}
            same |= more

    agree(rules, edges("parent"), expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_ancestors_and_siblings(seed: int) -> None:
    rules = [
        "ancestor(X, Y) :- parent(X, Y).",
        "ancestor(X, Y) :- parent(X, Z), ancestor(Z, Y).",
        "sibling(X, Y) :- parent(P, X), parent(P, Y), X != Y.",
        "childless(X) :- parent(_, X), not parent(X, _).",
        "related(X, Y) :- ancestor(A, X), ancestor(A, Y).",
    ]

    def expected(there: Model) -> Model:
        parent = there["parent"]
        ancestor = reached(parent)
        return {
            "ancestor": ancestor,
            "sibling": {(x, y) for p, x in parent for q, y in parent if p == q and x != y},
            "childless": {(x,) for _, x in parent if not any(p == x for p, _ in parent)},
            "related": {(x, y) for a, x in ancestor for b, y in ancestor if a == b},
        }

    people = {"parent": [(a, b) for a in _NODES for b in _NODES if a < b]}
    agree(rules, people, expected, seed)


def test_win_move_is_refused_as_it_stands() -> None:
    with pytest.raises(RefusedError, match="ICR019"):
        domain_of(["win(X) :- move(X, Y), not win(Y)."], {"move": [(1, 2)]})


@pytest.mark.parametrize("seed", range(3))
def test_win_move_within_four_moves(seed: int) -> None:
    """A position is lost in n if each move leads to one won in n, and won in n+1 if one is lost."""
    rules = ["can(X) :- move(X, _).", "end(X) :- move(_, X), not can(X)."]
    rules += ["win_1(X) :- move(X, Y), end(Y)."]
    for n in range(1, 4):
        rules += [
            f"open_{n}(X) :- move(X, Y), not win_{n}(Y).",
            f"lost_{n}(X) :- can(X), not open_{n}(X).",
            f"win_{n + 1}(X) :- win_{n}(X).",
            f"win_{n + 1}(X) :- move(X, Y), lost_{n}(Y).",
        ]

    def expected(there: Model) -> Model:
        moves = there["move"]
        nodes = {node for move in moves for node in move}
        can = {a for a, _ in moves}
        win = {a for a, b in moves if b not in can}
        model = {"win_1": {(a,) for a in win}}
        for n in range(1, 4):
            lost = {a for a in can if all(b in win for x, b in moves if x == a)}
            win = win | {a for a, b in moves if b in lost}
            model |= {f"lost_{n}": {(a,) for a in lost}, f"win_{n + 1}": {(a,) for a in win}}
        assert win <= nodes
        return model

    agree(rules, edges("move"), expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_points_to_analysis(seed: int) -> None:
    """Andersen's: which variable may point to which object, through copies and the heap."""
    rules = [
        "points(V, O) :- new(V, O).",
        "points(V, O) :- copy(V, W), points(W, O).",
        "points(V, O) :- load(V, W), points(W, P), heap(P, O).",
        "heap(P, O) :- store(V, W), points(V, P), points(W, O).",
        "alias(V, W) :- points(V, O), points(W, O), V != W.",
    ]
    some = range(5)
    facts = {
        "new": [(v, 10 + v) for v in some],
        "copy": [(v, w) for v, w in product(some, some) if (v + 2 * w) % 3 == 0 and v != w],
        "load": [(v, w) for v, w in product(some, some) if (v + w) % 4 == 1],
        "store": [(v, w) for v, w in product(some, some) if (2 * v + w) % 5 == 2],
    }

    def expected(there: Model) -> Model:
        points, heap = set(there["new"]), set()
        while True:
            more = {(v, o) for v, w in there["copy"] for u, o in points if u == w}
            more |= {
                (v, o) for v, w in there["load"] for u, p in points if u == w
                for q, o in heap if q == p
            }  # fmt: skip
            stored = {
                (p, o) for v, w in there["store"] for u, p in points if u == v
                for x, o in points if x == w
            }  # fmt: skip
            if more <= points and stored <= heap:
                break
            points |= more
            heap |= stored
        alias = {(v, w) for v, o in points for w, p in points if o == p and v != w}
        return {"points": points, "heap": heap, "alias": alias}

    agree(rules, facts, expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_dominators(seed: int) -> None:
    """One node dominates another if there is no way from the entry that avoids it."""
    rules = [
        "reach(0).",
        "reach(Y) :- reach(X), edge(X, Y).",
        "node(X) :- edge(X, _).",
        "node(X) :- edge(_, X).",
        "avoids(0, D) :- node(D), D != 0.",
        "avoids(Y, D) :- avoids(X, D), edge(X, Y), Y != D.",
        "dominates(D, X) :- reach(X), node(D), not avoids(X, D).",
    ]

    def expected(there: Model) -> Model:
        edge = there["edge"]
        nodes = {node for pair in edge for node in pair}
        reach = {0} | {b for a, b in reached(edge) if a == 0}
        dominates = set()
        for d in nodes:
            around = {0} | {b for a, b in reached(edge, avoid=d) if a == 0} if d else set()
            dominates |= {(d, x) for x in reach if x not in around}
        return {"reach": {(x,) for x in reach}, "dominates": dominates}

    agree(rules, edges(), expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_for_all_by_double_negation(seed: int) -> None:
    rules = [
        "lacks(S) :- student(S), required(C), not passed(S, C).",
        "graduate(S) :- student(S), not lacks(S).",
        "beaten(S) :- student(S), student(T), passed(T, C), not passed(S, C).",
        "best(S) :- student(S), not beaten(S).",
    ]
    facts = {
        "student": [(s,) for s in range(4)],
        "required": [(c,) for c in (101, 102, 103)],
        "passed": [(s, c) for s in range(4) for c in (101, 102, 103, 104)],
    }

    def expected(there: Model) -> Model:
        students = {s for (s,) in there["student"]}
        required = {c for (c,) in there["required"]}
        passed = {s: {c for t, c in there["passed"] if t == s} for s in students}
        every = set().union(*passed.values())
        return {
            "graduate": {(s,) for s in students if required <= passed[s]},
            "best": {(s,) for s in students if passed[s] == every},
        }

    agree(rules, facts, expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_the_least_by_negation(seed: int) -> None:
    rules = [
        "smaller(X) :- number(X), number(Y), Y < X.",
        "least(X) :- number(X), not smaller(X).",
        "between(X, Y) :- number(X), number(Z), number(Y), X < Z, Z < Y.",
        "next(X, Y) :- number(X), number(Y), X < Y, not between(X, Y).",
        "gap(X, Y - X) :- next(X, Y).",
    ]

    def expected(there: Model) -> Model:
        numbers = sorted(n for (n,) in there["number"])
        follows = list(pairwise(numbers))
        return {
            "least": {(n,) for n in numbers[:1]},
            "next": set(follows),
            "gap": {(a, b - a) for a, b in follows},
        }

    agree(rules, {"number": [(n * n,) for n in range(9)]}, expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_parsing_by_parts(seed: int) -> None:
    """The language of balanced brackets, with a rule of the grammar for each clause."""
    rules = [
        "s(I, J) :- open(I, K), close(K, J).",
        "s(I, J) :- open(I, K), s(K, L), close(L, J).",
        "s(I, J) :- s(I, K), s(K, J).",
    ]
    size = 10
    facts = {"open": [(i, i + 1) for i in range(size)], "close": [(i, i + 1) for i in range(size)]}

    def expected(there: Model) -> Model:
        def balanced(i: int, j: int) -> bool:
            """Try every choice of brackets for the places between."""
            heights = {0}
            for k in range(i, j):
                up = {h + 1 for h in heights} if (k, k + 1) in there["open"] else set()
                down = {h - 1 for h in heights if h} if (k, k + 1) in there["close"] else set()
                heights = up | down
            return 0 in heights

        spans = [(i, j) for i in range(size) for j in range(i + 2, size + 1)]
        return {"s": {span for span in spans if balanced(*span)}}

    agree(rules, facts, expected, seed)


@pytest.mark.parametrize("seed", range(3))
def test_even_and_odd_paths_lean_on_each_other(seed: int) -> None:
    rules = [
        "odd(X, Y) :- edge(X, Y).",
        "odd(X, Y) :- edge(X, Z), even(Z, Y).",
        "even(X, Y) :- edge(X, Z), odd(Z, Y).",
        "only_odd(X, Y) :- odd(X, Y), not even(X, Y).",
    ]

    def expected(there: Model) -> Model:
        doubled = {((a, side), (b, not side)) for a, b in there["edge"] for side in (False, True)}
        ways = reached(doubled)  # type: ignore[arg-type] # any nodes will do
        odd = {(a, b) for (a, s), (b, t) in ways if not s and t}
        even = {(a, b) for (a, s), (b, t) in ways if not s and not t}
        return {"odd": odd, "even": even, "only_odd": odd - even}

    agree(rules, edges(), expected, seed)


def test_counting_without_end_is_refused() -> None:
    with pytest.raises(RefusedError, match="ICR034"):
        domain_of(["n(X + 1) :- n(X)."], {"n": [(0,)]})
