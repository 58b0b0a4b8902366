"""How a run ended, and whether the reason that it gives is the true one."""

from __future__ import annotations

import re
from collections.abc import Sequence

from gearbox.rows import Ending


def ending(
    *,
    achieved: bool,
    true: bool,
    troubled: bool,
    reason: str,
    reasons: Sequence[str],
) -> Ending:
    """Say how a run ended.

    Args:
        achieved: Whether the run said that its goal was reached.
        true: Whether it really was.
        troubled: Whether anything went wrong on the way: an action failed, a belief was withdrawn.
        reason: What the run gave as the reason of its end.
        reasons: Patterns of the reasons that are true of what went wrong.
    """
    if achieved and not true:
        return Ending.FALSE
    if achieved:
        return Ending.RECOVERED if troubled else Ending.ACHIEVED
    if not is_true_reason(reason, reasons):
        return Ending.UNAWARE if true else Ending.MISNAMED
    return Ending.FAILED


def is_true_reason(reason: str, reasons: Sequence[str]) -> bool:
    """Tell whether a reason is one of those that are true."""
    return any(re.search(pattern, reason) for pattern in reasons)
