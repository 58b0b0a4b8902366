"""One way in for all formats."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from aapa.errors import AnchoringError, RecordingError
from aapa.formats import InputFormat, guess_format, read_recording
from aapa.formats.refusals import Skipped


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("det/det.txt", "mot"),
        ("a.CSV", "mot"),
        ("results.json", "coco"),
        ("seen.jsonl", "jsonl"),
        ("seen", "jsonl"),
    ],
)
def test_the_name_tells_the_format(name, expected):
    assert guess_format(Path(name)) == expected


def test_the_same_scene_in_three_formats_gives_the_same_frames(tmp_path):
    (tmp_path / "a.jsonl").write_text(
        "".join(
            json.dumps({"frame": n, "detections": [{"type": "cone", "box": [n, 2, n + 5, 9]}]})
            + "\n"
            for n in range(3)
        )
    )
    (tmp_path / "a.txt").write_text("".join(f"{n + 1},-1,{n + 1},3,5,7,1\n" for n in range(3)))
    results = [{"image_id": n, "category_id": 1, "bbox": [n, 2, 5, 7]} for n in range(3)]
    (tmp_path / "a.json").write_text(json.dumps(results))
    images = {"images": [{"id": n} for n in range(3)], "categories": [{"id": 1, "name": "cone"}]}
    (tmp_path / "i.json").write_text(json.dumps(images))
    lines = list(read_recording(tmp_path / "a.jsonl"))
    assert lines == list(read_recording(tmp_path / "a.txt", type_name="cone"))
    assert lines == list(read_recording(tmp_path / "a.json", images=tmp_path / "i.json"))


def test_a_format_named_goes_before_the_name(tmp_path):
    path = tmp_path / "a.jsonl"
    path.write_text("1,-1,1,1,5,5\n")
    assert len(list(read_recording(path, InputFormat.MOT))) == 1


def test_only_coco_has_a_file_of_images(tmp_path):
    with pytest.raises(AnchoringError, match="is read as mot; only coco has a file of images"):
        read_recording(tmp_path / "a.txt", images=tmp_path / "i.json")


def test_lines_out_of_order_are_refused_or_passed_over(tmp_path):
    path = tmp_path / "a.jsonl"
    path.write_text("".join(f'{{"frame": {n}, "detections": []}}\n' for n in (0, 2, 1, 2, 3)))
    with pytest.raises(
        RecordingError, match=r"a.jsonl:3: key 'frame': frame 1 comes after frame 2"
    ):
        list(read_recording(path))
    skipped = Skipped()
    assert [f.frame for f in read_recording(path, refused=skipped)] == [0, 2, 3]
    assert skipped.count == 2
    assert Skipped().report("part") == ""
