from __future__ import annotations

import pytest

import aapa


def test_the_public_names_are_there_and_documented():
    assert len(set(aapa.__all__)) == len(aapa.__all__)
    for name in aapa.__all__:
        assert getattr(aapa, name).__doc__ or name in {"Box", "Position"}


def test_the_example_of_the_contract():
    detections = [aapa.Detection("cone", (10, 10, 30, 30))]
    parameters = aapa.AnchoringParameters(tau=6500)
    anchors = aapa.Anchoring(parameters).update(detections, [("snitch-1", "cone-1")])
    assert [anchor.name for anchor in anchors] == ["cone-1"]


def test_errors_are_value_errors():
    with pytest.raises(ValueError, match="has to be above 0"):
        aapa.AnchoringParameters(tau=0)
