"""Whole scenes that move: every way to follow gives the pairs that Python computes one by one."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from icarus_lite.errors import InferenceError
from icarus_lite.inference.network.kernels import (
    Columns,
    PairKernel,
    PairRelation,
    PairSide,
    array_source,
    compile_pair,
    python_source,
)
from icarus_lite.inference.network.kernels.columns import first_of_run, is_plain
from icarus_lite.inference.network.kernels.matrix import MatrixRelation
from icarus_lite.inference.network.kernels.order import OrderRelation
from icarus_lite.language import parse_domain
from icarus_lite.language.syntax import Call

ATTRIBUTES = ("x", "y", "z", "w")
LEFT = PairSide("?a", tuple((f"?{name}a", name) for name in ATTRIBUTES))
RIGHT = PairSide("?b", tuple((f"?{name}b", name) for name in ATTRIBUTES))
APART = "(/= ?a ?b)"
NEAR = """(< (+ (* (- ?xa ?xb) (- ?xa ?xb)) (* (- ?ya ?yb) (- ?ya ?yb))
               (* (- ?za ?zb) (- ?za ?zb))) 90000)"""
DISTANT = "(<= (distance ?xa ?ya ?xb ?yb) 250)"
ON = "(<= (abs (- ?za (+ ?zb 60))) 5) (< (* 2 (abs (- ?xa ?xb))) ?wb) (< (abs (- ?yb ?ya)) 40)"
LEFT_OF = "(<= (+ (* 2 ?xa) ?wa) (- (* 2 ?xb) ?wb))"
HEAVIER = "(> (* ?wa 3) (+ ?wb 120))"
STEEP = "(/= ?xa ?xb) (< (abs (/ (- ?ya ?yb) (- ?xa ?xb))) 0.4)"
UNBOUNDED = "(< (+ ?xa ?yb) (+ ?xb ?ya)) (or (not (= ?za ?zb)) (< ?wa ?wb))"

Row = tuple[float, float, float, float]


def move(columns: Columns, slots: list[int], moved: dict[str, np.ndarray]) -> None:
    """Set some attributes of objects, as a table does."""
    for attribute, values in moved.items():
        given = tuple(values.tolist())
        plain = all(map(is_plain, given))
        place = columns.places[attribute]
        columns.assign(slots, [(place, given)], first_of_run(slots), plain=plain)
    columns.judge(slots)


def calls_of(text: str) -> tuple[Call, ...]:
    domain, problems = parse_domain(
        f"""(percepts (object ^x ^y ^z ^w))
            (concepts ((related ?a ?b)
              :elements ((object ?a ^x ?xa ^y ?ya ^z ?za ^w ?wa)
                         (object ?b ^x ?xb ^y ?yb ^z ?zb ^w ?wb))
              :tests ({text})))""",
        "scene.icr",
    )
    assert domain is not None, problems
    return domain.concepts[0].tests


def kernel_of(text: str) -> PairKernel:
    kernel = compile_pair(LEFT, RIGHT, calls_of(text), distinct=False, path="scene.icr")
    assert kernel is not None
    return kernel


def near(a: Row, b: Row) -> bool:
    (dx, dy, dz) = (a[n] - b[n] for n in range(3))
    return dx * dx + dy * dy + dz * dz < 90000


def on(a: Row, b: Row) -> bool:
    return abs(a[2] - (b[2] + 60)) <= 5 and 2 * abs(a[0] - b[0]) < b[3] and abs(b[1] - a[1]) < 40


def steep(a: Row, b: Row) -> bool:
    return a[0] != b[0] and abs((a[1] - b[1]) / (a[0] - b[0])) < 0.4


RULES: dict[str, tuple[str, Callable[[Row, Row], bool]]] = {
    "near": (f"{APART} {NEAR}", near),
    "near itself": (NEAR, near),
    "distant": (f"{APART} {DISTANT}", lambda a, b: math.dist(a[:2], b[:2]) <= 250),
    "on": (f"{APART} {ON}", on),
    "left of": (f"{APART} {LEFT_OF}", lambda a, b: 2 * a[0] + a[3] <= 2 * b[0] - b[3]),
    "heavier": (HEAVIER, lambda a, b: a[3] * 3 > b[3] + 120),
    "steep": (f"{APART} {STEEP}", steep),
    "unbounded": (
        UNBOUNDED,
        lambda a, b: a[0] + b[1] < b[0] + a[1] and (a[2] != b[2] or a[3] < b[3]),
    ),
}
ITSELF = {"near itself", "heavier", "unbounded"}


def row(rng: random.Random, width: int) -> Row:
    kind = rng.choice([int, int, float])
    return (
        kind(rng.randrange(width)),
        kind(rng.randrange(width)) / 2 if kind is float else rng.randrange(width),
        rng.choice([0, 60, 120]),
        rng.randrange(40, 81),
    )


def pairs_of(columns: Columns, holds: Callable[[Row, Row], bool], *, itself: bool) -> set:
    rows = [
        (slot, tuple(column[slot] for column in columns.lists))
        for slot in range(columns.size)
        if columns.alive[slot]
    ]
    return {
        (i, j)
        for i, a in rows
        for j, b in rows
        if (itself or i != j) and holds(a, b)  # type: ignore[arg-type]
    }


@pytest.mark.parametrize("way", ["list", "strip", "block", "sweep", "chosen"])
@pytest.mark.parametrize("rule", RULES)
def test_a_scene_that_moves_grows_and_shrinks(rule: str, way: str) -> None:
    text, holds = RULES[rule]
    kernel = kernel_of(text)
    if way != "chosen":
        kernel = kernel.only_by(way)
    rng = random.Random(len(rule) * 100 + len(way))
    columns = Columns(ATTRIBUTES)
    relation = kernel.instance(columns, columns)
    held: set = set()
    for step in range(14):
        changed = step_of(columns, rng, step)
        added, removed = relation.update(changed, changed)
        assert held.isdisjoint(added)
        assert held.issuperset(removed)
        held = (held - set(removed)) | set(added)
        assert held == pairs_of(columns, holds, itself=rule in ITSELF)
        assert len(relation) == len(held)
        columns.settle()
    assert list(relation.pairs()) == sorted(held)
    fresh = kernel.instance(columns, columns)
    fresh.load()
    assert list(fresh.pairs()) == sorted(held)


def step_of(columns: Columns, rng: random.Random, step: int) -> list[int]:
    """Move a few or all of the objects; some come, some go."""
    width = 1500
    changed: dict[int, None] = {}
    if step in (0, 5):
        for number in range(60):
            changed[columns.put(f"o{step}-{number}", row(rng, width))] = None
    names = sorted(map(str, columns.slots))
    moving = len(names) if step % 4 == 3 else rng.randrange(1, 7)
    for name in rng.sample(names, moving):
        old = [column[columns.slot(name)] for column in columns.lists]
        new = (old[0] + rng.randrange(-40, 41), old[1] + rng.randrange(-40, 41), *old[2:])  # type: ignore[operator]
        changed[columns.put(name, new)] = None
    if step in (4, 9):
        for name in rng.sample(names, 20):
            changed[columns.drop(name)] = None
    return list(changed)


def scene(size: int = 80, seed: int = 3) -> Columns:
    rng, columns = random.Random(seed), Columns(ATTRIBUTES)
    for number in range(size):
        columns.put(f"o{number}", row(rng, 1500))
    return columns


@pytest.mark.parametrize("rule", RULES)
def test_many_objects_may_be_moved_by_arrays(rule: str) -> None:
    text, holds = RULES[rule]
    columns = scene()
    relation = kernel_of(text).instance(columns, columns)
    relation.load()
    slots = list(range(columns.size))
    rng = np.random.default_rng(4)
    for _ in range(3):
        move(columns, slots, {"x": rng.integers(0, 1500, 80), "y": rng.uniform(0, 1500, 80)})
        relation.update(slots, slots)
        assert set(relation.pairs()) == pairs_of(columns, holds, itself=rule in ITSELF)


@pytest.mark.parametrize("rule", RULES)
def test_a_copy_goes_on_alone(rule: str) -> None:
    text, holds = RULES[rule]
    columns = scene()
    relation = kernel_of(text).instance(columns, columns)
    relation.load()
    before = set(relation.pairs())
    other = columns.copy()
    copied = relation.copy(other, other)
    slots = [other.put(f"o{n}", (700 + n, 700, 60, 50)) for n in range(12)]
    copied.update(slots, slots)
    assert set(copied.pairs()) == pairs_of(other, holds, itself=rule in ITSELF)
    assert set(relation.pairs()) == before
    assert relation.update(slots, slots) == ([], [])


@pytest.mark.parametrize("way", ["list", "strip", "block", "sweep"])
def test_pairs_of_two_types_never_join_an_object_with_itself(way: str) -> None:
    left, right = scene(50), scene(70)
    relation = kernel_of(f"{APART} {NEAR}").only_by(way).instance(left, right)
    rng = random.Random(8)
    everything = list(range(50)), list(range(70))
    relation.update(*everything)
    for _ in range(5):
        moved = [rng.sample(everything[n], 6) for n in range(2)]
        for columns, slots in zip((left, right), moved, strict=True):
            for slot in slots:
                columns.put(columns.names[slot], row(rng, 1500))
        relation.update(*moved)
        wanted = {
            (i, j)
            for i in range(50)
            for j in range(70)
            if i != j and near(*(tuple(c[s] for c in t.lists) for t, s in ((left, i), (right, j))))  # type: ignore[arg-type]
        }
        assert set(relation.pairs()) == wanted


@pytest.mark.parametrize("way", ["list", "strip", "block", "sweep"])
@pytest.mark.parametrize("rule", ["near", "distant", "unbounded"])
def test_sums_that_correct_themselves_are_compared_with_a_margin(
    rule: str, way: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # As under Python 3.12 and later, where numpy and `sum` may differ in the last bit.
    for module in (array_source, python_source):
        monkeypatch.setattr(module, "COMPENSATED_SUMS", True)
    text, holds = RULES[rule]
    kernel = kernel_of(text).only_by(way)
    assert ("sum((" in kernel.source) is (rule == "near")
    assert ("doubt_" in kernel.source) is (rule != "unbounded")
    columns = scene()
    relation = kernel.instance(columns, columns)
    slots = list(range(columns.size))
    relation.update(slots, slots)
    assert set(relation.pairs()) == pairs_of(columns, holds, itself=rule in ITSELF)
    # Exactly on the edge: 180 and 240 make 300, 150 and 200 make 250.
    moved = [columns.put("o1", (0, 0, 0, 40)), columns.put("o2", (180, 240, 0, 40))]
    moved += [
        columns.put("o3", (150, 200, 0, 40)),
        columns.put("o4", (180.0, 239.99999999999997, 0, 40)),
    ]
    relation.update(moved, moved)
    assert set(relation.pairs()) == pairs_of(columns, holds, itself=rule in ITSELF)


# What is recognised.


@pytest.mark.parametrize(
    ("text", "kind", "axes", "symmetric"),
    [
        (NEAR, MatrixRelation, 3, True),
        (DISTANT, MatrixRelation, 2, True),
        (ON, MatrixRelation, 3, False),
        (LEFT_OF, OrderRelation, 0, False),
        (f"{APART} (> ?xa ?xb)", OrderRelation, 0, False),
        ("(< ?xa ?xb) (< ?ya ?yb)", MatrixRelation, 0, False),
        ("(< (sqrt (+ (* (- ?xa ?xb) (- ?xa ?xb)) 1)) 5)", MatrixRelation, 1, True),
        ("(and (< (abs (- ?xa ?xb)) 4) (> ?wb (abs (- ?yb ?ya))))", MatrixRelation, 2, False),
        ("(< (max (abs (- ?xa ?xb)) (abs (- ?ya ?yb))) 4)", MatrixRelation, 2, True),
        ("(< (abs (+ ?xa ?xb)) 5)", MatrixRelation, 0, True),
        (STEEP, MatrixRelation, 0, False),
    ],
)
def test_what_a_rule_is_about_is_recognised(
    text: str,
    kind: type[PairRelation],
    axes: int,
    symmetric: bool,  # noqa: FBT001
) -> None:
    kernel = kernel_of(text)
    columns = Columns(ATTRIBUTES)
    assert isinstance(kernel.instance(columns, columns), kind)
    assert (len(kernel.axes), kernel.symmetric) == (axes, symmetric)


@pytest.mark.parametrize(
    "text",
    ["(< ?xa 5)", "(= ?xa peg) (< ?xa ?xb)", "(< ?xa ?xb) (= ?a ?xb)", "(not-known ?xa ?xb)", ""],
)
def test_what_is_no_numeric_pair_rule_is_left_to_others(text: str) -> None:
    domain_tests = {
        "(= ?xa peg) (< ?xa ?xb)": calls_of("(= ?xa peg) (< ?xa ?xb)"),
        "(not-known ?xa ?xb)": (Call("not-known", calls_of("(< ?xa ?xb)")[0].args),),
    }
    tests = domain_tests.get(text)
    if tests is None:
        tests = calls_of(text) if text else ()
    assert compile_pair(LEFT, RIGHT, tests, distinct=True) is None


def test_the_generated_code_can_be_read() -> None:
    source = kernel_of(f"{APART} {LEFT_OF}").source
    assert source.startswith("# pairs of ?a and ?b\n#   (<= (+ (* 2 ?xa) ?wa) (- (* 2 ?xb) ?wb))")
    assert "derived[0][slot] = ((2 * xa) + wa)" in source
    assert "term_1" in kernel_of(NEAR).source
    assert "right_" not in kernel_of(DISTANT).source.split("def right_rows")[0]


def test_a_variable_may_have_any_name() -> None:
    names = ["?slot", "?np", "?1st", "?x-y", "?part_1", "?class", "?xs", "?x"]
    left = PairSide("?a", tuple(zip(names[:4], ATTRIBUTES, strict=True)))
    right = PairSide("?b", tuple(zip(names[4:], ATTRIBUTES, strict=True)))
    (test,) = calls_of("(< (+ ?xa ?ya ?za ?wa) (* ?xb ?yb) (+ ?zb ?wb 9))")
    spelled = dict(zip([f"?{n}{s}" for s in "ab" for n in ATTRIBUTES], names, strict=True))
    kernel = compile_pair(left, right, (renamed(test, spelled),), distinct=False)
    assert kernel is not None
    columns = scene(12)
    relation = kernel.instance(columns, columns)
    relation.load()
    assert set(relation.pairs()) == pairs_of(
        columns, lambda a, b: sum(a) < b[0] * b[1] < b[2] + b[3] + 9, itself=True
    )


def renamed(test: Call, names: dict[str, str]) -> Call:
    args = []
    for each in test.args:
        if isinstance(each, Call):
            args.append(renamed(each, names))
        else:
            name = getattr(each, "name", None)
            args.append(each if name is None else replace(each, name=names[name]))
    return replace(test, args=tuple(args))


# What goes wrong.


@pytest.mark.parametrize("way", ["list", "strip", "block", "sweep"])
def test_an_error_names_the_place_and_leaves_the_relation_as_it_was(way: str) -> None:
    text = f"{APART} (< (abs (- ?ya ?yb)) 300) (< (/ ?wa (- ?xa ?xb)) 2)"
    columns = Columns(ATTRIBUTES)
    for number in range(30):
        columns.put(f"o{number}", (number * 10, number * 40, 0, 50))
    relation = kernel_of(text).only_by(way).instance(columns, columns)
    relation.load()
    before = list(relation.pairs())
    moved = [columns.put("o3", (50, 120, 0, 50)), columns.put("o9", (95, 0, 0, 50))]
    with pytest.raises(InferenceError, match=r"^scene\.icr:5:\d+: division by zero in \(/ 50 0\)$"):
        relation.update(moved, moved)
    assert list(relation.pairs()) == before
    columns.put("o3", (30, 120, 0, 50))
    columns.put("o9", (90, 360, 0, 50))
    assert relation.update(moved, moved) == ([], [])
    assert list(relation.pairs()) == before


def test_a_symbol_where_a_number_is_wanted_is_an_error_only_if_there_is_a_pair() -> None:
    relation_text = f"{APART} {LEFT_OF}"
    columns = Columns(ATTRIBUTES)
    relation = kernel_of(relation_text).instance(columns, columns)
    alone = [columns.put("o1", ("peg", 0, 0, 50))]
    assert relation.update(alone, alone) == ([], [])
    both = [*alone, columns.put("o2", (7, 0, 0, 50))]
    with pytest.raises(InferenceError, match=r"^scene\.icr:5:\d+: \?xa is the symbol peg"):
        relation.update(both, both)


def test_an_object_without_an_attribute_is_absent() -> None:
    columns = Columns(ATTRIBUTES)
    relation = kernel_of(LEFT_OF).instance(columns, columns)
    slots = [columns.put("o1", (0, None, None, 10)), columns.put("o2", (50, 0, 0, 10))]
    assert relation.update(slots, slots) == ([], [])
    columns.put("o1", (0, 0, 0, 10))
    assert relation.update([0], [0]) == ([(0, 1)], [])


@pytest.mark.parametrize("way", ["list", "block", "sweep"])
def test_integers_beyond_every_float_are_compared_as_they_are(way: str) -> None:
    columns = Columns(ATTRIBUTES)
    relation = kernel_of("(< ?xa ?xb)").only_by(way).instance(columns, columns)
    for number in range(6):
        columns.put(f"o{number}", (2**53 + number, 0, 0, 0))
    columns.put("huge", (10**400, 0, 0, 0))
    slots = list(range(6))
    columns.drop("huge")
    relation.update([*slots, 6], [*slots, 6])
    assert set(relation.pairs()) == {(i, j) for i in slots for j in slots if i < j}


def test_half_a_million_pairs_take_no_room() -> None:
    columns = Columns(ATTRIBUTES)
    for number in range(1000):
        columns.put(f"o{number}", (10 * number, 0, 0, 10))
    order = kernel_of(f"{APART} {LEFT_OF}").instance(columns, columns)
    order.load()
    assert len(order) == 499_500
    assert order.holds(3, 4)
    assert not order.holds(4, 4)
    matrix = kernel_of("(< ?xa ?xb) (<= ?ya ?yb)").instance(columns, columns)
    assert isinstance(matrix, MatrixRelation)
    matrix.load()
    assert len(matrix) == 499_500
    assert len(matrix.bits) <= 1_100_000
