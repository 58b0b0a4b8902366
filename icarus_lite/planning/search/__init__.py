"""Search on a problem without variables: a plan soon, then a shorter one."""

from __future__ import annotations

from icarus_lite._on_use import imported_on_use

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.planning.search.improvement import improve
    from icarus_lite.planning.search.result import Effort, Limits, Progress, SearchResult
    from icarus_lite.planning.search.searching import search

_HOMES = {
    "Effort": "result",
    "Limits": "result",
    "Progress": "result",
    "SearchResult": "result",
    "improve": "improvement",
    "search": "searching",
}

__all__ = ["Effort", "Limits", "Progress", "SearchResult", "improve", "search"]

__getattr__ = imported_on_use(__name__, _HOMES)
