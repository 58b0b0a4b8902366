"""What is unique is in one place: where it is seen, if that is not where it was believed to be."""

from __future__ import annotations

from dataclasses import replace

import pytest

from aapa import Anchoring, AnchoringError, AnchoringParameters, AnchorStatus, Detection

PARAMETERS = AnchoringParameters(
    space="base",
    tau=0.0036,
    confidence_gain=0.2,
    min_report_confidence=0.5,
    unique_types=frozenset({"cover"}),
    reunite_after=3,
)


def at(x: float, type_: str = "cover", *, name: str | None = None) -> Detection:
    box = (100 * x, 10.0, 100 * x + 20, 30.0)
    return Detection(type_, box, position=(x, 0.0, 0.0), size=(0.05, 0.05), name=name)


def in_hand(parameters: AnchoringParameters = PARAMETERS) -> Anchoring:
    """The cover is attached to the hand at 0.5 m, and hidden by it."""
    anchoring = Anchoring(parameters)
    for _ in range(6):
        anchoring.update([at(0.5), at(0.5, "hand", name="hand1")])
    for _ in range(4):
        anchoring.update([at(0.5, "hand", name="hand1")], [("cover", "hand1")])
    return anchoring


def seen_elsewhere(anchoring: Anchoring, frames: int, attachments=(("cover", "hand1"),)):
    anchors = ()
    for _ in range(frames):
        anchors = anchoring.update([at(0.9), at(0.5, "hand", name="hand1")], attachments)
    return {anchor.name: anchor for anchor in anchors}


def test_the_one_cover_is_where_it_is_seen_again_and_again():
    anchors = seen_elsewhere(in_hand(), 3)
    assert anchors["cover"].status is AnchorStatus.VISIBLE
    assert anchors["cover"].position == (0.9, 0.0, 0.0)
    assert anchors["cover"].reason == (
        "It is seen 0.40 m away from where it was believed to be, 3 times in a row, "
        "and there is only one cover."
    )
    assert set(anchors) == {"cover", "hand1"}


def test_two_sightings_may_be_a_wrong_class():
    anchors = seen_elsewhere(in_hand(), 2)
    assert anchors["cover"].status is AnchorStatus.ATTACHED
    assert anchors["cover"].position == (0.5, 0.0, 0.0)


def test_it_goes_on_under_its_own_name():
    anchoring = in_hand()
    seen_elsewhere(anchoring, 3)
    anchors = seen_elsewhere(anchoring, 4, ())
    assert anchors["cover"].position == (0.9, 0.0, 0.0)
    assert "cover-2" not in anchors


def test_it_gets_its_name_back_when_its_first_anchor_was_given_up():
    anchoring = Anchoring(PARAMETERS)
    anchoring.update([at(0.5)])  # too short to be sure of it
    for _ in range(12):
        anchors = anchoring.update([at(0.9)])
    assert [anchor.name for anchor in anchors] == ["cover"]
    assert anchors[0].position == (0.9, 0.0, 0.0)


def test_two_that_are_both_seen_stay_two():
    anchoring = Anchoring(PARAMETERS)
    for _ in range(8):
        anchors = anchoring.update([at(0.5), at(0.9)])
    assert [anchor.name for anchor in anchors] == ["cover", "cover-2"]


def test_without_being_told_so_nothing_is_the_same():
    anchoring = in_hand(replace(PARAMETERS, reunite_after=None))
    assert len(seen_elsewhere(anchoring, 6)) == 3
    assert not any("only one" in anchor.reason for anchor in anchoring.anchors)


@pytest.mark.parametrize("wrong", [0, -1, 1.5, True, "5"])
def test_the_number_of_sightings_is_a_whole_number(wrong):
    with pytest.raises(AnchoringError, match=r"reunite_after is .* whole number of at least 1"):
        AnchoringParameters(reunite_after=wrong)
