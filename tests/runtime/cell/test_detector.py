from __future__ import annotations

import itertools
import math
from collections import Counter
from dataclasses import fields, replace

import numpy as np
import pytest

from aapa import Detection
from runtime.cell import PERFECT, Cell, CellParameters, DetectorParameters, SegmentationDetector
from runtime.cell.detector import _most_like
from runtime.cell.sighting import sighting


def nearest_error(detection, cell):
    return min(
        float(np.abs(np.subtract(detection.position, part.position)).max())
        for part in cell.truth.parts.values()
        if part.model.type == detection.type
    )


@pytest.mark.parametrize("seed", range(6))
def test_from_the_look_pose_every_part_is_placed_within_four_millimetres(seed):
    cell = Cell("ur5", seed, CellParameters(detector=PERFECT))
    detections, _ = cell.look()
    found = Counter(detection.type for detection in detections)
    assert found == Counter(part.model.type for part in cell.truth.parts.values())
    assert all(nearest_error(detection, cell) < 0.004 for detection in detections)
    assert all(detection.score > 0.9 for detection in detections)


def test_boxes_and_sizes_are_those_of_the_pixels(cell):
    view = cell.view()
    detections, camera = cell.look()
    for detection in detections:
        x1, y1, x2, y2 = detection.box
        index = int(view.ids[round((y1 + y2) / 2), round((x1 + x2) / 2)])
        rows, columns = np.nonzero(view.ids == index)
        assert detection.box == (columns.min(), rows.min(), columns.max() + 1, rows.max() + 1)
        depth = float(np.median(view.depth[rows, columns]))
        assert detection.size == pytest.approx(
            ((x2 - x1) * depth / camera.focal_px, (y2 - y1) * depth / camera.focal_px)
        )


def test_only_what_a_detector_knows_leaves_it(cell):
    detections, _ = cell.look()
    assert {field.name for field in fields(Detection)} == {
        "type", "box", "score", "position", "size", "name",
    }  # fmt: skip
    assert all(detection.name is None for detection in detections)
    assert detections == sorted(detections, key=lambda detection: detection.box)


def test_the_same_view_and_frame_give_the_same_detections(cell):
    view = cell.view()
    noisy = [SegmentationDetector(3) for _ in range(2)]
    forwards = [noisy[0].detect(view, frame) for frame in range(30)]
    backwards = [noisy[1].detect(view, frame) for frame in reversed(range(30))]
    assert forwards == backwards[::-1]
    assert SegmentationDetector(4).detect(view, 0) != forwards[0]


def test_a_part_out_of_sight_does_not_change_the_others_errors(cell):
    detector = SegmentationDetector(0, DetectorParameters(miss_rate=0, burst_rate=0))
    view = cell.view()
    ids = view.ids.copy()
    ids[ids == 2] = -1
    fewer = detector.detect(replace(view, ids=ids), 5)
    assert set(fewer) == {d for d in detector.detect(view, 5) if d.type != "hubcover"}
    assert len(fewer) == len(view.parts) - 1


def test_errors_come_at_the_rates_asked_for(cell):
    view = cell.view()
    count, frames = len(view.parts), 300
    parameters = replace(
        PERFECT,
        miss_rate=0.05,
        burst_rate=0.1,
        burst_frames=5,
        flicker_rate=0.05,
        position_noise_m=0.002,
    )
    detector = SegmentationDetector(1, parameters)
    runs = [detector.detect(view, frame) for frame in range(frames)]
    share = sum(len(run) for run in runs) / (count * frames)
    assert share == pytest.approx(0.95 * 0.9, abs=0.04)
    truth = Counter(part.model.type for part in view.parts)
    wrong = sum(sum((Counter(d.type for d in run) - truth).values()) for run in runs)
    assert 0.02 < wrong / (count * frames) < 0.06
    case = view.parts[0].position
    cases = [d.position for run in runs for d in run if math.dist(d.position, case) < 0.02]
    assert np.std(cases, axis=0) == pytest.approx([0.002] * 3, rel=0.2)


def test_misses_come_in_bursts(cell):
    view = cell.view()
    detector = SegmentationDetector(2, replace(PERFECT, burst_rate=0.2, burst_frames=6))
    seen = ["hubcover" in {d.type for d in detector.detect(view, frame)} for frame in range(300)]
    assert not all(seen)
    for start in range(0, 300, 6):
        assert len(set(seen[start : start + 6])) == 1


def test_a_part_is_detected_by_its_visible_share(cell):
    view = cell.view()
    rows, columns = np.nonzero(view.ids == 2)
    whole = view.silhouettes[2]
    assert whole is not None
    for hidden, expected in ((0.40, True), (0.60, False)):
        ids = view.ids.copy()
        count = round(hidden * whole.pixels)
        ids[rows[:count], columns[:count]] = -1
        found = SegmentationDetector(0, PERFECT).detect(replace(view, ids=ids), 0)
        assert ("hubcover" in {d.type for d in found}) is expected


def test_a_part_is_detected_by_its_pixels_and_distance(cell):
    view = cell.view()

    def types(parameters, seen):
        return {d.type for d in SegmentationDetector(0, parameters).detect(seen, 0)}

    assert "plug" not in types(replace(PERFECT, min_pixels=200), view)
    assert "case" in types(replace(PERFECT, min_pixels=200), view)
    assert types(PERFECT, replace(view, camera=replace(view.camera, near_m=1.0))) == set()


def half_hidden(view, index, hidden):
    """The view with a share of a part's outline covered."""
    rows, columns = np.nonzero(view.ids == index)
    ids = view.ids.copy()
    count = round(hidden * view.silhouettes[index].pixels)
    ids[rows[:count], columns[:count]] = -1
    return replace(view, ids=ids)


def test_what_is_half_hidden_comes_and_goes_for_a_while_each(cell):
    view = half_hidden(cell.view(), 2, 0.40)
    parameters = replace(PERFECT, sure_share=0.7)
    detector = SegmentationDetector(1, parameters)
    seen = ["hubcover" in {d.type for d in detector.detect(view, frame)} for frame in range(400)]
    assert np.mean(seen) == pytest.approx(0.5, abs=0.17)  # half way from 0.5 to 0.7
    changes = sum(a != b for a, b in itertools.pairwise(seen))
    assert 8 < changes < 80  # neither stuck nor drawn anew each frame


def test_it_is_recognised_from_one_angle_and_not_from_another(cell):
    view = cell.view()
    parameters = replace(PERFECT, sure_angle_rad=math.radians(50), lost_angle_rad=math.radians(80))
    part = view.parts[2]

    def rate(angle):
        x, _, z = part.position
        place = (x + 0.5 * math.sin(angle), part.position[1], z + 0.5 * math.cos(angle))
        aside = replace(view, camera=replace(view.camera, position=place))
        detector = SegmentationDetector(3, parameters)
        return detector._chance(sighting(aside, 2), 1.0)

    assert rate(math.radians(45)) == 1
    assert rate(math.radians(65)) == pytest.approx(0.5)
    assert rate(math.radians(85)) == 0


def test_bad_light_makes_a_part_harder_to_recognise(cell):
    view = half_hidden(cell.view(), 2, 0.15)
    detector = SegmentationDetector(3, replace(PERFECT, sure_share=0.8, drift=0.3))
    assert detector._chance(sighting(view, 2), 1.0) == 1
    assert detector._chance(sighting(view, 2), 0.0) == pytest.approx(0.05 / 0.3, abs=0.02)


def test_when_the_light_flickers_every_part_does(cell):
    view = cell.view()
    parameters = replace(PERFECT, shimmer_rate=0.2, shimmer_frames=10, shimmer_miss=0.5)
    counts = [len(SegmentationDetector(5, parameters).detect(view, f)) for f in range(300)]
    windows = [counts[start : start + 10] for start in range(0, 300, 10)]
    calm = [window for window in windows if min(window) == len(view.parts)]
    assert 0.65 < len(calm) / len(windows) < 0.92
    rough = [count for window in windows if window not in calm for count in window]
    assert np.mean(rough) == pytest.approx(len(view.parts) / 2, abs=0.7)


def test_a_part_is_taken_for_the_one_most_like_it_for_some_frames(cell):
    view = cell.view()
    parameters = replace(PERFECT, switch_rate=0.2, switch_frames=3)
    truth = Counter(part.model.type for part in view.parts)
    for frame in range(0, 90, 3):
        runs = [SegmentationDetector(5, parameters).detect(view, frame + k) for k in range(3)]
        kinds = [Counter(d.type for d in run) for run in runs]
        assert kinds[0] == kinds[1] == kinds[2]
        assert set(kinds[0]) <= set(truth)
    like = {part.model.type: part.model for part in view.parts}
    assert _most_like(like["input"], like) == "output"
    assert _most_like(like["output"], like) == "input"


def test_another_thing_in_view_changes_nobody_elses_errors(cell):
    before = [cell.look()[0] for _ in range(20)]
    other = Cell("ur5", 2, CellParameters(detector=PERFECT))
    other.person.ask("reach-in", [("bearing-2", None)])
    assert other.person.place is not None  # somebody stands there, and is not in view yet
    assert [other.look()[0] for _ in range(20)] == before
