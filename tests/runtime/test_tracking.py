"""`icarus track`: the paper's containment, from recorded detections and actions."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from aapa import AnchoringError, AnchoringParameters
from aapa.jsonl import RecordedFrame, read_frames
from icarus_lite import load_domain
from runtime.tracking import track

SNITCH = [100, 100, 120, 120]


def box(x: float, y: float, size: float = 40) -> list[float]:
    return [x, y, x + size, y + size]


def recording(path: Path) -> Path:
    """A cone is set over the snitch and slides 60 px to the right; nobody sees the snitch again."""
    rows = []
    for frame in range(40):
        cone = box(90, 85) if frame >= 12 else box(200, 85)
        if frame >= 20:
            cone = box(90 + 3 * (frame - 19), 85)
        detections = [{"type": "cone", "box": cone, "score": 0.9}]
        if frame < 12:
            detections.append({"type": "snitch", "box": SNITCH, "score": 0.9})
        row = {"frame": frame, "width": 320, "height": 240, "detections": detections}
        if frame == 12:
            row["actions"] = [{"name": "contain", "args": ["cone-1", "snitch-1"]}]
        rows.append(json.dumps(row))
    file = path / "seen.jsonl"
    file.write_text("\n".join(rows) + "\n")
    return file


@pytest.fixture
def cater(root: Path) -> Path:
    return root / "domains" / "cater.icr"


def last(anchored: list) -> dict:
    return {anchor.name: anchor for anchor in anchored[-1][1]}


def test_a_contained_snitch_goes_where_its_cone_goes(tmp_path: Path, cater: Path) -> None:
    parameters = AnchoringParameters(tau=20_000)
    anchored = list(track(read_frames(recording(tmp_path)), parameters, load_domain(cater)))
    snitch = last(anchored)["snitch-1"]
    assert (snitch.status, snitch.parent) == ("attached", "cone-1")
    assert snitch.box == pytest.approx((160, 100, 180, 120))


def test_without_a_domain_it_stays_where_it_was_last_seen_and_fades(tmp_path: Path) -> None:
    anchored = list(track(read_frames(recording(tmp_path)), AnchoringParameters(tau=20_000)))
    covered = {anchor.name: anchor for anchor in anchored[15][1]}["snitch-1"]
    assert (covered.box, covered.parent) == (pytest.approx(tuple(SNITCH)), None)
    assert "snitch-1" not in last(anchored)  # the cone has gone, and it is not where it was


def test_an_action_at_frame_e_moves_the_child_from_the_next_frame_on(
    tmp_path: Path, cater: Path
) -> None:
    parameters = AnchoringParameters(tau=20_000)
    anchored = dict(track(read_frames(recording(tmp_path)), parameters, load_domain(cater)))
    at = {n: {a.name: a for a in anchors}["snitch-1"] for n, anchors in anchored.items()}
    assert at[12].status == "occluded"
    assert at[13].status == "attached"


def test_the_image_size_must_not_change() -> None:
    frames = [RecordedFrame(0, (), image_size=(320, 240)), RecordedFrame(1, (), image_size=(9, 9))]
    with pytest.raises(AnchoringError, match="frame 1 is 9 x 9 px"):
        list(track(frames, AnchoringParameters()))
