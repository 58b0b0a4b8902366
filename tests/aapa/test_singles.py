"""Frames in which no type occurs twice: matched without the solver, and as it would match them."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from aapa.alignment import align
from aapa.anchors import Anchor, AnchorStatus
from aapa.costs import Place
from aapa.detections import Detection
from aapa.singles import align_singles

types = st.sampled_from("abcdef")
corner = st.floats(0, 60)
boxes = st.tuples(corner, corner, corner, corner).map(
    lambda b: (min(b[0], b[2]), min(b[1], b[3]), max(b[0], b[2]), max(b[1], b[3]))
)
anchors = st.lists(
    st.builds(lambda t, box: Anchor(f"{t}-1", t, box, AnchorStatus.VISIBLE), types, boxes),
    max_size=6,
    unique_by=lambda anchor: anchor.type,
)
detections = st.lists(st.builds(Detection, types, boxes), max_size=6, unique_by=lambda d: d.type)


def place(thing):
    x1, y1, x2, y2 = thing.box
    return Place(thing.type, ((x1 + x2) / 2, (y1 + y2) / 2), thing.box)


@given(anchors, detections, st.sampled_from([1.0, 100.0, 900.0, 1e5]))
def test_it_gives_what_the_alignment_gives(old, new, tau):
    found = align_singles(old, new, tau)
    alignment = align([place(a) for a in old], [place(d) for d in new], tau)
    assert [(a, d) for a, d, _ in found.pairs] == [(old[i], new[j]) for i, j in alignment.pairs]
    assert found.lost == [old[i] for i in alignment.lost]
    assert found.appeared == [new[j] for j in alignment.appeared]
    assert all(squared <= tau for _, _, squared in found.pairs)


def test_a_type_that_occurs_twice_is_left_to_the_solver():
    box = (0.0, 0.0, 10.0, 10.0)
    one, two = (Anchor(f"cone-{n}", "cone", box, AnchorStatus.VISIBLE) for n in (1, 2))
    seen = Detection("cone", box)
    assert align_singles([one, two], [], 100.0) is None
    assert align_singles([], [seen, seen], 100.0) is None
    assert align_singles([one], [seen], 100.0).pairs == [(one, seen, 0.0)]


def test_a_detection_further_than_tau_is_something_new():
    one = Anchor("cone-1", "cone", (0.0, 0.0, 10.0, 10.0), AnchorStatus.VISIBLE)
    at_tau, beyond = Detection("cone", (10.0, 0.0, 20.0, 10.0)), Detection("cone", (0, 20, 10, 31))
    assert align_singles([one], [at_tau], 100.0).pairs == [(one, at_tau, 100.0)]
    assert align_singles([one], [beyond], 100.0) == ([], [one], [beyond])


def test_what_appears_keeps_the_detector_s_order():
    # The first two are too far from their anchors, and count as new beside the third.
    here = (0.0, 0.0, 4.0, 4.0)
    old = [Anchor(f"{name}-1", name, here, AnchorStatus.VISIBLE) for name in ("a", "b")]
    new = [Detection(name, (90.0, 0.0, 94.0, 4.0)) for name in ("b", "c", "a")]
    found = align_singles(old, new, 100.0)
    assert (found.pairs, found.lost) == ([], old)
    assert found.appeared == new
