from __future__ import annotations

import math

import pytest

from icarus_lite.inference import Evaluator
from icarus_lite.inference.explaining.margins import margin_of
from icarus_lite.language import parse_domain

SLOTS = {"?x": 0, "?y": 1}


def margin(test: str, *row: float | str | None) -> float | None:
    domain, problems = parse_domain(
        f"(percepts (o ^x ^y)) (concepts ((p ?a) :elements ((o ?a ^x ?x ^y ?y)) :tests ({test})))"
    )
    assert domain is not None, problems
    found = margin_of(domain.concepts[0].tests[0], SLOTS, Evaluator())
    return None if found is None else found(row)


@pytest.mark.parametrize(
    ("test", "row", "expected"),
    [
        ("(< ?x ?y)", (5, 2), 3),
        ("(<= ?x ?y)", (2, 5), 0),
        ("(> ?x ?y)", (2, 5), 3),
        ("(= ?x ?y)", (2, 5), 3),
        ("(= ?x ?y)", (5, 2), 3),
        ("(< ?x ?y 1)", (1, 4), 3),
        ("(< (* 2 ?x) ?y)", (5, 2), 8),
        ("(= ?x ?y)", ("a", "b"), math.inf),
        ("(< ?x ?y)", (None, 3), math.inf),
        ("(< (/ 1 ?x) ?y)", (0, 3), math.inf),
    ],
)
def test_how_far_a_test_is_from_holding(
    test: str, row: tuple[float | str | None, ...], expected: float
) -> None:
    assert margin(test, *row) == expected


@pytest.mark.parametrize("test", ["(/= ?x ?y)", "(and (< ?x ?y) (< ?x 2))", "(not (< ?x ?y))"])
def test_what_is_no_comparison_has_no_margin(test: str) -> None:
    assert margin(test, 1, 2) is None
