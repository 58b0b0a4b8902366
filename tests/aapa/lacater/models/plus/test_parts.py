"""Things, paths and belonging, each by itself."""

from __future__ import annotations

import pytest

from aapa import AnchoringError, Attachment
from aapa.lacater.generator.motion import slide
from aapa.lacater.models.plus import Ideas
from aapa.lacater.models.plus.belonging import Belonging
from aapa.lacater.models.plus.containment import container_at, on_floor
from aapa.lacater.models.plus.ground import GroundView
from aapa.lacater.models.plus.paths import Path
from aapa.lacater.models.plus.solids import SNITCH_SOLID, solid_of
from aapa.lacater.models.plus.things import Thing

VIEW = GroundView(height=5.3, pitch=0.5, focal=350.0, size=(320, 240))


def seen(thing, *boxes):
    for box in boxes:
        thing.offer([box], 2.5, strict=True)


def test_boxes_at_rest_are_averaged():
    thing = Thing(0)
    seen(thing, (10, 10, 20, 20), (11, 10, 21, 22))
    assert thing.mean == (10.5, 10.0, 20.5, 21.0)


def test_a_far_box_is_not_believed_until_it_insists():
    thing = Thing(0)
    seen(thing, *[(10, 10, 20, 20)] * 5)
    far = (100, 100, 110, 110)
    seen(thing, far, far)
    assert thing.last == (10, 10, 20, 20)
    seen(thing, far)
    assert thing.last == far
    assert thing.mean == far


def test_what_moves_unreported_is_noticed_and_comes_to_rest_again():
    thing = Thing(0)
    seen(thing, *[(10, 10, 20, 20)] * 3)
    seen(thing, (14, 10, 24, 20), (18, 10, 28, 20), (22, 10, 32, 20))
    assert thing.roaming
    assert thing.last == (22, 10, 32, 20)
    seen(thing, *[(22, 10, 32, 20)] * 6)
    assert thing.is_settled
    assert thing.mean == (22, 10, 32, 20)


def test_the_end_of_a_path_follows_from_its_beginning():
    path = Path((1.0, 9.0), 10, 34, lifted=False)
    travel = slide(25).filmed.travel
    assert path.place(20) is None
    for frame in range(11, 18):
        share = travel[frame - 10]
        path.add(frame, (1.0 + 2.0 * share, 9.0 - 3.0 * share))
    assert path.place(34) == pytest.approx((3.0, 6.0))
    assert path.place(10) == pytest.approx((1.0, 9.0))


def test_a_report_counts_for_more_than_what_is_inferred():
    belonging = Belonging()
    belonging.infer("snitch", "cone-1")
    assert belonging.outermost("snitch") == "cone-1"
    belonging.report((Attachment("snitch", "cone-2"),))
    assert belonging.parents == {"snitch": "cone-2"}
    belonging.report(())
    assert belonging.parents == {}


def test_what_is_denied_is_believed_once_it_is_reported_anew():
    belonging = Belonging()
    pair = (Attachment("snitch", "cone"),)
    belonging.report(pair)
    belonging.deny("cone")
    assert belonging.parents == {}
    belonging.report((*pair, Attachment("ball", "box")))
    assert belonging.parents == {"ball": "box"}
    belonging.report(())
    belonging.report(tuple(pair))
    assert belonging.parents == {"snitch": "cone"}


def test_what_is_inferred_never_runs_in_a_circle():
    belonging = Belonging()
    belonging.report((Attachment("a", "b"),))
    belonging.infer("b", "a")
    assert belonging.parents == {"a": "b"}


def test_reports_in_a_circle_are_refused():
    with pytest.raises(AnchoringError, match="circle"):
        Belonging().report((Attachment("a", "b"), Attachment("b", "a")))


def test_only_a_larger_cone_on_the_very_place_contains():
    large, small = solid_of(0), solid_of(141)
    at, beside = VIEW.box(large, (0.5, 9.0)), VIEW.box(large, (1.5, 9.0))
    cones = [("at", large, at), ("beside", large, beside)]
    assert container_at(VIEW, (0.55, 9.05), SNITCH_SOLID.radius, cones) == "at"
    assert container_at(VIEW, (0.55, 9.05), SNITCH_SOLID.radius, cones[1:]) is None
    tiny = [("tiny", small, VIEW.box(small, (0.5, 9.0)))]
    assert container_at(VIEW, (0.55, 9.05), SNITCH_SOLID.radius, tiny) is None


def test_a_lifted_cone_is_not_on_the_floor():
    cone = solid_of(0)
    assert on_floor(VIEW, cone, VIEW.box(cone, (0.0, 9.0))) == pytest.approx((0.0, 9.0), abs=1e-3)
    assert on_floor(VIEW, cone, VIEW.box(cone, (0.0, 9.0), 0.8)) is None


def test_an_unknown_idea_is_refused():
    with pytest.raises(AnchoringError, match="there is no idea 'magic'; known are lock"):
        Ideas().without("magic")
