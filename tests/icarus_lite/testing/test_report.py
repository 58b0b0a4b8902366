"""Outcomes as text and as JSON."""

from __future__ import annotations

import json

import icarus_lite.testing
from icarus_lite.language import parse_domain
from icarus_lite.testing import run_tests, summary, to_json

TEXT = """(percepts (o))
(test "good" :percepts ((o a)) :expect ((o a)))
(test "bad" :percepts ((o a)) :expect ((o b)))
"""


def outcomes():
    domain, problems = parse_domain(TEXT, "d.icr")
    assert domain is not None, problems
    return run_tests(domain)


def test_the_summary_counts() -> None:
    good, bad = outcomes()
    assert summary([]) == "no tests"
    assert summary([good]) == "1 test, it holds"
    assert summary([good, good]) == "2 tests, all hold"
    assert summary([good, bad]) == "2 tests, 1 of them fails"
    assert summary([bad, bad]) == "2 tests, 2 of them fail"


def test_json_has_all_that_the_text_has() -> None:
    good, bad = map(to_json, outcomes())
    assert good == {
        "file": "d.icr",
        "line": 2,
        "name": "good",
        "passed": True,
        "differences": [],
        "notes": [],
    }
    assert json.loads(json.dumps(bad))["differences"] == [
        {
            "file": "d.icr",
            "kind": "missing",
            "cycle": 0,
            "line": 3,
            "column": 40,
            "stated": "(o b)",
            "message": "it is not believed",
            "details": ["nearest: (o a)"],
        }
    ]


def test_all_public_names_can_be_imported() -> None:
    for name in icarus_lite.testing.__all__:
        assert getattr(icarus_lite.testing, name) is not None
    assert not hasattr(icarus_lite.testing, "nothing_of_this_name")
