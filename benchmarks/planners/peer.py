"""One problem, in a process of its own: pyperplan's greedy best-first search with hFF.

python peer.py DOMAIN PROBLEM
"""

from __future__ import annotations

import sys
import time
from typing import Any

from pyperplan.heuristics.relaxation import hFFHeuristic
from pyperplan.planner import SEARCHES, _ground, _parse

STARTED = time.process_time()


class Counted(hFFHeuristic):  # type: ignore[misc]
    """The heuristic, which also counts how often it is asked."""

    evaluations = 0

    def __call__(self, node: Any) -> Any:
        """Estimate the distance to the goal."""
        Counted.evaluations += 1
        return super().__call__(node)


def main(domain: str, problem: str) -> None:
    """Plan, and print what came of it as a Python literal."""
    task = _ground(_parse(domain, problem))
    plan = SEARCHES["gbfs"](task, Counted(task))
    report = {
        "plan": None if plan is None else [step.name.strip("()").split() for step in plan],
        "unsolvable": plan is None,
        "evaluations": Counted.evaluations,
        "start_s": STARTED,
        "end_s": time.process_time(),
    }
    print(report)


main(sys.argv[1], sys.argv[2])
