"""`icarus check` with several files, with includes, and when it is asked for everything."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from runtime.cli import app

UNUSED = "(percepts (box ^x))\n(concepts ((small ?b) :elements ((box ?b ^x 1))))\n"


@pytest.fixture
def check(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        return CliRunner().invoke(app, ["check", *arguments])

    return run


def test_names_nobody_uses_are_told_on_request(check, tmp_path):
    (tmp_path / "d.icr").write_text(UNUSED)
    assert check("d.icr").output == "1 file: no problems\n"
    for option in ("-v", "--verbose"):
        done = check("d.icr", option)
        assert (done.exit_code, "ICR040" in done.output) == (0, True)
        assert done.output.endswith("1 file: 1 note\n")


def test_findings_in_an_included_file_are_told_with_its_name(check, tmp_path):
    (tmp_path / "top.icr").write_text('(include "parts.icr")')
    (tmp_path / "parts.icr").write_text("; parts\n(task 1)")
    done = check("top.icr")
    assert done.exit_code == 2
    assert "parts.icr:2:1: error[ICR021]: the task `1` has no goal\n    2 | (task 1)" in done.output
    (row,) = json.loads(check("top.icr", "--json").stdout)
    assert (row["file"], row["line"], row["code"]) == ("parts.icr", 2, "ICR021")


def test_a_command_that_no_driver_offers_is_told_where_a_task_is_for_a_robot(check, tmp_path):
    text = """(percepts (object))
(skills ((weld ?o) :elements ((object ?o)) :actions ((*weld ?o)) :effects ((hot ?o))))
(task weld "Weld" {robot} :goal ((hot case)))
"""
    file = tmp_path / "d.icr"
    file.write_text(text.replace("{robot}", ":robot ur5"))
    done = check("d.icr")
    assert done.exit_code == 2
    assert "d.icr:2:56: error[ICR035]: no driver offers the command `*weld`" in done.output
    file.write_text(text.replace("{robot}", ""))
    assert check("d.icr").exit_code == 0
