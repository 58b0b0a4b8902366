"""Fields that hold a single value: a number, a yes or no. What makes no sense is reported."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.language.checking.report import Report
from icarus_lite.language.reading.parts import Word
from icarus_lite.language.syntax import Constant, Term, Variable


def seconds(given: Sequence[Constant], report: Report) -> float | None:
    """Read a `:timeout`, in s; None if it is not given."""
    if not given:
        return None
    value = given[0].value
    if isinstance(value, str) or value <= 0:
        report.error(
            given[0].span,
            "ICR010",
            f"a timeout of {given[0]} s never lets the skill run",
            "give the seconds after which it has failed, such as :timeout 20",
        )
        return 0.0
    return float(value)


def cost(given: Sequence[Constant], report: Report) -> int | None:
    """Read a `:cost`; None if it is not given."""
    if not given:
        return None
    value = given[0].value
    if isinstance(value, int) and value > 0:
        return value
    message = f"a cost of {given[0]} cannot be counted with"
    hint = "give a whole number from 1 up: a skill of one's own counts as 1"
    report.error(given[0].span, "ICR010", message, hint)
    return None


def cycles(given: Sequence[Constant], report: Report) -> int:
    """Read a `:cycles`, a number of cycles in a row; 1 if it is not given."""
    if not given:
        return 1
    value = given[0].value
    if isinstance(value, int) and value > 0:
        return value
    message = f"conditions cannot hold for {given[0]} cycles in a row"
    hint = "give a whole number from 1 up, such as :cycles 5"
    report.error(given[0].span, "ICR010", message, hint)
    return 1


def priority(given: Term | None) -> float | Variable:
    """Read a `:priority`: a number, or a variable that the relevance binds to one."""
    if isinstance(given, Variable):
        return given
    return 0.0 if given is None else float(given.value)


def choice(keyword: str, given: Sequence[Word], report: Report, *, default: bool) -> bool:
    """Read `yes` or `no`.

    Args:
        keyword: The field.
        given: Its words: one, or none if the field is not given.
        report: Where another word is reported.
        default: What it means to leave the field out.
    """
    if not given:
        return default
    word = given[0]
    if word.text not in ("yes", "no"):
        message = f"`{keyword}` takes yes or no, not `{word.text}`"
        hint = f"write {keyword} {'no' if default else 'yes'}, or leave it out"
        if keyword == ":request":
            message = f"`{keyword}` takes a string or no, not `{word.text}`"
            hint = 'write what the agent is to be told, "please hold ?base"; no if it needs no word'
        report.error(word.span, "ICR009", message, hint)
    return word.text == "yes"
