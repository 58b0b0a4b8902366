"""One problem, in a process of its own: pyperplan's greedy best-first search with hFF."""

from __future__ import annotations

import argparse
import json
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


def main() -> None:
    """Plan, and print what came of it as JSON."""
    parser = argparse.ArgumentParser()
    parser.add_argument("domain")
    parser.add_argument("problem")
    args = parser.parse_args()
    task = _ground(_parse(args.domain, args.problem))
    plan = SEARCHES["gbfs"](task, Counted(task))
    report = {
        "plan": None if plan is None else [step.name.strip("()").split() for step in plan],
        "unsolvable": plan is None,
        "evaluations": Counted.evaluations,
        "start_s": STARTED,
        "end_s": time.process_time(),
    }
    print(json.dumps(report))


main()
