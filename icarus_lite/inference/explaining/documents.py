"""Answers as plain data, for `--json` and for whoever shows them in another form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

from icarus_lite.inference.explaining.chronicle import Period
from icarus_lite.inference.explaining.conjunctions import Attempt
from icarus_lite.inference.explaining.reasons import (
    Blocked,
    FailedTest,
    Missing,
    Reason,
    in_full,
)
from icarus_lite.inference.explaining.why_not import ClauseVerdict, WhyNot

Document: TypeAlias = dict[str, object]
"""What `json.dumps` takes."""


def why_not_document(answer: WhyNot) -> Document:
    """Give the answer of `why_not` as plain data; what there is nothing to say of is left out."""
    return _filled(
        asked=str(answer.asked),
        cycle=answer.cycle,
        kind="skill" if answer.is_skill else "belief",
        holds=answer.holds,
        instances=[str(each) for each in answer.instances],
        impossible=list(answer.impossible),
        absent=list(answer.absent),
        reason=None if answer.reason is None else _reason(answer.reason),
        clauses=[_clause(each) for each in answer.clauses],
        sources=[
            {
                "action": str(each.action),
                "lines": [span.line for span in each.spans],
                "asserts": each.asserts,
            }
            for each in answer.sources
        ],
        past=[
            _filled(
                belief=str(each.belief),
                periods=[period_document(period) for period in each.periods],
                ended=each.ended or None,
            )
            for each in answer.past
        ],
        refused=[
            {"belief": str(each.withdrawal.belief), "cycle": each.cycle}
            | {"because": list(each.withdrawal.because)}
            for each in answer.refused
        ],
        reports=[
            _filled(
                cycle=each.cycle,
                action=str(each.outcome.action),
                status=str(each.outcome.status),
                reason=each.outcome.reason or None,
            )
            for each in answer.reports
        ],
    )


def period_document(period: Period) -> list[int | None]:
    """Give the first and the last cycle of a period; None for one that lasts."""
    return [period.first, period.last]


def _clause(verdict: ClauseVerdict) -> Document:
    readiness = verdict.readiness
    document = _filled(
        head=str(verdict.head),
        line=verdict.clause.span.line,
        file=verdict.clause.span.path or None,
        fits=verdict.fits,
        holds=verdict.holds,
        conditions=None if verdict.attempt is None else _conditions(verdict.attempt),
        complete=None if verdict.attempt is None else verdict.attempt.complete,
        reason=None if verdict.reason is None else _reason(verdict.reason),
        deeper=None if verdict.deeper is None else why_not_document(verdict.deeper),
    )
    if readiness is not None:
        broken = None if readiness.broken is None else _reason(readiness.broken)
        document |= _filled(
            broken=broken,
            believed_effects=[str(each) for each in readiness.believed],
            outstanding_effects=[str(each) for each in readiness.outstanding],
        )
    return document


def _conditions(attempt: Attempt) -> list[Document]:
    return [
        _filled(
            condition=str(each.condition),
            bound=str(each.bound),
            standing=str(each.standing),
            fact=None if each.fact is None else in_full(each.fact),
        )
        for each in attempt.checked
    ]


def _reason(reason: Reason) -> Document:
    document: Document = {"kind": _KINDS.get(type(reason), "unasked"), "text": str(reason)}
    match reason:
        case Missing():
            document |= _filled(
                pattern=str(reason.pattern),
                differences=[
                    {"attribute": d.attribute, "wanted": d.wanted, "found": d.found}
                    for d in reason.differences
                ],
                nearest=[in_full(each) for each in reason.nearest],
                remark=reason.remark or None,
            )
        case FailedTest():
            document |= _filled(test=str(reason.test), sides=list(reason.sides))
        case Blocked():
            document["blockers"] = [
                {"belief": str(each.belief), "because": each.because} for each in reason.blockers
            ]
            document["more"] = reason.more
        case _:
            document["condition"] = str(reason.condition)
    return document


_KINDS: Mapping[type, str] = {Missing: "missing", FailedTest: "failed-test", Blocked: "blocked"}


def _filled(**entries: object) -> Document:
    """Give the entries that say something: neither None nor an empty list."""
    return {key: value for key, value in entries.items() if value is not None and value != []}
