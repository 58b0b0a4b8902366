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
