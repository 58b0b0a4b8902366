"""The reference of the trace names every key that a trace has, and no other."""

from __future__ import annotations

import json
import re
from pathlib import Path

from recorded_runs import record

ROOT = Path(__file__).parents[1]
_OF_RUNS = {"task", "robot", "seed", "workplace", "anchoring", "others", "long_term"}
_OF_CYCLES = {"detections", "anchors", "arm", "timings", "withdrawn", "doubts"}


def keys(heading: str) -> set[str]:
    text = (ROOT / "docs" / "reference" / "trace.md").read_text()
    section = text.split(f"## {heading}\n")[1].split("\n## ")[0]
    cells = re.findall(r"^\| (`[^|]*) \|", section, re.MULTILINE)
    return {key for cell in cells for key in re.findall(r"`([a-z_]+)`", cell)}


def test_every_key_is_described(tmp_path: Path) -> None:
    lines = record(tmp_path / "run.jsonl", seed=1, cycles=2).path.read_text().splitlines()
    header, cycle = json.loads(lines[0]), json.loads(lines[1])
    assert keys("The header") == header.keys() | _OF_RUNS
    assert keys("A cycle") == cycle.keys() | _OF_CYCLES
