"""What came of a domain test: it held, or where it differs from what it states."""

from __future__ import annotations

from enum import StrEnum

from icarus_lite.language.syntax import DomainTest, Span
from icarus_lite.records import dataclass


class Kind(StrEnum):
    """How a test can fail."""

    MISSING = "missing"  # an `:expect` that nothing believed matches
    UNEXPECTED = "unexpected"  # an `:expect-not` that something believed matches
    PLAN = "plan"  # no plan for the `:goal`, or another one than the `:plan`
    ERROR = "error"  # the domain could not be run on these percepts at all


@dataclass(frozen=True, slots=True)
class Difference:
    """One thing that is not as a test states it.

    Args:
        kind: What sort of thing.
        cycle: The cycle of the test, from 0.
        stated: What the test states, as text.
        message: What is the case instead, in one sentence without a full stop.
        details: Lines that help to find out why; indented ones belong to the line above.
        span: Where the test states it.
    """

    kind: Kind
    cycle: int
    stated: str
    message: str
    details: tuple[str, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class CaseOutcome:
    """What came of one test.

    Args:
        test: The test.
        path: The domain file, as it was named.
        differences: All that is not as stated; empty if the test holds.
        notes: What the engine had to say meanwhile, such as an attachment refused as circular.
    """

    test: DomainTest
    path: str
    differences: tuple[Difference, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether everything is as the test states it."""
        return not self.differences
