from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.inference.network.kernels import Columns
from icarus_lite.inference.network.kernels.columns import PLAIN, first_of_run, is_plain


def table(*rows: tuple[str, float, float]) -> Columns:
    columns = Columns(("x", "y"))
    for name, *values in rows:
        columns.put(name, values)
    return columns


def move(columns: Columns, slots: list[int], moved: dict[str, np.ndarray]) -> None:
    """Set some attributes of objects, as a table does."""
    for attribute, values in moved.items():
        given = tuple(values.tolist())
        plain = all(map(is_plain, given))
        place = columns.places[attribute]
        columns.assign(slots, [(place, given)], first_of_run(slots), plain=plain)
    columns.judge(slots)


def test_an_object_keeps_its_slot_and_its_values_are_those_put_last() -> None:
    columns = table(("a", 1, 2.5), ("b", 3, 4))
    assert columns.put("a", (7, 8)) == columns.slot("a") == 0
    assert columns.column("x") == [7, 3]
    assert columns.array("y").tolist() == [8.0, 4.0]


def test_the_lists_hold_values_as_they_were_given() -> None:
    columns = table(("a", 1, 1.0))
    assert [type(columns.column(name)[0]) for name in ("x", "y")] == [int, float]


def test_a_dropped_object_keeps_its_slot_until_settled() -> None:
    columns = table(("a", 1, 2), ("b", 3, 4))
    assert columns.drop("a") == 0
    assert columns.alive == b"\x00\x01"
    assert columns.has_holes
    assert columns.put("c", (5, 6)) == 2
    assert columns.names == ["a", "b", "c"]
    columns.settle()
    assert columns.put("d", (7, 8)) == 0
    assert columns.names == ["d", "b", "c"]
    assert not columns.has_holes


def test_an_object_that_returns_before_that_is_back_where_it_was() -> None:
    columns = table(("a", 1, 2), ("b", 3, 4))
    columns.drop("a")
    assert columns.put("a", (5, 6)) == 0
    columns.settle()
    assert columns.put("c", (0, 0)) == 2


def test_an_unknown_object_has_no_slot() -> None:
    columns = table(("a", 1, 2))
    with pytest.raises(KeyError):
        columns.slot("b")
    with pytest.raises(KeyError):
        columns.drop("b")


@pytest.mark.parametrize(
    "value", ["peg", None, True, 2 * PLAIN, -2 * PLAIN, 2**80, float("inf"), float("nan")]
)
def test_what_no_kernel_may_take_as_it_is_is_unusual(value: object) -> None:
    columns = table(("a", 1, 2), ("b", 3, 4))
    columns.put("a", (value, 2))  # type: ignore[arg-type]
    assert columns.unusual == {0}
    assert columns.array("y").tolist() == [2.0, 4.0]
    columns.put("a", (5, 6))
    assert columns.unusual == set()
    assert columns.array("x").tolist() == [5.0, 3.0]


def test_large_numbers_that_add_up_are_usual_one_by_one() -> None:
    columns = table(("a", PLAIN, -PLAIN))
    assert columns.unusual == set()


def test_arrays_may_be_handed_over_for_many_objects() -> None:
    columns = table(*((f"o{n}", n, 0) for n in range(40)))
    slots = list(range(5, 30))
    move(columns, slots, {"x": np.arange(25), "y": np.linspace(0, 1, 25)})
    assert columns.column("x")[4:8] == [4, 0, 1, 2]
    assert type(columns.column("x")[5]) is int
    assert columns.column("y")[29] == columns.array("y")[29] == 1.0
    move(columns, [9, 3], {"x": np.array([1.5, 2.5])})
    assert (columns.column("x")[9], columns.column("x")[3]) == (1.5, 2.5)
    assert columns.array("x")[[9, 3]].tolist() == [1.5, 2.5]


def test_an_array_with_a_value_too_large_makes_its_object_unusual() -> None:
    columns = table(("a", 1, 2), ("b", 3, 4), ("c", 5, 6))
    move(columns, [0, 2], {"x": np.array([2**60, 7])})
    assert columns.unusual == {0}
    assert columns.column("x") == [2**60, 3, 7]
    assert columns.array("x").tolist() == [0.0, 3.0, 7.0]
    move(columns, [0], {"x": np.array([1])})
    assert columns.unusual == set()
    assert columns.array("x").tolist() == [1.0, 3.0, 7.0]


def test_a_copy_goes_its_own_way() -> None:
    columns = table(("a", 1, 2), ("b", 3, 4))
    columns.drop("b")
    other = columns.copy()
    columns.put("a", (9, 9))
    assert other.column("x")[0] == 1
    assert other.array("x").tolist() == [1.0, 3.0]
    assert other.put("b", (0, 0)) == 1
    assert "b" not in columns.slots


_STEPS = st.lists(
    st.one_of(
        st.tuples(
            st.just("put"), st.integers(0, 5), st.floats(-9, 9), st.integers(-(2**70), 2**70)
        ),
        st.tuples(st.just("drop"), st.integers(0, 5)),
        st.tuples(st.just("move"), st.integers(0, 5), st.floats(-9, 9)),
        st.tuples(st.just("settle")),
        st.tuples(st.just("look")),
    ),
    max_size=30,
)


@settings(max_examples=60, deadline=None)
@given(_STEPS)
def test_lists_and_arrays_say_the_same_whatever_happens(steps: list[tuple]) -> None:
    columns = Columns(("x", "y"))
    model: dict[str, list[float]] = {}
    for word, *rest in steps:
        name = f"o{rest[0]}" if rest else ""
        if word == "put":
            columns.put(name, rest[1:])
            model[name] = rest[1:]
        elif word == "drop" and name in model:
            columns.drop(name)
            del model[name]
        elif word == "move" and name in model:
            move(columns, [columns.slot(name)], {"x": np.array([rest[1]])})
            model[name][0] = rest[1]
        elif word == "settle":
            columns.settle()
        elif word == "look":
            columns.array("x")
    assert set(columns.slots) == set(model)
    for name, values in model.items():
        slot = columns.slot(name)
        assert columns.names[slot] == name
        assert [columns.column(each)[slot] for each in "xy"] == values
        assert (slot in columns.unusual) is not all(map(is_plain, values))
        for each, value in zip("xy", values, strict=True):
            known = float(value) if is_plain(value, 2.0**53) else 0.0
            assert columns.array(each)[slot] == known
    assert sum(columns.alive) == len(model)
