"""Search on a problem without variables: a plan soon, then a shorter one."""

from icarus_lite.planning.search.improvement import improve
from icarus_lite.planning.search.result import Effort, Limits, Progress, SearchResult
from icarus_lite.planning.search.searching import search

__all__ = ["Effort", "Limits", "Progress", "SearchResult", "improve", "search"]
