"""`icarus pddl export` and `icarus pddl import` as a person calls them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from command_line import icarus

from icarus_lite.language import load_domain

PROBLEMS = Path(__file__).parents[2] / "icarus_lite" / "language" / "pddl" / "problems"


def steps(file: Path, task: str) -> list[str]:
    status, out, _ = icarus("plan", file, "--task", task, "--json")
    assert status == 0
    found: list[str] = json.loads(out)["steps"]
    return found


def test_export_writes_two_files_and_says_where_the_state_is_from(
    gearbox: Path, tmp_path: Path
) -> None:
    status, out, err = icarus("pddl", "export", gearbox, "--task", "1.1", "--out", tmp_path / "x")
    assert (status, err) == (0, "")
    assert out.splitlines()[0] == f"{tmp_path / 'x' / 'domain.pddl'}: 4 actions"
    assert 'the initial state is that of the test "task 1.1 takes two steps"' in out
    text = (tmp_path / "x" / "domain.pddl").read_text()
    assert text.startswith("; The domain gearbox, for its task 1.1.\n")
    assert "(:derived (free ?hand - hand)" in text
    assert "(:goal (attached hubcover case))" in (tmp_path / "x" / "problem.pddl").read_text()


def test_what_is_exported_is_imported_and_planned_for(gearbox: Path, tmp_path: Path) -> None:
    icarus("pddl", "export", gearbox, "--task", "1.1", "--out", tmp_path)
    back = tmp_path / "back.icr"
    files = (tmp_path / "domain.pddl", tmp_path / "problem.pddl")
    status, out, err = icarus("pddl", "import", *files, "--out", back)
    assert (status, out) == (0, f"{back}: 4 skills, task problem\n")
    assert "note[PDDL016]: `attached` becomes `attached-to`" in err
    assert len(steps(back, "problem")) == len(steps(gearbox, "1.1")) == 2


def test_frames_give_the_initial_state(gearbox: Path, tmp_path: Path) -> None:
    percepts = [
        {"type": "hand", "name": "left", "attributes": {"reach": 0.8}},
        {"type": "object", "name": "case", "attributes": {"type": "case", "x": 0, "y": 0, "z": 0}},
    ]
    frame = {"cycle": 0, "percepts": percepts, "action": None}
    (tmp_path / "frames.jsonl").write_text(json.dumps(frame))
    arguments = ["--task", "1.1", "--frames", tmp_path / "frames.jsonl", "--out", tmp_path]
    status, out, err = icarus("pddl", "export", gearbox, *arguments)
    assert status == 0
    assert "the last frame of" in out
    assert (
        "(:objects left - hand case - thing hubcover - object)"
        in (tmp_path / "problem.pddl").read_text()
    )
    assert "note[PDDL017]: nothing that skills can do reaches this goal" in err


def test_inline_leaves_no_derived_predicate(gearbox: Path, tmp_path: Path) -> None:
    arguments = ["--task", "1.1", "--out", tmp_path, "--inline"]
    assert icarus("pddl", "export", gearbox, *arguments)[0] == 0
    assert "derived" not in (tmp_path / "domain.pddl").read_text()


def test_inline_refuses_a_recursive_concept(root: Path, tmp_path: Path) -> None:
    arguments = ["--task", "three-disks", "--out", tmp_path, "--inline"]
    status, out, err = icarus("pddl", "export", root / "domains" / "hanoi.icr", *arguments)
    assert (status, out) == (2, "")
    assert "`tower` is derived from itself (tower -> tower)" in err


def test_a_task_without_any_state_is_refused(tmp_path: Path) -> None:
    (tmp_path / "d.icr").write_text("(percepts (o)) (task t :goal ((o a)))")
    status, _, err = icarus("pddl", "export", tmp_path / "d.icr", "--task", "t", "--out", tmp_path)
    assert status == 2
    assert "--frames IN.jsonl, or add :init (…) to the task" in err


def test_import_writes_a_file_that_plans_by_itself(tmp_path: Path) -> None:
    out = tmp_path / "new" / "lift.icr"
    files = (PROBLEMS / "lift.pddl", PROBLEMS / "lift-2.pddl")
    assert icarus("pddl", "import", *files, "--out", out)[0] == 0
    assert load_domain(out).tasks[0].name == "problem"
    assert len(steps(out, "problem")) == 6


def test_import_tells_what_is_wrong_with_its_place_and_writes_nothing(tmp_path: Path) -> None:
    domain = tmp_path / "d.pddl"
    domain.write_text(
        "(define (domain d) (:predicates (p))\n  (:action a :effect (when (p) (p))))\n"
    )
    out = tmp_path / "d.icr"
    status, said, err = icarus("pddl", "import", domain, domain, "--out", out)
    assert (status, said) == (2, "")
    assert err.startswith(f"{domain}:2:23: error[PDDL007]: `when` is a conditional effect")
    assert not out.exists()


@pytest.mark.parametrize("data", [b"", b"\xff\xfe", b"\0", b"(define", b"(" * 5000, b"PNG\r\n"])
def test_any_bytes_are_status_2_and_never_a_traceback(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "x.pddl").write_bytes(data)
    files = (tmp_path / "x.pddl", tmp_path / "x.pddl")
    status, out, err = icarus("pddl", "import", *files, "--out", tmp_path / "x.icr")
    assert (status, out) == (2, "")
    assert re.match(r".*x\.pddl.*: error\[(PDDL|ICR)\d{3}\]: ", err)
    assert "Traceback" not in err


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    missing = tmp_path / "none.pddl"
    status, _, err = icarus("pddl", "import", missing, missing, "--out", tmp_path / "x.icr")
    assert status == 2
    assert "cannot be read" in err


def test_help_shows_an_example_for_each() -> None:
    for command in ("export", "import"):
        status, out, _ = icarus("pddl", command, "--help")
        assert status == 0
        assert f"Example: icarus pddl {command}" in out
