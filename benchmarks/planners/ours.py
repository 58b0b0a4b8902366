"""One problem, in a process of its own, the way `icarus pddl import` and `icarus plan` take it.

python ours.py DOMAIN PROBLEM SECONDS [improve]
"""

from __future__ import annotations

import gc
import sys
import time
from os.path import abspath, dirname

gc.set_threshold(50_000)  # as `icarus` does, which ends like this one, too
sys.path.insert(0, dirname(dirname(abspath(__file__))))  # noqa: PTH100, PTH120 - as its peer

from icarus_lite.planning.search import Limits, search  # noqa: E402 - no garbage is made here
from planners.planned import actions, imported  # noqa: E402
from runtime.ending import Ending  # noqa: E402

ENDING = Ending()
STARTED = time.process_time()


def main(domain: str, problem: str, seconds: float, *, shorter: bool) -> None:
    """Plan, and print what came of it as a Python literal."""
    given = imported(domain, problem)
    read = time.process_time()
    task = given.ground()
    grounded = time.process_time()
    found = search(task, Limits(seconds=seconds - grounded, clock=time.process_time))
    searched = time.process_time()
    plan = found.plan
    if plan is not None and shorter:
        from icarus_lite.planning.search import improve  # noqa: PLC0415 - only if asked for

        plan = improve(task, plan, Limits(seconds=seconds - searched, clock=time.process_time))
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
    print(report)


main(sys.argv[1], sys.argv[2], float(sys.argv[3]), shorter="improve" in sys.argv[4:])
ENDING.status = 0
