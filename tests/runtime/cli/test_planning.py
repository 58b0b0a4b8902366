"""`icarus plan` as a person calls it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import icarus

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


def test_explain_says_what_each_step_is_for_and_how_the_plan_was_found(
    domain: Path, frames: Path
) -> None:
    arguments = ("plan", domain, "--goal", "((on a b) (on b c))", "--frames", frames, "--explain")
    status, out, err = icarus(*arguments)
    assert (status, err) == (0, "")
    assert out.splitlines()[:8] == [
        "(move b c), step 1 of 2",
        "  needs (clear b): holds",
        "  needs (clear c): holds",
        "  brings about (on b c), a goal",
        "",
        "(move a b), step 2 of 2",
        "  needs (clear a): holds",
        "  needs (clear b): holds",
    ]
    assert "  means-ends analysis: a plan of 2 steps, 4 subgoals" in out.splitlines()
    status, out, _ = icarus(*arguments, "--json")
    found = json.loads(out)
    assert (found["solved"], found["cost"]) == (True, 2)
    assert {"producer": 0, "consumer": None} in [
        {key: link[key] for key in ("producer", "consumer")} for link in found["links"]
    ]
    assert found["account"]["shortest"] is True


def test_explain_tells_why_there_is_no_plan(domain: Path) -> None:
    status, out, err = icarus("plan", domain, "--task", "deep", "--explain", "--json")
    found = json.loads(out)
    assert (status, err) == (1, "")
    assert found["final"] is True
    assert "(on a a)" in found["reason"]


def test_macro_shows_a_skill_that_fits_the_domain(domain: Path, tmp_path: Path) -> None:
    status, out, err = icarus("plan", domain, "--task", "given", "--macro")
    assert (status, err) == (0, "")
    assert out.startswith("(skills\n  ((achieve-on ?a ?b)\n")
    adopted = tmp_path / "adopted.icr"
    icarus("fmt", domain)
    adopted.write_text(domain.read_text() + "\n" + out)
    assert icarus("check", adopted)[0] == 0
    assert icarus("fmt", "--check", adopted)[0] == 0
    status, out, _ = icarus("plan", domain, "--task", "given", "--macro", "--json")
    assert json.loads(out)["macro"].startswith("(skills")


def test_limits_are_kept_to_and_improvement_gives_no_longer_plan(
    domain: Path, frames: Path
) -> None:
    ask = ("plan", domain, "--goal", "((on a b) (on b c))", "--frames", frames)
    status, out, err = icarus(*ask, "--limit", "1")
    assert (status, out) == (1, "")
    assert err == "no plan: no plan among the first 1 situations imagined\n"
    for options in (["--limit", "0"], ["--seconds", "20"], ["--improve", "0.1"]):
        status, out, _ = icarus(*ask, *options)
        assert (status, out.count("\n")) == (0, 2)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--task", "given", "--limit", "-3"], "--limit -3: it cannot be less than 0"),
        (["--task", "given", "--seconds", "-0.5"], "--seconds -0.5: it cannot be less than 0"),
        (["--task", "given", "--improve", "inf"], "--improve inf: it cannot be less than 0"),
        (["--task", "given", "--limit", "many"], "--limit"),
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
