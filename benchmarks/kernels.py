"""What each way to keep a pair relation up to date costs, and where one overtakes the other.

    python benchmarks/kernels.py [--objects 15 50 200 1000] [--rounds 40]

The three pair rules of `benchmarks/tabletop.icr` over scenes of equal density. Of N objects k move
by up to 10 mm, the relation is told, and every way to follow is measured on the same moves: list
comprehensions, strips, blocks of numpy rows, a sweep (for an order of keys: one move after the
other, all keys against all, all keys sorted), and the way that is chosen at run time. Each is the
lower quartile of the rounds, in microseconds of processor time of this thread (on a busy machine a
median says more about its neighbours); the best way is starred.
After each cell all ways must agree with a relation loaded afresh. Then the three rules are followed
together, in each of the ways that a group has, and each by itself. At the end the constants of
`icarus_lite/inference/network/kernels/costs.py` are fitted to the measured times of single rules.
"""

from __future__ import annotations

import argparse
import platform
import random
import statistics
import time
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import nnls

from icarus_lite.inference.network.kernels import (
    Columns,
    GroupProgram,
    Member,
    PairGroup,
    PairKernel,
    PairRelation,
    PairSide,
    compile_group,
    compile_pair,
)
from icarus_lite.inference.network.kernels.columns import first_of_run
from icarus_lite.inference.network.kernels.order import OrderRelation
from icarus_lite.language import load_domain
from icarus_lite.language.syntax import Atom, ConceptClause, Variable

DOMAIN = Path(__file__).with_name("tabletop.icr")
RULES = ("near", "on", "left-of")
ATTRIBUTES = ("x", "y", "z", "w", "d", "h")
WAYS = {
    "near": ("list", "strip", "block", "sweep"),
    "on": ("list", "strip", "block", "sweep"),
    "left-of": ("list", "block", "sweep"),
}
STEP_MM = 10
GROUP_WAYS = ("few", "flat", "near", "whole", "alone")
MOVED = ("x", "y", "z")


def kernel_of(clause: ConceptClause) -> PairKernel:
    """Compile the pair rule with which a clause begins."""
    sides = [_side(condition.atom) for condition in clause.elements[:2]]
    kernel = compile_pair(*sides, clause.tests, distinct=False)
    if kernel is None:
        raise SystemExit(f"{clause.head} is no numeric pair rule")
    return kernel


def _side(atom: Atom) -> PairSide:
    bound = [(term.name, name) for name, term in atom.attributes if isinstance(term, Variable)]
    (name,) = atom.args
    return PairSide(name.name if isinstance(name, Variable) else None, tuple(bound))


def scene(size: int, rng: random.Random) -> list[list[int]]:
    """Give objects at sixteen a square metre, three in ten of them on top of another."""
    width = int(250 * size**0.5)
    rows: list[list[int]] = []
    for _ in range(size):
        sizes = [rng.randrange(40, 81) for _ in range(3)]
        if rows and rng.random() < 0.3:
            below = rng.choice(rows)
            rows.append([below[0], below[1], below[2] + below[5], *sizes])
        else:
            rows.append([rng.randrange(width), rng.randrange(width), 0, *sizes])
    return rows


@dataclass(frozen=True, slots=True)
class Cell:
    """What was measured for one rule, N and k: microseconds by way, and pairs that changed."""

    rule: str
    size: int
    moving: int
    times: dict[str, float]
    load: float
    candidates: float
    changed: float


def measure(kernel: PairKernel, rule: str, size: int, moving: int, rounds: int) -> Cell:
    """Time every way on the same moves."""
    rng = random.Random(1000 * size + moving)  # noqa: S311 # a scene, not a secret
    rows, columns = scene(size, rng), Columns(ATTRIBUTES)
    for number, row in enumerate(rows):
        columns.put(f"o{number}", tuple(row))
    relations = {"chosen": kernel.instance(columns, columns)}
    for way in WAYS[rule]:
        relations[way] = kernel.only_by(way).instance(columns, columns)
    begin = time.thread_time()
    relations["chosen"].load()
    load = time.thread_time() - begin
    for relation in relations.values():
        relation.load()
    spent: dict[str, list[float]] = defaultdict(list)
    changed = 0
    for number in range(rounds):
        moved = rng.sample(range(size), moving)
        for slot in moved:
            for axis in range(3):
                rows[slot][axis] += rng.randrange(-STEP_MM, STEP_MM + 1)
            columns.put(f"o{slot}", tuple(rows[slot]))
        # Whoever comes first brings the arrays of the columns up to date for all.
        ways = list(relations)
        for way in ways[number % len(ways) :] + ways[: number % len(ways)]:
            relation = relations[way]
            begin = time.thread_time()
            added, removed = relation.update(moved, moved)
            spent[way].append(1e6 * (time.thread_time() - begin))
        changed += len(added) + len(removed)
    _check(kernel, columns, relations)
    times = {way: statistics.quantiles(found, n=4)[0] for way, found in spent.items()}
    reach, width = {"near": 300, "on": 40}.get(rule, 0), 250 * size**0.5
    candidates = size * min(1.0, 2 * reach / width)
    return Cell(rule, size, moving, times, 1e6 * load, candidates, changed / rounds)


def _check(kernel: PairKernel, columns: Columns, relations: dict[str, PairRelation]) -> None:
    fresh = kernel.instance(columns, columns)
    fresh.load()
    wanted = list(fresh.pairs())
    for way, relation in relations.items():
        if list(relation.pairs()) != wanted or len(relation) != len(wanted):
            raise SystemExit(f"{way} has gone wrong")


def measure_group(program: GroupProgram, size: int, moving: int, rounds: int) -> dict[str, float]:
    """Time the three rules together, on the same moves: microseconds by way."""
    kernels = [member.kernel for member in program.members]
    spent: dict[str, list[float]] = {}
    for way in (*GROUP_WAYS, "chosen"):
        rng = random.Random(1000 * size + moving)  # noqa: S311 # a scene, not a secret
        rows, columns = scene(size, rng), Columns(ATTRIBUTES)
        for number, row in enumerate(rows):
            columns.put(f"o{number}", tuple(row))
        relations = [kernel.instance(columns, columns) for kernel in kernels]
        for relation in relations:
            relation.load()
        own = program if way == "chosen" else program.only_by(way)
        group = PairGroup(own, relations, columns)  # type: ignore[arg-type] # of these two kinds
        spent[way] = []
        for _ in range(rounds):
            moved = sorted(rng.sample(range(size), moving))
            for slot in moved:
                for axis in range(3):
                    rows[slot][axis] += rng.randrange(-STEP_MM, STEP_MM + 1)
            for place in range(3):
                values = tuple(rows[slot][place] for slot in moved)
                columns.assign(moved, [(place, values)], first_of_run(moved), plain=True)
            begin = time.thread_time()
            _follow(group, relations, moved)
            spent[way].append(1e6 * (time.thread_time() - begin))
        for kernel, relation in zip(kernels, relations, strict=True):
            _check(kernel, columns, {f"{way} together": relation})
    return {way: statistics.quantiles(found, n=4)[0] for way, found in spent.items()}


def _follow(group: PairGroup, relations: Sequence[PairRelation], moved: list[int]) -> None:
    found = group.follow(moved, MOVED)
    for number, relation in enumerate(relations):
        if found is None:
            relation.update(moved, moved)
        elif isinstance(relation, OrderRelation):
            group.order(number)
        elif number in found:
            group.matrix(number, found[number])
    if found is None:
        group.disarm()


def show_groups(program: GroupProgram, sizes: Sequence[int], rounds: int) -> None:
    """Measure and print the three rules together, a line a scene and number of moving objects."""
    print("\nall three together")
    print(f"{'N':>6}{'k':>6}" + "".join(f"{way:>11}" for way in (*GROUP_WAYS, "chosen")))
    for size in sizes:
        for moving in sorted({1, 2, 5, size // 10, size // 3, size} - {0}):
            fewer = max(5, rounds // (1 + moving * size // 100_000))
            times = measure_group(program, size, moving, fewer)
            print(f"{size:6}{moving:6}" + "".join(f"{value:11.1f}" for value in times.values()))


def show(cells: Sequence[Cell]) -> None:
    """Print a line a cell."""
    print(f"{'rule':8}{'N':>6}{'k':>6}", end="")
    print("".join(f"{word:>11}" for word in ("list", "strip", "block", "sweep", "chosen")), end="")
    print(f"{'first':>10}{'changes':>9}")
    for cell in cells:
        best = min(value for way, value in cell.times.items() if way != "chosen")
        print(f"{cell.rule:8}{cell.size:6}{cell.moving:6}", end="")
        for way in ("list", "strip", "block", "sweep", "chosen"):
            value = cell.times.get(way)
            text = "-" if value is None else f"{value:.1f}{'*' if value == best else ' '}"
            print(f"{text:>11}", end="")
        print(f"{cell.load:10.0f}{cell.changed:9.1f}")


def fit(cells: Sequence[Cell], kernels: dict[str, PairKernel]) -> None:
    """Print the constants that explain the measured times best, each relative to its size."""
    data: dict[str, list[tuple[list[float], float]]] = defaultdict(list)
    for cell in cells:
        kernel = kernels[cell.rule]
        n, k, ops = cell.size, cell.moving, kernel.plan.costs.operations
        if cell.rule == "left-of":
            data["ORDER_MOVE"].append(([2 * k], cell.times["list"]))
            data["ORDER_ALL, ORDER_ALL_PAIR"].append(([1, n * n], cell.times["block"]))
            data["ORDER_SORT, ORDER_SORT_OBJECT"].append(([1, 2 * n], cell.times["sweep"]))
            continue
        sides = 1 if kernel.symmetric else 2
        rows, pairs = sides * k, sides * k * n
        block, calls = min(pairs, n * n), 2 if sides == 2 and pairs < n * n else 1
        data["LIST_ROW, LIST_PAIR, LIST_OPERATION"].append(
            ([rows, pairs, ops * pairs], cell.times["list"])
        )
        if 4 * rows < 2 * n:
            near = rows * cell.candidates
            data["NEAR_ROW, NEAR_OPERATION (after LIST_PAIR)"].append(
                ([rows, ops * near], cell.times["strip"] - 0.02 * near)
            )
        data["BLOCK, BLOCK_OPERATION, BLOCK_PAIR"].append(
            ([calls, calls * ops, ops * block], cell.times["block"])
        )
        if n >= 50:
            data["SWEEP, SWEEP_OPERATION, SWEEP_OBJECT"].append(
                ([1, ops, 2 * n], cell.times["sweep"])
            )
    print()
    for names, found in data.items():
        features = np.array([row for row, _ in found], dtype=float)
        times = np.array([spent for _, spent in found])
        solved, _ = nnls(features / times[:, None], np.ones(len(times)))
        print(f"{names}: {', '.join(f'{value:.4g}' for value in solved)}")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--objects", type=int, nargs="+", default=[15, 50, 200, 1000])
    parser.add_argument("--rounds", type=int, default=40)
    arguments = parser.parse_args()
    clauses = {clause.head.predicate: clause for clause in load_domain(DOMAIN).concepts}
    kernels = {rule: kernel_of(clauses[rule]) for rule in RULES}
    print(f"Python {platform.python_version()}, numpy {np.__version__}, {platform.machine()}")
    cells = []
    for rule, kernel in kernels.items():
        print(f"{rule}: {kernel.summary}; {kernel.plan.costs.operations} operations")
        for size in arguments.objects:
            for moving in sorted({1, 2, 5, size // 10, size // 3, size} - {0}):
                rounds = max(5, arguments.rounds // (1 + moving * size // 100_000))
                cells.append(measure(kernel, rule, size, moving, rounds))
    show(cells)
    members = [Member(rule, kernel, "obj", "obj") for rule, kernel in kernels.items()]
    program = compile_group("obj", members)
    if program is None:
        raise SystemExit("the rules cannot be followed together")
    show_groups(program, arguments.objects, arguments.rounds)
    fit(cells, kernels)


if __name__ == "__main__":
    main()
