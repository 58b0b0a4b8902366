"""`icarus track`: the paper's containment, from recorded detections and actions."""

from __future__ import annotations

import json
import re
from dataclasses import fields
from pathlib import Path

import pytest

from aapa import AnchoringError, AnchoringParameters, Detection
from aapa.jsonl import RecordedAction, RecordedFrame, read_frames
from icarus_lite import load_domain
from runtime.errors import UsageError
from runtime.tracking import read_parameters, track

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


@pytest.mark.parametrize("numbers", [(0, 2, 1), (0, 1, 1)])
def test_frames_out_of_order_are_refused(numbers: tuple[int, ...]) -> None:
    frames = [RecordedFrame(number, ()) for number in numbers]
    with pytest.raises(AnchoringError, match=r"frame 1 comes after frame [12]; a recording is in"):
        list(track(frames, AnchoringParameters()))


def test_an_action_that_names_what_was_never_seen_is_told_once(cater: Path) -> None:
    cone = Detection("cone", (90, 85, 130, 125))
    action = RecordedAction("contain", ("cone-1", "snitch-9"))
    frames = [RecordedFrame(n, (cone,), (action,) if n > 1 else ()) for n in range(5)]
    notes: list[str] = []
    anchored = list(track(frames, AnchoringParameters(), load_domain(cater), notes.append))
    assert [anchor.name for anchor in anchored[-1][1]] == ["cone-1"]
    assert len(notes) == 1
    assert notes[0].startswith("frame 2: (contain …) names snitch-9, which has not been anchored")


@pytest.mark.parametrize(
    ("name", "args", "reason"),
    [
        ("contian", ("cone-1", "cone-1"), "is no action of the domain (did you mean contain?); it"),
        ("explode", (), "(explode …) is no action of the domain; it attaches and detaches nothing"),
        (
            "contain",
            ("cone-1",),
            "(contain cone-1) names 1 of the 2 objects it is done with; it",
        ),
    ],
)
def test_an_action_that_means_nothing_is_told_once(
    cater: Path, name: str, args: tuple[str, ...], reason: str
) -> None:
    cone = Detection("cone", (90, 85, 130, 125))
    action = RecordedAction(name, args)
    frames = [RecordedFrame(n, (cone,), (action,) if n > 1 else ()) for n in range(5)]
    notes: list[str] = []
    list(track(frames, AnchoringParameters(), load_domain(cater), notes.append))
    assert len(notes) == 1
    assert notes[0].startswith("frame 2: (")
    assert reason in notes[0]


def test_the_actions_of_the_domain_are_not_remarked_on(cater: Path) -> None:
    cone = Detection("cone", (90, 85, 130, 125))
    actions = tuple(RecordedAction(name, ("cone-1",)) for name in ("slide", "rotate", "pick-place"))
    notes: list[str] = []
    frames = [RecordedFrame(0, (cone,), actions)]
    list(track(frames, AnchoringParameters(), load_domain(cater), notes.append))
    assert notes == []


def test_the_parameters_come_from_a_file_and_tau_goes_before_it(tmp_path: Path) -> None:
    path = tmp_path / "anchoring.yaml"
    path.write_text("tau: 900\nconfidence_gain: 0.25\nunique_types: [snitch]\n")
    assert read_parameters(None) == AnchoringParameters()
    parameters = read_parameters(path)
    assert (parameters.tau, parameters.confidence_gain) == (900, 0.25)
    assert parameters.unique_types == {"snitch"}
    assert read_parameters(path, 50.0).tau == 50


def test_the_page_for_users_has_every_parameter(root: Path) -> None:
    page = (root / "docs" / "how-to" / "track.md").read_text()
    rows = [line.split("|")[1] for line in page.splitlines() if line.startswith("| `")]
    named = {name for row in rows for name in re.findall("`([a-z_]+)`", row)}
    assert {field.name for field in fields(AnchoringParameters)} <= named


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("tau: [", "is no YAML"),
        ("- 1", "expected lines such as `tau: 6500`"),
        ("tua: 5", "unknown anchoring parameter 'tua'; did you mean 'tau'"),
        ("tau: -5", "tau is -5; it has to be above 0"),
        ("cost: nearest", "cost is 'nearest'"),
    ],
)
def test_a_wrong_file_of_parameters_is_refused(tmp_path: Path, text: str, reason: str) -> None:
    path = tmp_path / "anchoring.yaml"
    path.write_text(text)
    with pytest.raises((UsageError, AnchoringError), match=reason):
        read_parameters(path)


def test_a_missing_file_of_parameters_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read"):
        read_parameters(tmp_path / "nowhere.yaml")
