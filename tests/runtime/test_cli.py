"""The command line as a person calls it: its two streams and its status."""

from __future__ import annotations

import io
import json
import os
import re
import socket
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path

import pytest

from icarus_lite import __version__
from runtime.cli import main

COMMANDS = (
    "cater",
    "check",
    "controller",
    "diff",
    "explain-rule",
    "fmt",
    "infer",
    "lsp",
    "pddl",
    "plan",
    "repl",
    "replay",
    "report",
    "run",
    "test",
    "track",
    "view",
    "when",
    "why",
    "why-not",
)
DRY = "192.0.2.1"  # an address for documentation: nobody is ever there
FRAMES = [
    {
        "cycle": 0,
        "percepts": [
            {"type": "hand", "name": "hand1", "attributes": {"reach": 0.85}},
            {
                "type": "object",
                "name": "o1",
                "attributes": {"type": "plug", "x": 0.3, "y": 0.0, "z": 0.0},
            },
        ],
        "action": {"name": "pick-up", "args": ["hand1", "o1"], "status": "succeeded"},
    },
    {"cycle": 1, "percepts": [], "action": None},
]


@dataclass(frozen=True)
class Done:
    """What a call left: its status and its two streams."""

    returncode: int
    stdout: str
    stderr: str


def icarus(*args: str | Path) -> Done:
    """Call the command line in this process, which is much faster than a process of its own."""
    out, err = io.StringIO(), io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", *map(str, args)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = argv
    return Done(int(ended.value.code or 0), out.getvalue(), err.getvalue())


def icarus_process(*args: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "runtime.cli", *map(str, args)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)


def write_frames(folder: Path, frames: list[object]) -> Path:
    path = folder / "frames.jsonl"
    path.write_text("".join(json.dumps(frame) + "\n" for frame in frames))
    return path


def without_times(trace: Path) -> list[dict[str, object]]:
    rows = [json.loads(line) for line in trace.read_text().splitlines()]
    return [{key: value for key, value in row.items() if key != "timings"} for row in rows]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a full device")
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_full_disk_is_told_in_words(unbuffered: str) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "runtime.cli", "check", "domains/gearbox.icr"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
            check=False,
            env={**os.environ, "PYTHONUNBUFFERED": unbuffered},
        )
    assert done.returncode == 2
    assert done.stderr == "standard output: No space left on device\n"


def test_version() -> None:
    done = icarus_process("--version")
    assert (done.returncode, done.stdout) == (0, f"icarus-lite {__version__}\n")


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(command: str) -> None:
    done = icarus(command, "--help")
    assert done.returncode == 0
    assert f"Example: icarus {command}" in done.stdout


def test_help_lists_every_command() -> None:
    listed = re.findall(r"^  ([a-z][a-z-]+)  ", icarus("--help").stdout, re.MULTILINE)
    assert sorted(listed) == sorted(COMMANDS)


@pytest.mark.parametrize("arguments", [["fly"], ["check"], ["run", "x.icr", "--seed", "-1"]])
def test_wrong_usage_is_status_2(arguments: list[str]) -> None:
    done = icarus(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert "Traceback" not in done.stderr


class TestCheck:
    def test_the_shipped_domain_has_no_problems(self, gearbox: Path) -> None:
        done = icarus("check", gearbox)
        assert (done.returncode, done.stderr) == (0, "")
        assert "no problems" in done.stdout

    def test_a_mistake_is_shown_with_its_line_and_a_caret(self, tmp_path: Path) -> None:
        file = tmp_path / "broken.icr"
        file.write_text("(percepts (hand))\n(concepts\n  ((free ?h) :elements ((hnd ?h))))\n")
        done = icarus("check", file)
        assert done.returncode == 2
        lines = done.stderr.splitlines()
        assert lines[0].startswith(f"{file}:3:26: error[ICR013]")
        assert lines[1] == "    3 |   ((free ?h) :elements ((hnd ?h))))"
        assert lines[2].startswith("      |                          ^")
        assert "did you mean" in done.stderr
        assert "Traceback" not in done.stderr

    def test_json_is_one_document_with_the_promised_keys(self, tmp_path: Path) -> None:
        file = tmp_path / "broken.icr"
        file.write_text("(concepts ((free ?h) :elements ((hand ?h)))")
        done = icarus("check", file, "--json")
        assert (done.returncode, done.stderr) == (2, "")
        rows = json.loads(done.stdout)
        assert {"file", "line", "column", "end_line", "end_column", "severity", "code"} <= set(
            rows[0]
        )
        assert {"message", "hint"} <= set(rows[0])
        assert rows[0]["severity"] == "error"

    def test_a_file_that_is_not_there(self, tmp_path: Path) -> None:
        done = icarus("check", tmp_path / "none.icr")
        assert done.returncode == 2
        assert "cannot be read" in done.stderr

    def test_non_stratified_negation_names_the_cycle(self, tmp_path: Path) -> None:
        file = tmp_path / "cycle.icr"
        file.write_text(
            "(percepts (o))\n(concepts ((p ?x) :elements ((o ?x) (not (q ?x))))\n"
            "          ((q ?x) :elements ((p ?x))))\n"
        )
        done = icarus("check", file)
        assert done.returncode == 2
        assert "p -> not q -> p" in done.stderr


class TestInfer:
    def test_beliefs_of_each_cycle(self, gearbox: Path, tmp_path: Path) -> None:
        done = icarus("infer", gearbox, "--frames", write_frames(tmp_path, FRAMES))
        assert (done.returncode, done.stderr) == (0, "")
        first, second = map(json.loads, done.stdout.splitlines())
        assert first["beliefs"] == sorted(first["beliefs"])
        assert "(attached o1 hand1)" in first["beliefs"]
        assert "(holding hand1 o1)" in first["beliefs"]
        assert second == {"cycle": 1, "beliefs": []}

    def test_out_takes_the_same_lines(self, gearbox: Path, tmp_path: Path) -> None:
        frames = write_frames(tmp_path, FRAMES)
        out = tmp_path / "beliefs.jsonl"
        assert icarus("infer", gearbox, "--frames", frames, "--out", out).stdout == ""
        assert out.read_text() == icarus("infer", gearbox, "--frames", frames).stdout

    def test_a_malformed_line_keeps_what_came_before(self, gearbox: Path, tmp_path: Path) -> None:
        frames = write_frames(tmp_path, [FRAMES[0], {"cycle": 1, "percepts": 5}])
        done = icarus("infer", gearbox, "--frames", frames)
        assert done.returncode == 2
        assert len(done.stdout.splitlines()) == 1
        assert done.stderr == f'{frames}:2: key "percepts": expected a list, got 5\n'

    def test_a_refused_attachment_is_said(self, gearbox: Path, tmp_path: Path) -> None:
        act = {"name": "insert", "args": ["a", "a"]}
        frames = write_frames(tmp_path, [{"cycle": 0, "percepts": [], "action": act}])
        done = icarus("infer", gearbox, "--frames", frames)
        assert done.returncode == 0
        assert "refused: (insert a a)" in done.stderr

    def test_a_broken_domain_is_status_2_with_the_place(self, tmp_path: Path) -> None:
        file = tmp_path / "broken.icr"
        file.write_text("(concepts (")
        done = icarus("infer", file, "--frames", write_frames(tmp_path, FRAMES))
        assert (done.returncode, done.stdout) == (2, "")
        assert f"{file}:1:" in done.stderr

    def test_a_test_that_compares_a_symbol_names_file_and_line(self, tmp_path: Path) -> None:
        file = tmp_path / "d.icr"
        file.write_text(
            "(percepts (o ^w))\n(concepts ((big ?o) :elements ((o ?o ^w ?w)) :tests ((> ?w 1))))\n"
        )
        frames = write_frames(
            tmp_path,
            [{"cycle": 0, "percepts": [{"type": "o", "name": "a", "attributes": {"w": "wide"}}]}],
        )
        done = icarus("infer", file, "--frames", frames)
        assert done.returncode == 2
        assert f"{frames}:1: {file}:2:" in done.stderr
        assert "Traceback" not in done.stderr

    def test_a_domain_that_explodes_names_the_clause_and_keeps_what_is_written(
        self, tmp_path: Path
    ) -> None:
        file, out = tmp_path / "d.icr", tmp_path / "beliefs.jsonl"
        file.write_text("(percepts (o))\n(concepts ((pair ?a ?b) :elements ((o ?a) (o ?b))))\n")
        percepts = [{"type": "o", "name": name, "attributes": {}} for name in "abcd"]
        cycles = [{"cycle": 0, "percepts": percepts[:1]}, {"cycle": 1, "percepts": percepts}]
        frames = write_frames(tmp_path, cycles)
        done = icarus("infer", file, "--frames", frames, "--out", out, "--max-beliefs", "9")
        assert done.returncode == 2
        assert f"{frames}:2: {file}:2:" in done.stderr
        assert "more than 9 beliefs, the budget" in done.stderr
        assert out.read_text() == '{"cycle": 0, "beliefs": ["(pair a a)"]}\n'


class TestRun:
    def test_a_dry_run_reaches_the_goal_and_sends_nothing(
        self, gearbox: Path, tmp_path: Path
    ) -> None:
        trace = tmp_path / "run.jsonl"
        run = ("run", gearbox, "--task", "1.1", "--address", DRY, "--trace")
        done = icarus(*run, trace, "--json")
        assert (done.returncode, done.stderr) == (0, "")
        result = json.loads(done.stdout)
        keys = {"task", "robot", "outcome", "reason", "cycles", "actions", "trace", "recoveries"}
        assert set(result) == keys
        assert (result["task"], result["robot"], result["outcome"]) == ("1.1", "ur5", "achieved")
        assert [(a["action"], a["status"]) for a in result["actions"]] == [
            ("(pick-up hand1 hubcover)", "succeeded"),
            ("(insert hubcover case)", "succeeded"),
        ]
        assert result["cycles"] == len(trace.read_text().splitlines()) - 1
        again = icarus(*run, tmp_path / "again.jsonl")
        assert again.returncode == 0
        assert "\x1b" not in again.stdout
        assert "nothing is sent to 192.0.2.1" in again.stdout
        assert "hubcover: not seen, kept: attached to hand1" in again.stdout
        assert "+ (attached hubcover case)" in again.stdout
        assert "task 1.1 achieved" in again.stdout
        assert without_times(trace) == without_times(tmp_path / "again.jsonl")

    def test_live_is_refused_while_percepts_are_simulated(self, gearbox: Path) -> None:
        done = icarus("run", gearbox, "--task", "1.1", "--address", DRY, "--live")
        assert (done.returncode, done.stdout) == (2, "task 1.1 of gearbox, seed 0\n")
        assert "A real arm is never moved on simulated beliefs" in done.stderr

    def test_an_unknown_task_lists_those_there_are(self, gearbox: Path) -> None:
        done = icarus("run", gearbox, "--task", "1.7", "--json")
        assert (done.returncode, done.stdout) == (2, "")
        assert "has no task 1.7; did you mean 1.4? (tasks: 1.1, 1.2" in done.stderr

    def test_a_skill_that_no_driver_offers_is_refused_before_anything_moves(
        self, tmp_path: Path
    ) -> None:
        file = tmp_path / "d.icr"
        file.write_text(
            "(domain d)\n(percepts (object ^type))\n"
            "(skills ((weld ?o) :elements ((object ?o)) :actions ((*weld ?o))\n"
            "                   :effects ((welded ?o))))\n"
            '(task weld "Weld" :goal ((welded case)))\n'
        )
        done = icarus("run", file, "--task", "weld", "--address", DRY)
        assert done.returncode == 2
        assert "no driver offers the command `*weld`" in done.stderr
        assert f"{file}:3:" in done.stderr

    def test_an_unknown_robot(self, gearbox: Path) -> None:
        done = icarus("run", gearbox, "--task", "1.1", "--robot", "ur55", "--json")
        assert (done.returncode, done.stdout) == (2, "")
        assert "ur55" in done.stderr

    def test_nobody_at_the_address(self, gearbox: Path, tmp_path: Path) -> None:
        done = icarus(
            "run", gearbox, "--task", "1.1", "--address", "127.0.9.9", "--trace", tmp_path / "t"
        )
        assert done.returncode == 2
        assert "127.0.9.9" in done.stderr
        assert "Traceback" not in done.stderr

    def test_a_trace_that_cannot_be_written(self, gearbox: Path, tmp_path: Path) -> None:
        (tmp_path / "file").write_text("")
        trace = tmp_path / "file" / "run.jsonl"
        done = icarus("run", gearbox, "--task", "1.1", "--address", DRY, "--trace", trace)
        assert done.returncode == 2
        assert "Traceback" not in done.stderr
        assert str(trace) in done.stderr


def test_a_busy_port_is_told_in_one_sentence() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.7.7", 30004))
        taken.listen()
        done = icarus("controller", "--address", "127.0.7.7")
    assert done.returncode == 2
    assert "127.0.7.7:30004" in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1


class TestTrack:
    def test_anchors_of_each_frame(self, root: Path, tmp_path: Path) -> None:
        seen = tmp_path / "seen.jsonl"
        detection = {"type": "cone", "box": [10, 10, 30, 30], "score": 0.9}
        rows = [{"frame": n, "detections": [detection], "actions": []} for n in range(2)]
        seen.write_text("".join(json.dumps(row) + "\n" for row in rows))
        domain = root / "domains" / "cater.icr"
        done = icarus("track", "--detections", seen, "--domain", domain, "--tau", "3000")
        assert (done.returncode, done.stderr) == (0, "")
        first, second = map(json.loads, done.stdout.splitlines())
        assert first["frame"] == 0
        assert second["anchors"] == [
            {
                "name": "cone-1",
                "type": "cone",
                "box": [10.0, 10.0, 30.0, 30.0],
                "status": "visible",
                "parent": None,
                "confidence": 0.2,
            }
        ]

    @pytest.mark.parametrize(
        ("line", "said"), [('{"frame": 0}', "detections"), ("not json", "seen.jsonl:1")]
    )
    def test_a_malformed_line_is_status_2(self, tmp_path: Path, line: str, said: str) -> None:
        seen = tmp_path / "seen.jsonl"
        seen.write_text(line + "\n")
        done = icarus("track", "--detections", seen)
        assert done.returncode == 2
        assert said in done.stderr

    def test_a_tau_that_makes_no_sense(self, tmp_path: Path) -> None:
        done = icarus("track", "--detections", tmp_path / "x", "--tau", "-1")
        assert done.returncode == 2
        assert "tau" in done.stderr
