"""Breakpoints that a domain declares: the form `(break …)`, and the field `:break` of a clause."""

from __future__ import annotations

from collections.abc import Container, Iterable

from icarus_lite.language.breakpoint import Breakpoint, Moment
from icarus_lite.language.checking.report import Report
from icarus_lite.language.keywords import MOMENTS
from icarus_lite.language.reading.parts import Clause, Word
from icarus_lite.language.syntax import Condition
from icarus_lite.language.wording import listing
from icarus_lite.records import replace


def breakpoints_of_clause(
    form: str, clause: Clause, words: Iterable[Word], report: Report
) -> list[Breakpoint]:
    """Give the breakpoints that the `:break` of a clause sets at its head.

    Args:
        form: `concepts` or `skills`.
        clause: The clause.
        words: What its `:break` says.
        report: Takes what is wrong with them.
    """
    known = MOMENTS[form]
    found = []
    for word in words:
        if word.text in known:
            head = Condition(clause.head, span=clause.head.span)
            found.append(Breakpoint(head, Moment(word.text), word.span))
            continue
        meant = report.closest(word.text, known)
        owner = form.removesuffix("s")
        hint = f"the moments of a {owner} are {listing(known)}"
        hint = f"did you mean `{meant}`? {hint}" if meant else hint
        message = f"`{word.text}` is no moment at which to stop at a {owner}"
        report.error(word.span, "ICR046", message, hint)
    return found


def timed(stop: Breakpoint, skills: Container[str]) -> Breakpoint:
    """Give a breakpoint at the start of its skill, where that is what a form names.

    Args:
        stop: A breakpoint as it was read.
        skills: The names of the domain's skills.
    """
    is_from_form = stop.span == stop.condition.span
    is_skill = stop.condition.atom.predicate in skills and not stop.condition.negated
    return replace(stop, moment=Moment.START) if is_from_form and is_skill else stop
