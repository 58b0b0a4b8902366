from __future__ import annotations

import math
from collections import Counter
from dataclasses import fields, replace

import numpy as np
import pytest

from aapa import Detection
from runtime.cell import PERFECT, Cell, CellParameters, DetectorParameters, SegmentationDetector


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
    count, frames = len(view.parts), 400
    parameters = DetectorParameters(
        miss_rate=0.05, burst_rate=0.1, burst_frames=5, flicker_rate=0.05, position_noise_m=0.002
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
    detector = SegmentationDetector(
        2, DetectorParameters(miss_rate=0, burst_rate=0.2, burst_frames=6, flicker_rate=0)
    )
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
