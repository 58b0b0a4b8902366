"""Explaining: why a belief is not held, why a skill cannot start, and what was held before."""

from icarus_lite.inference.explaining.attempts import nearest_attempt
from icarus_lite.inference.explaining.chronicle import Chronicle, Period, what_ended
from icarus_lite.inference.explaining.conjunctions import Attempt, Checked, Standing
from icarus_lite.inference.explaining.context import Context
from icarus_lite.inference.explaining.documents import why_not_document
from icarus_lite.inference.explaining.reasons import (
    Blocked,
    Blocker,
    Difference,
    FailedTest,
    Missing,
    Reason,
    Unasked,
)
from icarus_lite.inference.explaining.skills import Readiness
from icarus_lite.inference.explaining.sources import Source
from icarus_lite.inference.explaining.why_not import ClauseVerdict, Past, Report, WhyNot, why_not

__all__ = [
    "Attempt",
    "Blocked",
    "Blocker",
    "Checked",
    "Chronicle",
    "ClauseVerdict",
    "Context",
    "Difference",
    "FailedTest",
    "Missing",
    "Past",
    "Period",
    "Readiness",
    "Reason",
    "Report",
    "Source",
    "Standing",
    "Unasked",
    "WhyNot",
    "nearest_attempt",
    "what_ended",
    "why_not",
    "why_not_document",
]
