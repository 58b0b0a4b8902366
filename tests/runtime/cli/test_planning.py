"""`icarus plan` as a person calls it."""

from __future__ import annotations

import io
import json
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from runtime.cli import main

DOMAIN = """
(percepts (block))
(concepts ((clear ?b) :elements ((block ?b) (not (on ?any ?b)))))
(skills ((move ?a ?b) :elements ((clear ?a) (clear ?b)) :tests ((/= ?a ?b))
         :actions ((*move ?a ?b)) :effects ((on ?a ?b))))
(task given :init ((block a) (block b) (block c) (on b c)) :goal ((on a b)))
(task known-from-a-test :goal ((on b a)))
(task bare :goal ((on x y)))
(task deep :init ((block a)) :goal ((on a a)))
(test "two blocks" :percepts ((block a) (block b)) :goal ((on b a)))
"""
FRAMES = [
    {"cycle": 0, "percepts": [], "action": None},
    {
        "cycle": 1,
        "percepts": [{"type": "block", "name": name, "attributes": {}} for name in ("a", "b", "c")],
        "action": None,
    },
]


def icarus(*args: str | Path) -> tuple[int, str, str]:
    out, err = io.StringIO(), io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", *map(str, args)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = argv
    return int(ended.value.code or 0), out.getvalue(), err.getvalue()


@pytest.fixture
def domain(tmp_path: Path) -> Path:
    (tmp_path / "blocks.icr").write_text(DOMAIN)
    return tmp_path / "blocks.icr"


@pytest.fixture
def frames(tmp_path: Path) -> Path:
    path = tmp_path / "frames.jsonl"
    path.write_text("".join(json.dumps(frame) + "\n" for frame in FRAMES))
    return path


def test_a_task_that_gives_its_state_is_planned_for(domain: Path) -> None:
    assert icarus("plan", domain, "--task", "given") == (0, "  1  (move a b)\n", "")


def test_json_is_one_document(domain: Path) -> None:
    status, out, err = icarus("plan", domain, "--task", "given", "--json")
    assert (status, err) == (0, "")
    assert json.loads(out) == {"solved": True, "steps": ["(move a b)"], "cost": 1}


def test_a_goal_is_planned_for_from_the_last_frame(domain: Path, frames: Path) -> None:
    goal = "((on a b) (on b c))"
    status, out, _ = icarus("plan", domain, "--goal", goal, "--frames", frames, "--json")
    assert status == 0
    assert json.loads(out)["steps"] == ["(move b c)", "(move a b)"]


def test_frames_come_before_a_test_of_the_domain(domain: Path, frames: Path) -> None:
    status, out, err = icarus("plan", domain, "--task", "known-from-a-test", "--frames", frames)
    assert (status, out, err) == (0, "  1  (move b a)\n", "")


def test_a_test_of_the_domain_serves_as_an_example_and_it_is_said(domain: Path) -> None:
    status, out, err = icarus("plan", domain, "--task", "known-from-a-test")
    assert (status, out) == (0, "  1  (move b a)\n")
    assert err == 'the state is that of the test "two blocks", for task known-from-a-test\n'


def test_no_plan_is_status_1_with_the_reason(domain: Path) -> None:
    status, out, err = icarus("plan", domain, "--task", "deep")
    assert (status, out) == (1, "")
    assert err.startswith("no plan: no ")
    status, out, _ = icarus("plan", domain, "--task", "deep", "--json")
    found = json.loads(out)
    assert status == 1
    assert (found["solved"], found["steps"], found["cost"]) == (False, [], None)
    assert found["reason"]


def test_a_goal_that_holds_needs_no_step(domain: Path, frames: Path) -> None:
    status, out, _ = icarus("plan", domain, "--goal", "(clear a)", "--frames", frames)
    assert (status, out) == (0, "nothing to do: the goal holds already\n")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "either --task NAME or --goal"),
        (["--task", "given", "--goal", "(on a b)"], "either --task NAME or --goal"),
        (["--task", "gievn"], "has no task gievn; its tasks are: given, known-from-a-test"),
        (["--task", "bare"], "task bare gives no state to plan from"),
        (["--goal", "(on a b)"], "a goal alone gives no state to plan from"),
        (["--goal", "(onn a b)"], "nothing is ever known about onn; did you mean on?"),
        (["--goal", "(on a)"], "on takes 2 arguments, not 1"),
        (["--goal", "(on a"], "is never closed"),
        (["--task", "given", "--frames", "none.jsonl"], "none.jsonl: cannot be read"),
    ],
)
def test_bad_input_is_status_2_with_the_reason(
    domain: Path, arguments: list[str], message: str
) -> None:
    status, out, err = icarus("plan", domain, *arguments)
    assert (status, out) == (2, "")
    assert message in err
    assert "Traceback" not in err


def test_frames_without_a_frame_are_refused(domain: Path, tmp_path: Path) -> None:
    (tmp_path / "empty.jsonl").write_text("\n")
    status, _, err = icarus(
        "plan", domain, "--goal", "(on a b)", "--frames", tmp_path / "empty.jsonl"
    )
    assert status == 2
    assert "holds no frame" in err
