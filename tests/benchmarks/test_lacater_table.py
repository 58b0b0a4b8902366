"""The benchmark of the paper's comparison: in parts, never twice, every figure in its place."""

from __future__ import annotations

import json
import sys

import lacater_table
import pytest
from lacater_page import Rows, ahead, difference, table, worst_share
from lacater_paper import PAPER

from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import TASKS

OD, PP = PerceptionKind.OD, PerceptionKind.PP


def row(kind, model, miou, ml2, scores=None):
    return {
        "perception": str(kind),
        "model": model,
        "weights": "",
        "videos": 2,
        "skipped": 0,
        "videos_per_second": 1.0,
        "row": {
            "miou": {task: [value, 0.5] for task, value in zip(TASKS, miou, strict=True)},
            "ml2": {task: [value, 0.1] for task, value in zip(TASKS, ml2, strict=True)},
        },
        "scores": scores or {},
    }


def test_rows_are_kept_and_the_last_one_counts(tmp_path):
    path = tmp_path / "rows.jsonl"
    rows = Rows(path)
    rows.add(row(PP, "aapa-plus", [1] * 5, [1] * 5))
    rows.add(row(PP, "aapa-plus", [2] * 5, [1] * 5) | {"weights": "abc"})
    again = Rows(path)
    assert again.known["pp", "aapa-plus"]["row"]["miou"]["overall"] == [2, 0.5]
    assert again.has(PP, "aapa-plus", "abc")
    assert not again.has(PP, "aapa-plus", "")
    assert not again.has(OD, "aapa-plus", "abc")


def test_the_table_has_the_paper_s_row_above_ours_and_marks_the_best(tmp_path):
    rows = Rows(tmp_path / "rows.jsonl")
    rows.add(row(PP, "aapa-6500", [99, 90, 93, 82, 96], [1] * 5))
    rows.add(row(PP, "aapa-plus", [98, 97, 98, 94, 99], [2] * 5))
    lines = table(rows, PP, "miou")
    at = next(n for n, line in enumerate(lines) if "`aapa-6500`" in line)
    assert lines[at - 1].startswith("| AAPA-6k5 | paper | 99.38 ± 0.12 | 90.53 ± 0.64 |")
    assert lines[at] == (
        "| `aapa-6500` | here | **99.00** ± 0.50 | 90.00 ± 0.50 | 93.00 ± 0.50 | 82.00 ± 0.50 "
        "| 96.00 ± 0.50 |"
    )
    # Of distances the least is the best.
    assert "**1.00** ± 0.10" in next(x for x in table(rows, PP, "ml2") if "`aapa-6500`" in x)


def test_differences_are_taken_video_by_video(tmp_path):
    rows = Rows(tmp_path / "rows.jsonl")
    first = {
        "a": [[0.9, None, 0.5, 0.5, 0.8], [1.0] * 5],
        "b": [[0.5, None, 0.5, 0.5, 0.6], [2.0] * 5],
    }
    second = {
        "b": [[0.4, None, 0.4, 0.5, 0.5], [2.5] * 5],
        "a": [[0.8, None, 0.3, 0.5, 0.5], [1.5] * 5],
    }
    rows.add(row(PP, "aapa-10000", [0] * 5, [0] * 5, first))
    rows.add(row(PP, "aapa-6500", [0] * 5, [0] * 5, second))
    lines = difference(rows, PP, "aapa-10000", "aapa-6500")
    assert lines[0].endswith(
        "+10.00 ± 0.00 | +nan ± nan | +15.00 ± 5.00 | +0.00 ± 0.00 | +20.00 ± 10.00 |"
    )
    assert lines[1].startswith(
        "| PP: `aapa-10000` - `aapa-6500` | mIoU, points, paper | +0.22 | +0.00"
    )
    assert "-0.50 ± 0.00" in lines[2]


def test_ahead_is_what_beats_every_published_row(tmp_path):
    rows = Rows(tmp_path / "rows.jsonl")
    rows.add(row(PP, "aapa-plus", [99.7, 90.6, 94.2, 87.9, 96.6], [0.1, 2.1, 0.4, 1.5, 0.4]))
    [said] = ahead(rows, "aapa-plus")
    assert said == (
        "PP: `aapa-plus` is not ahead in ml2 carried (1.50 ± 0.10 against 1.42 ± 0.04)."
    )


def test_how_much_of_a_distance_the_worst_videos_make():
    distances = [0.0] * 198 + [30.0, 10.0, None]
    scores = {str(n): [[90.0], [score]] for n, score in enumerate(distances)}
    assert worst_share({"scores": scores}, 1, 0) == "; 2 of 200 videos make 100% of it"
    assert worst_share({"scores": scores}, 0, 0) == ""


def test_the_paper_s_rows_are_whole():
    for kind, count in ((OD, 6), (PP, 4)):
        assert len(PAPER[kind]) == count
        for columns in PAPER[kind].values():
            assert [len(column) for column in columns] == [len(TASKS)] * 2
        for miou, ml2 in PAPER[kind].values():
            # Overall is between the best and the worst of the four labels.
            for column in (miou, ml2):
                means = [mean for mean, _ in column]
                assert min(means[:4]) <= means[4] <= max(means[:4])


def test_it_makes_the_rows_and_the_page_and_then_nothing_twice(tmp_path, monkeypatch, capsys):
    out, rows = tmp_path / "page.md", tmp_path / "rows.jsonl"
    arguments = [
        "lacater_table.py", "--data", tmp_path / "data", "--rows", rows, "--out", out,
        "--videos", 3, "--jobs", 1, "--models", "last-seen,aapa-6500",
    ]  # fmt: skip
    monkeypatch.setattr(sys, "argv", [str(each) for each in arguments])
    assert lacater_table.main() == 0
    made = [json.loads(line) for line in rows.read_text().splitlines()]
    assert [(each["perception"], each["model"]) for each in made] == [
        ("od", "last-seen"), ("od", "aapa-6500"), ("pp", "last-seen"), ("pp", "aapa-6500"),
    ]  # fmt: skip
    assert all(len(each["scores"]) == each["videos"] for each in made)
    text = out.read_text(encoding="utf-8")
    assert text.count("| `aapa-6500` | here |") == 4
    assert "v and the labels agree in" in text
    capsys.readouterr()
    monkeypatch.setattr(lacater_table, "made", pytest.fail)
    assert lacater_table.main() == 0
    assert out.read_text(encoding="utf-8") == text
