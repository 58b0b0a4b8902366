"""Things, paths and belonging, each by itself."""

from __future__ import annotations

from dataclasses import replace

import pytest

from aapa import AnchoringError, Attachment
from aapa.lacater.generator.motion import slide
from aapa.lacater.models.plus import Ideas
from aapa.lacater.models.plus.appearance import Appearance
from aapa.lacater.models.plus.belonging import Belonging
from aapa.lacater.models.plus.containment import REACH, distances, on_floor
from aapa.lacater.models.plus.ground import GroundView
from aapa.lacater.models.plus.hiding import behind
from aapa.lacater.models.plus.paths import Path
from aapa.lacater.models.plus.rivals import OUTSIDE, Rivals
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


def test_only_larger_cones_upon_the_floor_may_contain_and_are_ranked_by_their_distance():
    large, small = solid_of(0), solid_of(141)
    place = (0.55, 9.05)
    cones = [
        ("at", large, VIEW.box(large, (0.5, 9.0))),
        ("beside", large, VIEW.box(large, (1.5, 9.0))),
        ("tiny", small, VIEW.box(small, (0.5, 9.0))),
        ("lifted", large, VIEW.box(large, (0.5, 9.0), 0.8)),
    ]
    far = distances(VIEW, place, SNITCH_SOLID.radius, cones)
    assert far == {"at": pytest.approx(0.0707, abs=1e-3), "beside": pytest.approx(0.951, abs=1e-3)}
    assert far["at"] < REACH < far["beside"]


def test_what_stands_on_the_place_is_believed_more_and_more_and_the_rest_less():
    rivals = Rivals()
    sure = []
    for _ in range(4):
        rivals.weigh({"at": 0.05, "beside": 0.5}, told=False)
        ranked = rivals.ranked
        assert ranked[0].container == "at"
        assert sum(rival.weight for rival in ranked) == pytest.approx(1.0)
        sure.append(ranked[0].weight)
    assert sure == sorted(sure)
    assert sure[0] < 0.85
    assert sure[-1] > 0.98
    assert [rival.container for rival in ranked] == ["at", OUTSIDE, "beside"]


def test_evidence_turns_the_ranking_round():
    rivals = Rivals()
    rivals.weigh({"first": 0.1}, told=False)
    assert rivals.ranked[0].container == "first"
    rivals.rule_out("first")
    assert rivals.ranked[0].container == OUTSIDE
    rivals.weigh({"second": 0.2}, told=False)
    assert rivals.ranked[0].container == "second"


def test_that_something_was_set_over_something_speaks_for_what_stands_near():
    quiet, told = Rivals(), Rivals()
    quiet.weigh({"cone": 0.28}, told=False)
    told.weigh({"cone": 0.28}, told=True)
    assert told.ranked[0].weight > quiet.ranked[0].weight + 0.15


def test_what_is_not_seen_stays_behind_what_hides_it():
    wall = (100.0, 50.0, 160.0, 120.0)
    hidden = (110.0, 60.0, 130.0, 80.0)
    assert behind(hidden, [wall]) == hidden
    beyond = (170.0, 60.0, 190.0, 80.0)
    # It may stick out by a quarter of its own width.
    assert behind(beyond, [wall]) == (145.0, 60.0, 165.0, 80.0)
    far = (260.0, 60.0, 280.0, 80.0)
    assert behind(far, [wall]) is None
    assert behind(beyond, [(150.0, 60.0, 160.0, 70.0)]) is None
    assert behind(beyond, [(100.0, 10.0, 180.0, 60.0)]) is None


def test_the_size_of_the_snitch_is_learnt_from_all_that_was_seen_of_it():
    larger = replace(SNITCH_SOLID, radius=SNITCH_SOLID.radius * 1.04)
    looks = Appearance()
    places = [(-1.5 + 0.37 * k, 8.0 + 0.23 * k) for k in range(9)]
    for place in places:
        x1, y1, x2, y2 = VIEW.box(larger, place)
        corner = round(x1), round(y1)
        looks.add((*corner, corner[0] + round(x2 - x1), corner[1] + round(y2 - y1)), again=False)
    wide, tall = looks.more(VIEW, places[4])
    real = 0.04 * SNITCH_SOLID.radius
    assert wide == pytest.approx(real, abs=0.3 * real)
    assert tall == pytest.approx(real, abs=0.3 * real)
    looks.forget()
    assert looks.more(VIEW, places[4]) == (0.0, 0.0)


def test_what_was_seen_in_the_air_says_nothing_of_its_size():
    looks = Appearance()
    looks.add(VIEW.box(SNITCH_SOLID, (0.0, 9.0), 2.0), again=False)
    assert looks.more(VIEW, (0.0, 9.0)) == (0.0, 0.0)


def test_a_lifted_cone_is_not_on_the_floor():
    cone = solid_of(0)
    assert on_floor(VIEW, cone, VIEW.box(cone, (0.0, 9.0))) == pytest.approx((0.0, 9.0), abs=1e-3)
    assert on_floor(VIEW, cone, VIEW.box(cone, (0.0, 9.0), 0.8)) is None


def test_an_unknown_idea_is_refused():
    with pytest.raises(AnchoringError, match="there is no idea 'magic'; known are lock"):
        Ideas().without("magic")
