from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import pytest

from runtime.checked_yaml import Limit, check, load, read
from runtime.errors import ConfigError


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    height_m: Annotated[float, Limit(0.1, 1.2, "m")]
    legs: Annotated[int, Limit(3, 8, "")] = 4

    def __post_init__(self) -> None:
        check(self, "table")


@dataclass(frozen=True, slots=True, kw_only=True)
class Room:
    table: Table


def test_keys_become_fields():
    assert read(Room, {"table": {"height_m": 0.7}}) == Room(table=Table(height_m=0.7))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("table:\n  legs: 4\n", ":1: table.height_m: missing"),
        ("table:\n  height_m: 0.7\n  legs: 2\n", ":3: table.legs: 2; expected a whole number"),
        (
            "# mm\ntable:\n  height_m: 720\n",
            ":3: table.height_m: 720; expected a number from 0.1 to 1.2 m; did you mean 0.72 m",
        ),
        ("table:\n  heigth_m: 0.7\n", ":2: table.heigth_m: unknown key; did you mean 'height_m'?"),
        ("table: [1, 2\n", ":2: cannot be read as YAML"),
        ("- 1\n", ": the file: expected keys with values, got [1]"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(tmp_path, text, message):
    file = tmp_path / "room.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ConfigError) as caught:
        load(Room, file)
    assert str(caught.value).startswith(f"{file}{message}")


@pytest.mark.parametrize("value", [1.5, 5.0, float("nan"), True, "0.7"])
def test_a_number_that_is_merely_too_great_is_not_taken_for_another_unit(value):
    with pytest.raises(ConfigError) as caught:
        Table(height_m=value)
    assert "did you mean" not in str(caught.value)
