"""COCO results, read with and without the file of the images."""

from __future__ import annotations

import json

import pytest

from aapa.detections import Detection
from aapa.errors import AnchoringError, DatasetError
from aapa.formats.coco import read_coco
from aapa.formats.refusals import Skipped

GOOD = {"image_id": 7, "category_id": 3, "bbox": [10, 20.5, 30, 40], "score": 0.5}
IMAGES = {
    "images": [
        {"id": 8, "width": 640, "height": 480},
        {"id": 7, "width": 640, "height": 480, "file_name": "7.jpg"},
    ],
    "categories": [{"id": 3, "name": "cone"}],
}


def written(path, content):
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def test_results_alone(tmp_path):
    path = written(tmp_path / "r.json", [GOOD | {"image_id": 9}, GOOD, GOOD | {"category_id": 0}])
    frames = list(read_coco(path))
    assert [(f.frame, len(f.detections), f.image_size) for f in frames] == [
        (7, 2, None),
        (9, 1, None),
    ]
    assert frames[0].detections == (
        Detection("category-3", (10.0, 20.5, 40.0, 60.5), 0.5),
        Detection("category-0", (10.0, 20.5, 40.0, 60.5), 0.5),
    )


def test_the_images_add_empty_frames_sizes_and_names(tmp_path):
    path = written(tmp_path / "r.json", [GOOD])
    frames = list(read_coco(path, written(tmp_path / "i.json", IMAGES)))
    assert [(f.frame, len(f.detections)) for f in frames] == [(7, 1), (8, 0)]
    assert frames[0].detections[0].type == "cone"
    assert {f.image_size for f in frames} == {(640, 480)}


def test_a_box_outside_of_its_image_is_of_another_resolution(tmp_path):
    path = written(tmp_path / "r.json", [GOOD | {"bbox": [641, 20, 30, 40]}])
    with pytest.raises(AnchoringError, match=r"outside of the picture of 640 x 480 px"):
        list(read_coco(path, written(tmp_path / "i.json", IMAGES)))


def test_annotations_without_scores_do_as_well(tmp_path):
    unscored = {key: value for key, value in GOOD.items() if key != "score"}
    [frame] = read_coco(written(tmp_path / "a.json", {"annotations": [unscored]}))
    assert frame.detections[0].score == 1.0


WRONG = [
    ({"bbox": [1, 2, 3]}, "bbox", "expected a list of 4 numbers"),
    ({"bbox": [1, 2, -3, 4]}, "bbox", "it is -3 px wide and 4 px high; expected above 0"),
    ({"bbox": [1, 2, float("nan"), 4]}, "bbox", "it is nan px wide"),
    ({"bbox": [1, 2, True, 4]}, "bbox", "expected a list of 4 numbers"),
    ({"bbox": [10**400, 2, 3, 4]}, "bbox", "a number that is too large"),
    ({"image_id": "a.jpg"}, "image_id", "expected a whole number of at least 0, found 'a.jpg'"),
    ({"image_id": -1}, "image_id", "at least 0"),
    ({"category_id": None}, "category_id", "found None"),
    ({"score": "0.5"}, "score", "expected a number"),
]


@pytest.mark.parametrize(("change", "key", "text"), WRONG)
def test_a_malformed_entry_names_file_entry_and_key(tmp_path, change, key, text):
    path = written(tmp_path / "r.json", [GOOD, GOOD | change])
    with pytest.raises(DatasetError) as caught:
        list(read_coco(path))
    assert (caught.value.path, caught.value.key) == (str(path), f"[1].{key}")
    assert text in str(caught.value)


def test_a_score_beyond_1_an_infinite_box_and_a_missing_key(tmp_path):
    for change, text in [
        (GOOD | {"score": 2}, "has score 2.0"),
        (GOOD | {"bbox": [float("inf"), 1, 1, 1]}, "finite"),
        ({"image_id": 1, "category_id": 1}, "bbox: it is missing"),
        ([1], "expected an object"),
    ]:
        with pytest.raises(DatasetError, match=rf"r.json: \[0\].*{text}"):
            list(read_coco(written(tmp_path / "r.json", [change])))


def test_malformed_entries_can_be_passed_over_and_are_counted(tmp_path):
    skipped = Skipped()
    entries = [GOOD, *(GOOD | change for change, _, _ in WRONG), 5]
    [frame] = read_coco(written(tmp_path / "r.json", entries), refused=skipped)
    assert len(frame.detections) == 1
    assert skipped.count == len(WRONG) + 1


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ('[{"image_id": 1, "bb', "at line 1, column .* was it cut off"),
        ('{"frame": 0}\n{"frame": 1}', "at line 2, column 1; is it JSON Lines"),
        ("[" * 100_000, "nested too deeply"),
        ("[" + "1" * 5000 + "]", "a number that is too long"),
        ("3", "expected a list of results"),
        ('{"images": []}', "annotations: expected a list of results"),
    ],
)
def test_a_malformed_file_is_refused(tmp_path, content, text):
    with pytest.raises(DatasetError, match=rf"r.json: .*{text}"):
        list(read_coco(written(tmp_path / "r.json", content)))


def test_a_file_that_is_no_text_or_is_not_there(tmp_path):
    path = tmp_path / "r.json"
    path.write_bytes(b'["\xff"]')
    with pytest.raises(DatasetError, match="not UTF-8"):
        list(read_coco(path))
    with pytest.raises(AnchoringError, match="cannot read"):
        list(read_coco(tmp_path / "none.json"))


@pytest.mark.parametrize(
    ("images", "text"),
    [
        ([], "expected an object"),
        ({}, "images: it is missing"),
        ({"images": {}}, "images: expected a list"),
        ({"images": [{"id": "7"}]}, r"images\[0\].id: expected a whole number"),
        ({"images": [{"id": 7}, {"id": 7}]}, r"images\[1\].id: there are two images 7"),
        ({"images": [{"id": 7, "width": 0, "height": 4}]}, r"images\[0\].width: expected"),
        ({"images": [{"id": 7}], "categories": [{"id": 1}]}, r"categories\[0\].name: it is"),
        ({"images": [{"id": 7}], "categories": [{"id": 1, "name": ""}]}, "expected a name"),
        ({"images": [{"id": 1}]}, r"\[0\].image_id: there is no image 7"),
        ({"images": [{"id": 7}], "categories": [{"id": 1, "name": "x"}]}, "no category 3"),
    ],
)
def test_a_file_of_images_that_does_not_fit_is_refused(tmp_path, images, text):
    path = written(tmp_path / "r.json", [GOOD])
    with pytest.raises(DatasetError, match=text):
        list(read_coco(path, written(tmp_path / "i.json", images)))
