from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from recorded_runs import record
from typer.testing import CliRunner, Result

from icarus_lite.trace import Recording
from runtime.cli import app

pytest.importorskip("rerun", reason="the extra [view] is not installed")

ROOT = Path(__file__).parents[3]
RERUN = Path(sys.executable).with_name("rerun")


def view(*arguments: object) -> Result:
    done = CliRunner().invoke(app, ["view", *map(str, arguments)])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done


def entities(file: Path) -> dict[str, int]:
    """Give each entity of a file for the viewer and how many rows it has."""
    subprocess.run([RERUN, "rrd", "verify", file], check=True, capture_output=True, timeout=120)
    done = subprocess.run(
        [RERUN, "rrd", "stats", file], check=True, capture_output=True, text=True, timeout=120
    )
    return {
        name: int(rows) for name, rows in re.findall(r"^(/\S+): (\d+)$", done.stdout, re.MULTILINE)
    }


def test_what_changes_has_a_lane_and_the_goal_too(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=3, cycles=60)
    done = view(run.path, "--save", tmp_path / "deep" / "run.rrd")
    assert done.stdout == f"{tmp_path / 'deep' / 'run.rrd'}\n"
    found = entities(tmp_path / "deep" / "run.rrd")
    attached = {
        f"/beliefs/{re.sub('[^a-z]+', '_', str(belief)).strip('_')}"
        for belief, _ in Recording(run.path).chronicle().held("attached")
    }
    assert attached <= found.keys()
    assert "/doing/stored_a" in found
    assert {"/doing/action", "/hierarchy", "/log/beliefs", "/now"} <= found.keys()
    assert not any(name.startswith(("/camera", "/cell/")) for name in found)


def test_anchors_and_the_arm_are_shown_where_a_run_has_them(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=3, cycles=4)
    first, *rows = run.path.read_text().splitlines()
    header = json.loads(first) | {"robot": "ur5"}
    anchors = [
        {"name": "a", "type": "thing", "box": [10, 10, 40, 50], "status": "visible",
         "parent": None, "position": [0.4, 0.1, 0.02]},
        {"name": "b", "type": "thing", "box": [20, 10, 60, 50], "status": "attached",
         "parent": "a", "position": None},
        {"name": "c", "type": "thing", "box": [-90, 10, -60, 50], "status": "out-of-view",
         "parent": None, "position": [0.1, 0.1, 0.02]},
    ]  # fmt: skip
    arm = {"joints": [0.1] * 6, "tcp_pose": [0.4, 0.1, 0.2, 0, 3.14, 0], "gripper_closed": True}
    detections = [{"type": "thing", "box": [10, 10, 40, 50], "score": 0.9}]
    extra = {"anchors": anchors, "arm": arm, "detections": detections}
    lines = [json.dumps(header), *(json.dumps(json.loads(row) | extra) for row in rows)]
    run.path.write_text("\n".join(lines) + "\n")
    view(run.path, "--save", tmp_path / "run.rrd")
    found = entities(tmp_path / "run.rrd")
    assert {"/camera/anchors", "/camera/detections", "/cell/seen", "/cell/kept"} <= found.keys()
    assert {"/cell/arm", "/cell/gripper"} <= found.keys()


def test_a_file_that_cannot_be_written(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=3, cycles=2)
    (tmp_path / "file").touch()
    with pytest.raises(Exception, match="cannot be written"):
        view(run.path, "--save", tmp_path / "file" / "run.rrd")


def test_without_the_extra_a_sentence_names_it(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=3, cycles=2)
    program = (
        "import sys; sys.modules['rerun'] = None\n"
        "sys.argv = ['icarus', 'view', sys.argv[1], '--save', 'x.rrd']\n"
        "from runtime.cli import main\n"
        "main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, run.path],
        capture_output=True, text=True, cwd=tmp_path, timeout=120, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (2, "")
    assert "pip install 'icarus-lite[view]'" in done.stderr
    assert "Traceback" not in done.stderr
