"""The same question gives the same answer, whatever order Python hashes strings in."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

SCRIPT = """
import json, sys
from icarus_lite import Action, Agent, Outcome, Percept, load_domain
from icarus_lite.trace import cycle_record

parts = ["hubcover", "input", "output", "plug", "bearing", "case"]
percepts = [Percept("hand", "hand1", {"reach": 0.85, "gripping": "no"})] + [
    Percept("object", kind, {"type": kind, "x": 0.3 + i / 20, "y": 0.0, "z": 0.01, "seen": "yes"})
    for i, kind in enumerate(parts)
]
agent = Agent(load_domain(sys.argv[1]), ["(attached hubcover case)", "(attached plug case)"])
outcomes = []
for _ in range(6):
    decision = agent.cycle(percepts, outcomes)
    print(json.dumps(cycle_record(decision, percepts, outcomes)))
    outcomes = [] if decision.action is None else [Outcome(decision.action)]
"""


def record(gearbox: Path, seed: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(gearbox)],
        env={**os.environ, "PYTHONHASHSEED": seed},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return done.stdout


def test_two_hash_seeds_give_the_same_trace_byte_for_byte(gearbox: Path) -> None:
    first = record(gearbox, "1")
    assert "(screw-in plug case)" in first
    assert '"kind": "achieved"' in first
    assert first == record(gearbox, "2")
