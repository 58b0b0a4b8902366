"""The outcomes of domain tests, as text for a person and as JSON for a program."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from icarus_lite.testing.outcome import CaseOutcome, Difference, Kind

_STATES = {
    Kind.MISSING: ":expect",
    Kind.UNEXPECTED: ":expect-not",
    Kind.PLAN: ":goal",
    Kind.ERROR: "the test",
}


def describe(outcome: CaseOutcome) -> str:
    """Say what is not as a test states it, each thing with its place and what may explain it."""
    return "\n".join(_lines(outcome))


def summary(outcomes: Sequence[CaseOutcome]) -> str:
    """Count the tests that hold and those that do not."""
    failed = sum(not outcome.passed for outcome in outcomes)
    count = f"{len(outcomes)} test{'s' * (len(outcomes) != 1)}"
    if not outcomes:
        return "no tests"
    if not failed:
        return f"{count}, all hold" if len(outcomes) > 1 else f"{count}, it holds"
    return f"{count}, {failed} of them fail{'s' * (failed == 1)}"


def to_json(outcome: CaseOutcome) -> dict[str, object]:
    """Give the object that `icarus test --json` lists for a test."""
    return {
        "file": outcome.test.span.path or outcome.path,
        "line": outcome.test.span.line,
        "name": outcome.test.name,
        "passed": outcome.passed,
        "differences": [_difference_json(each, outcome.path) for each in outcome.differences],
        "notes": list(outcome.notes),
    }


def _difference_json(difference: Difference, path: str) -> dict[str, object]:
    return {
        "file": difference.span.path or path,
        "kind": difference.kind.value,
        "cycle": difference.cycle,
        "line": difference.span.line,
        "column": difference.span.column,
        "stated": difference.stated,
        "message": difference.message,
        "details": list(difference.details),
    }


def _lines(outcome: CaseOutcome) -> Iterator[str]:
    cycles = len(outcome.test.then) + 1
    for difference in outcome.differences:
        span = difference.span
        place = f"{span.path or outcome.path}:{span.line}:{span.column}"
        when = f" in cycle {difference.cycle} of the test" if cycles > 1 else ""
        yield f"{place}: {_STATES[difference.kind]} {difference.stated}{when}"
        yield f"    {difference.message}"
        yield from (f"      {detail}" for detail in difference.details)
    for note in outcome.notes:
        yield f"    note: {note}"
