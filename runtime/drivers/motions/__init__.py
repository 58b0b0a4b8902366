"""From driver commands to steps: what an arm will do, worked out and checked before it moves.

The tool always points straight down, turned as at the look pose where that can be had: a part then
keeps its place between the fingers from grasp to insertion, and only distances count. The arm goes
across at transit height, and comes down and goes up in straight lines.

| command | steps |
|---|---|
| `(grasp hand obj)` | up, over the part, down, close; it ends holding the part where it lies |
| `(take-out hand obj into)` | the same, and straight up out of the receiver |
| `(insert hand obj into)` | up, to the look pose, look, over the seat, down, press home, open |
| `(screw-in hand obj into)` | the same, and turn before it opens, taking hold anew in between |
| `(unscrew hand obj into)` | as grasp, turn, taking hold anew in between, straight up |
| `(place hand obj)` | up, over the nearest free spot, down, open |
| `(rest hand)` | up, to the look pose |

`planner.py` has the moves all commands are made of, `places.py` what stands where, and
`handling.py`, `seating.py`, `screwing.py` the commands.
"""

from __future__ import annotations

from runtime.drivers.motions.commands import COMMANDS, plan_motion

__all__ = ["COMMANDS", "plan_motion"]
