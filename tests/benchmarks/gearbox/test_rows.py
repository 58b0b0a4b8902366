from __future__ import annotations

from dataclasses import replace

import pytest
from gearbox.rows import (
    Ending,
    Episode,
    Places,
    Row,
    RowFile,
    Trace,
    Trouble,
    code_digest,
    read_rows,
)
from gearbox.trials import Trial

ROW = Row(
    Trial("1.4", 3, fault="jam"),
    Ending.RECOVERED,
    achieved=True,
    true=True,
    reason="all goals are believed",
    struck=("jam",),
    troubles=(Trouble(12, "(screw-in plug case)", "jammed 4 mm above its seat"),),
    episodes=(Episode("(attached plug hand1)", 7, 2, 0.25, "(screw-in plug case)"),),
    places=Places(100, 2, 1.5, 3.25),
    trace=Trace(140),
)


def test_rows_are_read_as_they_were_kept(tmp_path):
    kept = RowFile(tmp_path / "deep" / "rows.jsonl")
    other = replace(ROW, trial=Trial("1.4", 4))
    kept.add(ROW)
    kept.add(other)
    assert read_rows(kept.path) == kept.rows == {ROW.trial.key: ROW, other.trial.key: other}


def test_the_newest_row_of_a_run_counts(tmp_path):
    path = tmp_path / "rows.jsonl"
    RowFile(path).add(ROW)
    again = RowFile(path)
    again.add(replace(ROW, ending=Ending.ACHIEVED))
    assert [row.ending for row in read_rows(path).values()] == [Ending.ACHIEVED]


def test_a_line_that_was_cut_off_costs_that_run_only(tmp_path):
    path = tmp_path / "rows.jsonl"
    other = replace(ROW, trial=Trial("1.4", 4))
    kept = RowFile(path)
    kept.add(ROW)
    kept.add(other)
    whole = path.read_bytes()
    for cut in range(len(whole) - 2, len(whole) - 200, -7):
        path.write_bytes(whole[:cut])
        again = RowFile(path)
        assert list(again.rows) == [ROW.trial.key]
        again.add(other)
        assert list(read_rows(path)) == [ROW.trial.key, other.trial.key]


def test_other_files_are_refused(tmp_path):
    path = tmp_path / "rows.jsonl"
    path.write_text('{"cycle": 0}\n')
    with pytest.raises(SystemExit, match=r"rows.jsonl:1: is no row of this experiment"):
        RowFile(path)


def test_the_digest_follows_the_code(tmp_path):
    for folder in ("aapa", "icarus_lite", "runtime", "domains"):
        (tmp_path / folder).mkdir()
    (tmp_path / "domains" / "gearbox.icr").write_text("(domain gearbox)")
    before = code_digest(tmp_path)
    (tmp_path / "aapa" / "notes.txt").write_text("no code")
    assert code_digest(tmp_path) == before
    (tmp_path / "domains" / "gearbox.icr").write_text("(domain gearboxes)")
    assert code_digest(tmp_path) != before
