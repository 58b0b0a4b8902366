"""`icarus cater evaluate` as a person calls it."""

from __future__ import annotations

import json
import re

import pytest
from command_line import icarus

from aapa.lacater.models import PAPER_MODELS


def test_the_table_has_a_line_a_model_and_a_column_a_task(tmp_path, dataset):
    folder = dataset(tmp_path, 3)
    status, out, err = icarus(
        "cater", "evaluate", folder, "--models", "last-seen,aapa-6500", "--perception", "pp",
        "--jobs", 1,
    )  # fmt: skip
    assert (status, err) == (0, "")
    assert "mIoU, % ± SEM (3 videos, perfect perception)" in out
    assert "mL2, px ± SEM (3 videos, perfect perception)" in out
    headers = [line.split() for line in out.splitlines() if line.split()[:1] == ["model"]]
    tasks = ["model", "visible", "occluded", "contained", "carried", "overall"]
    assert headers == [*[tasks] * 3, ["model", "videos/s"]]
    first = next(line for line in out.splitlines() if line.strip().startswith("aapa-6500"))
    assert re.split(r"\s{2,}", first.strip()) == [
        "aapa-6500", "100.00 ± 0.00", "-", "100.00 ± 0.00", "100.00 ± 0.00", "100.00 ± 0.00",
    ]  # fmt: skip


def test_the_models_of_the_paper_are_the_default(tmp_path, dataset):
    _, out, _ = icarus("cater", "evaluate", dataset(tmp_path, 1), "--jobs", 1, "--json")
    assert tuple(row["model"] for row in json.loads(out)["rows"]) == PAPER_MODELS


def test_json_is_one_document_and_nothing_else(tmp_path, dataset):
    status, out, err = icarus(
        "cater", "evaluate", dataset(tmp_path, 2), "--models", " last-seen ,last-seen,", "--json"
    )
    assert (status, err) == (0, "")
    document = json.loads(out)
    assert document["perception"] == "od"
    assert [row["model"] for row in document["rows"]] == ["last-seen"]


def test_what_was_skipped_is_told_below_the_table(tmp_path, dataset):
    folder = dataset(tmp_path, 3)
    (folder / "od_perception" / "CLEVR_new_000001.pkl").write_bytes(b"")
    _, out, _ = icarus("cater", "evaluate", folder, "--models", "last-seen", "--jobs", 1)
    assert "1 of 3 videos were skipped:\n" in out
    assert "CLEVR_new_000001.pkl: is no whole pickle; it may be cut off or damaged" in out


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (["--models", "aapa-x"], "there is no model 'aapa-x'; did you mean"),
        (["--models", ","], "no model is named"),
        (["--perception", "rgb"], "--perception is 'rgb'; it has to be od or pp"),
        (["--jobs", "0"], "--jobs"),
        (["--domain", "nowhere.icr"], "nowhere.icr"),
    ],
)
def test_bad_usage_ends_with_2_and_the_reason(tmp_path, dataset, options, text):
    status, out, err = icarus("cater", "evaluate", dataset(tmp_path, 1), *options)
    assert (status, out) == (2, "")
    assert text in err


def test_a_folder_that_is_no_data_set_ends_with_2(tmp_path):
    status, out, err = icarus("cater", "evaluate", tmp_path / "nowhere")
    assert (status, out) == (2, "")
    assert "there is no folder labels/ in it" in err
