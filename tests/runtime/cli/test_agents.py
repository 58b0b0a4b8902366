"""Commands on a domain in which others take part."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import icarus

DOMAIN = """
(agents human)
(percepts (base) (arm))
(skills
  ((hold ?b) :agent human :elements ((base ?b)) :effects ((held ?b)))
  ((glue ?a ?b) :elements ((arm ?a) (held ?b)) :actions ((*grasp ?a ?b)) :effects ((glued ?b))))
(task together :agents (human) :init ((base b1) (arm a1)) :goal ((glued b1)))
(task alone :init ((base b1) (arm a1)) :goal ((glued b1)))
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "cell.icr"
    path.write_text(DOMAIN, encoding="utf-8")
    return path


def test_a_plan_asks_those_who_take_part_in_the_task(file: Path) -> None:
    status, out, _ = icarus("plan", file, "--task", "together", "--json")
    assert status == 0
    assert json.loads(out)["steps"] == ["(hold b1)", "(glue a1 b1)"]
    status, _, err = icarus("plan", file, "--task", "alone")
    assert status == 1
    assert "no skill can ever make (glued b1) true" in err


def test_others_are_written_as_pddl_with_a_remark(file: Path, tmp_path: Path) -> None:
    status, _, _ = icarus("pddl", "export", file, "--task", "together", "--out", tmp_path / "p")
    text = (tmp_path / "p" / "domain.pddl").read_text(encoding="utf-8")
    assert status == 0
    assert "; the skill (hold ?b) of the agent human, line 5" in text
    assert "; Actions of other agents stand beside one's own, and all cost the same." in text
    back = tmp_path / "back.icr"
    problem = tmp_path / "p" / "problem.pddl"
    assert icarus("pddl", "import", tmp_path / "p" / "domain.pddl", problem, "--out", back)[0] == 0
    status, out, _ = icarus("plan", back, "--task", "problem", "--json")
    assert (status, json.loads(out)["cost"]) == (0, 2)


def test_those_who_do_not_take_part_are_left_out_of_the_pddl(file: Path, tmp_path: Path) -> None:
    status, _, _ = icarus("pddl", "export", file, "--task", "alone", "--out", tmp_path / "p")
    assert status == 0
    assert "hold" not in (tmp_path / "p" / "domain.pddl").read_text(encoding="utf-8")


def test_a_request_to_somebody_unknown_is_an_error(file: Path) -> None:
    file.write_text(DOMAIN.replace(":agent human", ":agent humen"), encoding="utf-8")
    status, _, err = icarus("plan", file, "--task", "together")
    assert status == 2
    assert "nothing declares the agent `humen`" in err
