"""Stacked code gives what the statements give that it was made of, by fewer calls."""

from __future__ import annotations

import random
import re
from collections.abc import Sequence

import numpy as np
import pytest

from icarus_lite.inference.network.kernels.array_source import NotVectorizableError
from icarus_lite.inference.network.kernels.stacking import Stacked, Stacking

PLANES = {"a": 0, "b": 0, "c": 0, "d": 1, "e": 1}
LENGTHS = (7, 4)
NUMBERS = {"2.0": "number_1", "30.0": "number_2"}
Value = np.ndarray


def run(stacked: Stacked, given: dict[str, Value], constants: dict[str, str]) -> list[list[Value]]:
    """Run stacked code twice over rows of its own, as what is left behind must not matter."""
    space: dict[str, object] = {"np": np}
    space |= {name: np.array(float(text)) for text, name in constants.items()}
    exec("\n".join(stacked.lines), space)
    stores = []
    for store in stacked.stores:
        bounds = np.cumsum([0, *(LENGTHS[plane] for plane in store.planes)])
        row = np.zeros(bounds[-1], dtype=bool if store.truths else float)
        if store.inputs:
            row[:] = np.concatenate([given[name] for name in store.inputs])
        stores.append((row, bounds))
    rows = [stores[n][0][stores[n][1][i] : stores[n][1][j]] for n, i, j in stacked.rows]
    flat = space["flat_over"](rows)  # type: ignore[operator] # the function just defined
    first = [[each.copy() for each in parts if each is not None] for parts in flat()]
    again = flat()
    for one, other in zip(first, again, strict=True):
        for before, after in zip(one, (each for each in other if each is not None), strict=True):
            assert np.array_equal(before, after)
    return first


def plainly(
    statements: Sequence[str], results: Sequence[Sequence[str]], given: dict[str, Value]
) -> list[list[Value]]:
    space: dict[str, object] = {"np": np, **given}
    space |= {name: float(text) for text, name in NUMBERS.items()}
    exec("\n".join(statements), space)
    return [[np.asarray(space[name]) for name in parts if name != "None"] for parts in results]


def drawn(rng: random.Random) -> tuple[list[str], list[tuple[str, str]]]:
    """Draw statements over the rows of one plane after the other, and what they give."""
    statements: list[str] = []
    results = []
    for plane in (0, 1):
        numbers = [name for name, own in PLANES.items() if own == plane]
        truths: list[str] = []

        def number(known: Sequence[str] = numbers) -> str:
            return rng.choice([*known, *known, "number_1", "number_2", "-3.5"])

        for count in range(rng.randrange(3, 12)):
            one, other = rng.choice(numbers), number()
            kind = rng.random()
            name = f"part_{count}_{plane}"
            if kind < 0.6:
                call = rng.choice(
                    [
                        f"({one} {rng.choice('+-*')} {other})",
                        f"np.abs({one} - {other})",
                        f"np.maximum({other}, {one})",
                        f"(-{one})",
                        f"({one} * {one}) + (np.sqrt(np.abs({one})) / 7.0)",
                    ]
                )
                numbers.append(name)
            else:
                call = f"{one} {rng.choice(['<', '<=', '>', '>=', '==', '!='])} {other}"
                if truths and kind > 0.8:
                    call = f"{rng.choice(truths)} {rng.choice('&|')} ~({call})"
                truths.append(name)
            statements.append(f"{name} = {call}")
        statements.append(f"hold_{plane} = {numbers[-1]} < {numbers[0]}")
        results.append((f"hold_{plane}", rng.choice([*truths, "None"])))
    return statements, results


@pytest.mark.parametrize("seed", range(150))
def test_it_gives_what_the_statements_give(seed: int) -> None:
    rng = random.Random(seed)
    statements, results = drawn(rng)
    constants = dict(NUMBERS)
    stacked = Stacking(PLANES, constants).write(statements, results)
    given = {
        name: np.array([float(rng.randrange(-9, 40)) for _ in range(LENGTHS[plane])])
        for name, plane in PLANES.items()
    }
    found = run(stacked, given, constants)
    wanted = plainly(statements, results, given)
    for one, other in zip(found, wanted, strict=True):
        for got, right in zip(one, other, strict=True):
            assert got.tolist() == right.tolist()


def calls(stacked: Stacked) -> list[str]:
    """Give the functions that are called, in their order."""
    text = "\n".join(line for line in stacked.lines if "#" not in line)
    return re.findall(r"(\w+)\((?:row|number)_", text)


def test_operations_that_are_alike_become_one_call() -> None:
    statements = [
        "x = a - b",
        "y = a - c",
        "u = d - e",
        "far = np.abs(x) < c",
        "hold = far & ((x * x) + (y * y) < number_2)",
        "near = u * u < number_1",
    ]
    stacked = Stacking(PLANES, dict(NUMBERS)).write(
        statements, [("hold", "None"), ("near", "None")]
    )
    functions = calls(stacked)
    assert functions.count("subtract") == 1  # x, y and u, over both planes
    assert functions.count("multiply") == 1  # their squares
    assert len(functions) == 8


def test_each_result_is_new_each_time() -> None:
    constants = dict(NUMBERS)
    stacked = Stacking(PLANES, constants).write(["hold = a < b"], [("hold", "None")])
    space: dict[str, object] = {"np": np}
    exec("\n".join(stacked.lines), space)
    flat = space["flat_over"]([np.zeros(7), np.ones(7)])  # type: ignore[operator] # as above
    assert flat()[0][0] is not flat()[0][0]
    assert flat()[0][1] is None


@pytest.mark.parametrize(
    "statement", ["hold = number_1 < number_2", "hold = np.hypot(a, b) < c", "hold, more = a, b"]
)
def test_what_is_no_operation_on_rows_is_refused(statement: str) -> None:
    with pytest.raises(NotVectorizableError):
        Stacking(PLANES, dict(NUMBERS)).write([statement], [("hold", "None")])
