"""How sure a model says it is, beside how often it is right."""

from __future__ import annotations

import json

import numpy as np
import pytest
from command_line import icarus

from aapa.lacater.video import FrameMasks
from runtime.cater.progress_file import _sureness, _sureness_entry
from runtime.cater.sureness import sureness

TRUE = np.tile([10.0, 10.0, 29.0, 29.0], (6, 1))


def masks(carried):
    moves = np.zeros(6, dtype=bool)
    moves[carried] = True
    nothing = np.zeros(6, dtype=bool)
    return FrameMasks(moves, nothing, moves, ~moves, ~moves, ~moves)


def test_a_box_is_right_that_shares_half_of_the_union():
    predicted = TRUE + np.array([0, 0, 6, 7, 0, 0])[:, None] * [1, 0, 1, 0]
    said = sureness(np.array([0.5, 1.0, 0.8, 0.6, 0.0, 0.1]), predicted, TRUE, masks([2, 3]), 1)
    # Moved by 6 of 20 px it shares 14 / 26, by 7 px 13 / 27.
    assert said.right["carried"] == 0.5
    assert said.confidence["carried"] == pytest.approx(0.7)
    assert said.right["visible"] == 1.0
    assert said.confidence["visible"] == pytest.approx(1.1 / 3)
    assert said.right["overall"] == 0.8
    assert np.isnan(said.right["contained"])
    assert np.isnan(said.confidence["occluded"])


def test_frames_before_the_first_sighting_do_not_count():
    predicted = TRUE.copy()
    predicted[:4] = np.nan
    said = sureness(np.ones(6), predicted, TRUE, masks([]), 4)
    assert said.right["overall"] == 1.0


def test_what_is_kept_of_it_is_read_again():
    said = sureness(np.linspace(0, 1, 6), TRUE, TRUE, masks([1]), 0)
    again = _sureness(json.loads(json.dumps(_sureness_entry(said))))
    assert repr(again) == repr(said)
    assert _sureness(_sureness_entry(None)) is None


def test_the_json_document_has_it_of_models_that_say_how_sure_they_are(tmp_path, dataset):
    status, out, _ = icarus(
        "cater", "evaluate", dataset(tmp_path, 2), "--models", "last-seen,aapa-plus", "--json",
        "--perception", "pp", "--jobs", 1,
    )  # fmt: skip
    assert status == 0
    last, plus = json.loads(out)["rows"]
    assert "confidence" not in last
    assert plus["confidence"]["visible"] == [1.0, 0.0]
    assert plus["confidence"]["contained"][0] == pytest.approx(0.99, abs=0.03)
    assert plus["right"]["visible"] == [1.0, 0.0]
    assert list(plus["right"]) == ["visible", "occluded", "contained", "carried", "overall"]
