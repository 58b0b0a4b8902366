"""Domain tests: the `(test …)` forms of a domain file, run and reported on.

The pytest plug-in lives here as well. pytest imports this package at every start, so what it
offers is imported only when it is asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from icarus_lite.testing.outcome import CaseOutcome, Difference, Kind
    from icarus_lite.testing.report import describe, summary, to_json
    from icarus_lite.testing.runner import run_test, run_tests

_HOMES = {
    "CaseOutcome": "outcome",
    "Difference": "outcome",
    "Kind": "outcome",
    "describe": "report",
    "run_test": "runner",
    "run_tests": "runner",
    "summary": "report",
    "to_json": "report",
}

__all__ = [
    "CaseOutcome",
    "Difference",
    "Kind",
    "describe",
    "run_test",
    "run_tests",
    "summary",
    "to_json",
]


def __getattr__(name: str) -> object:
    """Import a public name from its module when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
