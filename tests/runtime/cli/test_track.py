"""`icarus track` on what others record, and in formats that others score."""

from __future__ import annotations

import io
import json
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import NamedTuple

import pytest

from runtime.cli import main


class Done(NamedTuple):
    status: int
    out: str
    err: str


def track(*args: str | Path) -> Done:
    out, err = io.StringIO(), io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", "track", "--detections", *map(str, args)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = argv
    return Done(int(ended.value.code or 0), out.getvalue(), err.getvalue())


def two_walkers(path: Path) -> Path:
    """Two people cross a picture; the second is not seen in frame 3."""
    lines = []
    for frame in range(1, 6):
        lines.append(f"{frame},-1,{10 * frame},50,20,40,0.9,-1,-1,-1")
        if frame != 3:
            lines.append(f"{frame},-1,{400 - 10 * frame},50,20,40,0.8,-1,-1,-1")
    path.write_text("\n".join(lines) + "\n")
    return path


def test_mot_in_and_mot_out(tmp_path: Path) -> None:
    out = tmp_path / "tracks.txt"
    done = track(two_walkers(tmp_path / "det.txt"), "--out", out)
    assert (done.status, done.err) == (0, "")
    rows = [line.split(",") for line in out.read_text().splitlines()]
    seen = {(int(frame), int(number)): row for frame, number, *row in rows}
    assert {number for _, number in seen} == {1, 2}
    assert [seen[frame, 1][0] for frame in range(1, 6)] == ["10", "20", "30", "40", "50"]
    assert seen[4, 2][:4] == ["360", "50", "20", "40"]
    assert {len(row) for row in rows} == {10}


def test_mot_in_and_json_lines_out_name_the_type(tmp_path: Path) -> None:
    done = track(two_walkers(tmp_path / "det.txt"), "--type", "person", "--visible-only")
    rows = [json.loads(line) for line in done.out.splitlines()]
    assert [row["frame"] for row in rows] == [0, 1, 2, 3, 4]
    assert [len(row["anchors"]) for row in rows] == [2, 2, 1, 2, 2]
    assert rows[0]["anchors"][0]["name"] == "person-1"


def test_each_anchor_says_why_it_is_believed_to_be_there(tmp_path: Path) -> None:
    done = track(two_walkers(tmp_path / "det.txt"), "--reasons")
    rows = [json.loads(line) for line in done.out.splitlines()]
    reasons = {a["name"]: a["reason"] for a in rows[2]["anchors"]}
    assert reasons == {
        "object-1": "It is seen 10 px from its last place.",
        "object-2": "It is not seen and it had been seen too little to be reasoned about; "
        "its confidence falls to 0.1.",
    }
    mot = track(tmp_path / "det.txt", "--reasons", "--to", "mot")
    assert (mot.status, mot.out) == (2, "")
    assert mot.err.startswith("MOT text has no place for reasons")


def seen_by_a_moving_camera(path: Path, cameras: list[float]) -> Path:
    """A plug at rest, 1 m ahead of a camera that goes along x; it is detected where it shows."""
    lines = []
    for frame, x in enumerate(cameras):
        u = 160 + 300 * (0.5 - x)
        shows = 10 <= u <= 310
        plug = {"type": "plug", "box": [u - 9, 111, u + 9, 129], "position": [0.5, 0.0, 1.0]}
        camera = {
            "focal_px": 300,
            "position": [x, 0, 0],
            "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        }
        lines.append(
            {
                "frame": frame,
                "width": 320,
                "height": 240,
                "camera": camera,
                "detections": [plug] if shows else [],
            }
        )
    path.write_text("\n".join(map(json.dumps, lines)) + "\n")
    return path


def test_the_camera_may_move_and_look_away(tmp_path: Path) -> None:
    places = [0.5, 0.4, 0.6, 0.1, 0.8, 0.5, 2.5, 2.6, 0.9]
    seen = seen_by_a_moving_camera(tmp_path / "seen.jsonl", places)
    (tmp_path / "base.yaml").write_text("space: base\ntau: 0.01\n")
    done = track(seen, "--anchoring", tmp_path / "base.yaml", "--reasons")
    assert (done.status, done.err) == (0, "")
    rows = [json.loads(line)["anchors"] for line in done.out.splitlines()]
    assert [[anchor["name"] for anchor in row] for row in rows] == [["plug-1"]] * len(places)
    assert [row[0]["status"] for row in rows[5:]] == [
        "visible",
        "out-of-view",
        "out-of-view",
        "visible",
    ]
    assert rows[6][0]["reason"] == "It lies outside the image."
    # Told in the picture of the camera as it is now.
    assert rows[6][0]["box"] == pytest.approx([-449, 111, -431, 129])


@pytest.mark.parametrize(
    ("camera", "reason"),
    [
        (7, "key 'camera': expected focal_px, position and rotation, found a number"),
        ({"focal_px": "x"}, "key 'focal_px': expected a number, found text"),
        ({"focal_px": 1, "rotation": []}, "expected a position of 3 numbers and a rotation of 3 x"),
        (
            {"focal_px": 1, "position": [0, 0, 0], "rotation": [[1, 0, 0]] * 3},
            "the camera's rotation is not a rotation",
        ),
        (
            {"focal_px": 0, "position": [0, 0, 0], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]},
            "the camera's focal length is 0 px; expected above 0",
        ),
    ],
)
def test_a_malformed_camera_is_refused(tmp_path: Path, camera: object, reason: str) -> None:
    line = {"frame": 0, "width": 320, "height": 240, "camera": camera, "detections": []}
    path = tmp_path / "seen.jsonl"
    path.write_text(json.dumps(line) + "\n")
    done = track(path)
    assert (done.status, done.out) == (2, "")
    assert reason in done.err
    path.write_text(json.dumps({k: v for k, v in line.items() if k != "width"}) + "\n")
    assert track(path).status == 2


def test_what_scores_too_low_is_left_out(tmp_path: Path) -> None:
    done = track(two_walkers(tmp_path / "det.txt"), "--min-score", "0.85", "--to", "mot")
    assert {line.split(",")[1] for line in done.out.splitlines()} == {"1"}


def test_coco_with_images(tmp_path: Path) -> None:
    results = [{"image_id": n, "category_id": 4, "bbox": [5, 5, 9, 9], "score": 1} for n in (3, 5)]
    (tmp_path / "results.json").write_text(json.dumps(results))
    images = {"images": [{"id": n} for n in (3, 4, 5)], "categories": [{"id": 4, "name": "cup"}]}
    (tmp_path / "images.json").write_text(json.dumps(images))
    done = track(tmp_path / "results.json", "--images", tmp_path / "images.json")
    rows = [json.loads(line) for line in done.out.splitlines()]
    assert [row["frame"] for row in rows] == [3, 4, 5]
    assert rows[2]["anchors"][0]["name"] == "cup-1"


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("a.txt", "1,-1,5,5,nan,9,1\n", "a.txt:1: key 'bb_width': expected a finite number"),
        ("a.txt", "1,-1,5,5,-3,9,1\n", "a.txt:1: key 'bb_width': it is -3"),
        ("a.json", '[{"image_id": 1', "a.json: it is not JSON"),
        ("a.json", '[{"image_id": 1}]', "a.json: [0].category_id: it is missing"),
        ("a.jsonl", '{"frame": 1, "detections": []}\n{"frame": 0, "detections": []}',
         "a.jsonl:2: key 'frame': frame 0 comes after frame 1"),
        ("a.jsonl", '{"frame": 1, "detections": [{"type": "x", "box": [9, 0, 1, 1]}]}',
         "a.jsonl:1: key 'detections': detection 1 (x) has the inverted box"),
        ("a.jsonl", '{"frame": 0, "detec', "a.jsonl:1: the line is not JSON"),
    ],
)  # fmt: skip
def test_bad_input_is_status_2_and_one_sentence(
    tmp_path: Path, name: str, text: str, said: str
) -> None:
    (tmp_path / name).write_text(text)
    done = track(tmp_path / name)
    assert done.status == 2
    assert said in done.err
    assert "Traceback" not in done.err
    skipping = track(tmp_path / name, "--skip-malformed")
    if "it is not JSON" in said:  # nothing of the file is left
        assert skipping.status == 2
    else:
        assert skipping.status == 0
        assert "1 malformed part was passed over" in skipping.err
        assert said in skipping.err


def test_an_action_that_names_nothing_known_is_told_and_the_run_goes_on(
    tmp_path: Path, root: Path
) -> None:
    path = tmp_path / "seen.jsonl"
    action = {"name": "contain", "args": ["cone-7", "snitch-1"]}
    rows = [{"frame": 0, "detections": []}, {"frame": 1, "detections": [], "actions": [action]}]
    path.write_text("".join(json.dumps(row) + "\n" for row in rows))
    done = track(path, "--domain", root / "domains" / "cater.icr")
    assert done.status == 0
    assert "names cone-7, which has not been anchored" in done.err


def test_thousands_of_detections_in_a_frame_keep_their_numbers(tmp_path: Path) -> None:
    lines = [
        f"{frame},-1,{60 * (n % 60) + frame},{60 * (n // 60)},30,30,1,-1,-1,-1"
        for frame in (1, 2)
        for n in range(3000)
    ]
    path = tmp_path / "det.txt"
    path.write_text("\n".join(lines) + "\n")
    done = track(path, "--to", "mot")
    seen: dict[int, dict[str, str]] = {1: {}, 2: {}}
    for line in done.out.splitlines():
        frame, number, x, y, *_ = line.split(",")
        seen[int(frame)][f"{int(x) - int(frame)},{y}"] = number
    assert len(seen[1]) == 3000
    assert seen[1] == seen[2]
