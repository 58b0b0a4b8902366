"""One problem, in a process of its own, the way `icarus pddl import` and `icarus plan` take it."""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from icarus_lite.planning.search import Limits, improve, search
from planners.planned import actions, imported

STARTED = time.process_time()


def main() -> None:
    """Plan, and print what came of it as JSON."""
    parser = argparse.ArgumentParser()
    parser.add_argument("domain", type=Path)
    parser.add_argument("problem", type=Path)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--improve", action="store_true")
    args = parser.parse_args()
    problem = imported(args.domain, args.problem)
    read = time.process_time()
    task = problem.ground()
    grounded = time.process_time()
    found = search(task, Limits(seconds=args.seconds - grounded, clock=time.process_time))
    searched = time.process_time()
    plan = found.plan
    if plan is not None and args.improve:
        limits = Limits(seconds=args.seconds - searched, clock=time.process_time)
        plan = improve(task, plan, limits)
    report = {
        "plan": None if plan is None else actions(task, plan),
        "unsolvable": plan is None and found.exhausted,
        "evaluations": found.effort.evaluations,
        "expansions": found.effort.expansions,
        "start_s": STARTED,
        "read_s": read - STARTED,
        "ground_s": grounded - read,
        "search_s": searched - grounded,
        "operators": len(task.operators),
        "end_s": time.process_time(),
    }
    print(json.dumps(report))


main()
