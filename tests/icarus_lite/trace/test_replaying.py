from __future__ import annotations

import json
from pathlib import Path

import pytest
from recorded_runs import record

from icarus_lite import TraceError
from icarus_lite.trace import Recording, replay


def changed(path: Path, line: int, change: object) -> Path:
    lines = path.read_text().splitlines()
    row = json.loads(lines[line])
    change(row)  # type: ignore[operator]
    lines[line] = json.dumps(row)
    path.write_text("\n".join(lines) + "\n")
    return path


def test_a_run_goes_the_same_way_again(tmp_path: Path) -> None:
    found = replay(Recording(record(tmp_path / "run.jsonl", seed=2, cycles=60).path))
    assert found.agrees
    assert str(found) == "60 cycles replayed: all beliefs are as recorded, and all decisions"


def test_another_domain_shows_where_it_differs(tmp_path: Path) -> None:
    path = record(tmp_path / "run.jsonl", seed=2, cycles=60).path

    def tighten(header: dict[str, dict[str, str]]) -> None:
        header["domain"]["text"] = header["domain"]["text"].replace("(< ?s 5)", "(< ?s 4)")

    found = replay(Recording(changed(path, 0, tighten)))
    assert not found.agrees
    assert found.beliefs is not None
    assert found.beliefs.key == "added"
    assert "(small" in str(found)


def test_another_decision_is_told_apart_from_other_beliefs(tmp_path: Path) -> None:
    path = record(tmp_path / "run.jsonl", seed=2, cycles=20).path
    found = replay(Recording(changed(path, 8, lambda row: row.update(notes=["odd"]))))
    assert found.agrees
    assert "the decisions are not, first in cycle 7, notes: recorded" in str(found)


def test_a_header_that_does_not_say_what_ran(tmp_path: Path) -> None:
    path = record(tmp_path / "run.jsonl", seed=2, cycles=5).path
    with pytest.raises(TraceError, match=r'run.jsonl:1: key "goals" of the header'):
        replay(Recording(changed(path, 0, lambda row: row.pop("goals"))))
