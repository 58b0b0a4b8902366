from __future__ import annotations

from aapa.reasons import SEEN_TOO_LITTLE, UNEXPLAINED, not_seen, occluded_by


def test_a_miss_is_told_with_its_length_and_outcome():
    assert not_seen(UNEXPLAINED, -1, 0.4) == (
        "It is not seen and nothing explains why; its confidence falls to 0.4."
    )
    assert not_seen(SEEN_TOO_LITTLE, -3, -0.1) == (
        "It is not seen for 3 frames and it had been seen too little to be reasoned about; it is "
        "given up."
    )


def test_an_occluder_is_named():
    assert occluded_by("cone-1") == "cone-1 stands in front of it."
