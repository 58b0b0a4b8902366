"""Words for messages."""

from __future__ import annotations

import pytest

from icarus_lite.language.wording import LONGEST_WORD, closest, listing


@pytest.mark.parametrize(
    ("word", "candidates", "meant"),
    [
        ("elemnts", ["elements", "effects", "tests"], "elements"),
        ("Holding", ["hold", "holding"], "holding"),
        ("HOLD", ["holding", "hold"], "hold"),
        ("xyz", ["elements", "effects"], None),
        ("on", [], None),
        ("a", ["abcdefghij"], None),
        ("h" * (LONGEST_WORD + 1), ["h" * LONGEST_WORD], None),
    ],
)
def test_the_name_that_was_probably_meant(
    word: str, candidates: list[str], meant: str | None
) -> None:
    assert closest(word, candidates) == meant
    assert closest(word, iter(candidates)) == meant


@pytest.mark.parametrize(
    ("words", "shown"),
    [
        (["a"], "a"),
        (["a", "b"], "a and b"),
        (["a", "b", "c"], "a, b and c"),
    ],
)
def test_names_in_a_row(words: list[str], shown: str) -> None:
    assert listing(words) == shown
    assert listing(iter(words), "or") == shown.replace(" and ", " or ")


def test_a_long_row_is_cut_off() -> None:
    shown = listing(f"n{number}" for number in range(1_000))
    assert shown.endswith("n18 and so on")
    assert listing(str(number) for number in range(20)).endswith("18 and 19")
