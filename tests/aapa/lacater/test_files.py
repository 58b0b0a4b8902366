"""What is written comes back, in the published layout; what is damaged is refused with words."""

from __future__ import annotations

import json
import pickle

import numpy as np
import pytest

from aapa.errors import DatasetError
from aapa.lacater import (
    Dataset,
    PerceptionKind,
    Video,
    frame_masks,
    perfect_perception,
    write_frame_lists,
    write_video,
)
from aapa.lacater.frame_lists import format_frame_list, read_frame_list
from aapa.lacater.layout import labels_path, perception_path, scene_path

NAME = "CLEVR_new_000007"
BOXES = {"Spl_0": (10, 10, 19, 19), "Cone_0": (100, 100, 140, 160)}
RECORD = {"Cone_0": [("_contain", "Spl_0", 2, 3), ("_slide", None, 5, 6)]}


@pytest.fixture
def video(scene_with, labels_for):
    pixels = {"Spl_0": (14.0, 14.0), "Cone_0": (120.0, 130.0)}
    scene = scene_with({"Spl_0": (0, 0, 0.3), "Cone_0": (2, -2, 1)}, RECORD, pixels=pixels)
    labels = labels_for(scene, BOXES)
    exact = labels.boxes + np.array([0.25, -0.25, 0.4, 0.125])
    return Video(NAME, labels, frame_masks(labels, scene), scene, exact)


@pytest.fixture
def folder(tmp_path, video):
    perception = perfect_perception(video.labels, video.scene)
    write_video(tmp_path, video, {PerceptionKind.OD: perception, PerceptionKind.PP: perception})
    write_frame_lists(tmp_path, {NAME: video.masks})
    return tmp_path


def refused(folder, kind=PerceptionKind.OD):
    dataset = Dataset(folder)
    with pytest.raises(DatasetError) as caught:
        dataset.perception(dataset.video(NAME), kind)
    return str(caught.value)


def rewrite(path, change):
    entry = json.loads(path.read_text())
    change(entry)
    path.write_text(json.dumps(entry))


def test_the_layout_is_the_published_one(folder):
    files = sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())
    assert files == [
        "containment_and_occlusions/containment_annotations.txt",
        "containment_and_occlusions/containment_only_static_annotations.txt",
        "containment_and_occlusions/containment_with_move_annotations.txt",
        "containment_and_occlusions/visibility_rate_gt_0.txt",
        "containment_and_occlusions/visibility_rate_gt_30.txt",
        "containment_and_occlusions/visibility_rate_gt_99.txt",
        f"exact_boxes/{NAME}.npy",
        f"labels/{NAME}_bb.json",
        f"od_perception/{NAME}.pkl",
        f"perfect_perception/{NAME}.pkl",
        f"scenes/{NAME}.json",
    ]


def test_labels_hold_corner_and_size_by_key(folder):
    entry = json.loads(labels_path(folder, NAME).read_text())
    assert entry == {
        "small_gold_spl_metal_Spl_0": [[10, 10, 9, 9]] * 10,
        "large_green_cone_rubber_Cone_0": [[100, 100, 40, 60]] * 10,
    }


def test_a_frame_list_is_a_name_a_tab_and_numbers(folder):
    lists = folder / "containment_and_occlusions"
    contained = (lists / "containment_only_static_annotations.txt").read_text()
    assert contained == f"{NAME}\t3,4,7,8,9\n"
    assert (lists / "containment_with_move_annotations.txt").read_text() == f"{NAME}\t5,6\n"


def test_a_scene_holds_its_places_by_frame_and_its_record_by_instance(folder):
    entry = json.loads(scene_path(folder, NAME).read_text())
    assert entry["movements"] == {
        "Spl_0": [],
        "Cone_0": [["_contain", "Spl_0", 2, 3], ["_slide", None, 5, 6]],
    }
    assert entry["objects"][1]["locations"]["10"] == [2.0, -2.0, 1.0]
    assert entry["camera"] == [7.0, -6.0, 5.0]


def test_a_pickle_holds_an_array_of_boxes_and_one_of_classes_for_each_frame(folder):
    with perception_path(folder, NAME, PerceptionKind.OD).open("rb") as stream:
        content = pickle.load(stream)
    assert sorted(content) == ["bb", "labels"]
    assert content["bb"][0].tolist() == [[10, 10, 19, 19], [100, 100, 140, 160]]
    assert content["bb"][3].tolist() == [[100, 100, 140, 160]]
    assert content["labels"][0].tolist() == [140, 48]


def test_everything_comes_back(folder, video):
    dataset = Dataset(folder)
    assert dataset.videos == (NAME,)
    back = dataset.video(NAME)
    assert back.labels.keys == video.labels.keys
    assert (back.labels.boxes == video.labels.boxes).all()
    assert (back.exact_boxes == video.exact_boxes.astype(np.float32)).all()
    for name, mask in video.masks.named().items():
        assert (back.masks.named()[name] == mask).all()
    assert back.scene.movements == video.scene.movements
    assert back.scene.directions == video.scene.directions
    assert back.scene.relationships == video.scene.relationships
    assert back.scene.camera == video.scene.camera
    for mine, theirs in zip(back.scene.objects, video.scene.objects, strict=True):
        assert (mine.key, mine.pixel_coords, mine.sized) == (
            theirs.key,
            theirs.pixel_coords,
            theirs.sized,
        )
        assert (mine.locations == theirs.locations).all()


def test_writing_twice_gives_the_same_bytes(folder, video):
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    perception = perfect_perception(video.labels, video.scene)
    write_video(folder, video, {PerceptionKind.OD: perception, PerceptionKind.PP: perception})
    write_frame_lists(folder, {NAME: video.masks})
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before


def test_frame_lists_and_perfect_perception_are_derived_where_their_folders_are_absent(
    folder, video
):
    expected = Dataset(folder).perception(video, PerceptionKind.PP)
    for name in ("containment_and_occlusions", "perfect_perception"):
        (folder / name).rename(folder.parent / f"{folder.name}-{name}")
    dataset = Dataset(folder)
    back = dataset.video(NAME)
    for name, mask in video.masks.named().items():
        assert (back.masks.named()[name] == mask).all()
    derived = dataset.perception(back, PerceptionKind.PP)
    for mine, theirs in zip(derived.boxes, expected.boxes, strict=True):
        assert (mine == theirs).all()


def test_a_file_that_is_no_label_file_is_no_video(folder):
    (folder / "labels" / "README.txt").write_text("hello")
    (folder / "labels" / ".CLEVR_new_000008_bb.json.12.part").write_text("half")
    (folder / "labels" / ".CLEVR_new_000009_bb.json").write_text("{}")
    assert Dataset(folder).videos == (NAME,)


def test_the_folder_above_is_told_from_that_of_a_split(folder):
    (folder.parent / "above").mkdir()
    folder.rename(folder.parent / "above" / "test_data")
    with pytest.raises(DatasetError, match=r"no folder labels/ in it; did you mean .*test_data\?"):
        Dataset(folder.parent / "above")


def test_an_empty_folder_is_no_data_set(tmp_path):
    (tmp_path / "labels").mkdir()
    with pytest.raises(DatasetError, match=r"labels: holds no …_bb\.json"):
        Dataset(tmp_path)


LABELS_WRONG = [
    (lambda e: e.clear(), "expected an object of lists of boxes"),
    (lambda e: e["small_gold_spl_metal_Spl_0"].pop(), "has 10 boxes, the first object has 9"),
    (lambda e: e.update(x="text"), "x: expected a list of boxes"),
    (lambda e: e["small_gold_spl_metal_Spl_0"][3].pop(), "expected boxes of 4 numbers"),
    (
        lambda e: e["small_gold_spl_metal_Spl_0"].__setitem__(3, [0.5, 1, 2, 3]),
        "in whole px",
    ),
    (
        lambda e: e["small_gold_spl_metal_Spl_0"].__setitem__(3, [10, 10, -4, 9]),
        r"frame 3 has the box \[10, 10, -4, 9\]",
    ),
    (
        lambda e: e["small_gold_spl_metal_Spl_0"].__setitem__(4, [500, 10, 20, 20]),
        "frame 4 has the box .* another resolution",
    ),
    (
        lambda e: e["small_gold_spl_metal_Spl_0"].__setitem__(4, [1, 1, float("nan"), 2]),
        "in whole px",
    ),
    (lambda e: e.pop("small_gold_spl_metal_Spl_0"), "the video has no snitch"),
]


@pytest.mark.parametrize(("change", "text"), LABELS_WRONG)
def test_wrong_labels_are_refused_with_the_reason(folder, change, text):
    rewrite(labels_path(folder, NAME), change)
    with pytest.raises(DatasetError, match=text):
        Dataset(folder).video(NAME)


def test_labels_of_a_smaller_picture_are_told_by_the_scene(folder):
    def halve(entry):
        for boxes in entry.values():
            boxes[:] = [[side // 4 for side in box] for box in boxes]

    rewrite(labels_path(folder, NAME), halve)
    with pytest.raises(DatasetError, match="of another resolution"):
        Dataset(folder).video(NAME)


def test_cut_off_labels_are_refused(folder):
    path = labels_path(folder, NAME)
    path.write_bytes(path.read_bytes()[:-20])
    with pytest.raises(DatasetError, match=r"_bb\.json: is no JSON; it may be cut off"):
        Dataset(folder).video(NAME)


SCENES_WRONG = [
    (lambda e: e.pop("objects"), "objects: expected a list of objects"),
    (lambda e: e["objects"].append(e["objects"][0]), "two objects are called Spl_0"),
    (lambda e: e["objects"][1].pop("instance"), r"objects\[1\].instance: expected text"),
    (lambda e: e["objects"][0].update(sized="big"), r"objects\[0\].sized: expected a finite"),
    (lambda e: e["objects"][0].update({"3d_coords": [1, 2]}), "3d_coords: expected 3 numbers"),
    (lambda e: e["objects"][0]["locations"].pop("4"), "locations: frame 4 is missing"),
    (
        lambda e: e["objects"][0]["locations"].update({"4": [1, 2, float("inf")]}),
        "expected places of 3 finite numbers",
    ),
    (lambda e: e["objects"][0]["locations"].update({"4": [1, 2]}), "expected places of 3 numbers"),
    (lambda e: e.update(movements=[]), "movements: expected an object"),
    (lambda e: e["movements"].update(Cone_9=[]), "movements.Cone_9: there is no such object"),
    (
        lambda e: e["movements"]["Cone_0"].append(["_contain", "Sphere_9", 8, 9]),
        "_contain names 'Sphere_9'; there is no such object in the scene",
    ),
    (
        lambda e: e["movements"]["Cone_0"].append(["_slide", None, 8, 7]),
        "_slide lasts from frame 8 to 7",
    ),
    (
        lambda e: e["movements"]["Cone_0"].append(["_slide", None, 0, 1]),
        "not in the order of time",
    ),
    (lambda e: e["movements"]["Cone_0"].append(["_slide"]), r"expected \[action, other"),
    (lambda e: e["movements"]["Cone_0"].append([7, None, 8, 9]), "7 is no action"),
    (lambda e: e.update(camera="here"), "camera: expected 3 numbers"),
    (lambda e: e.update(relationships={"left": 3}), "relationships: expected lists"),
]


@pytest.mark.parametrize(("change", "text"), SCENES_WRONG)
def test_wrong_scenes_are_refused_with_the_reason(folder, change, text):
    rewrite(scene_path(folder, NAME), change)
    with pytest.raises(DatasetError, match=text):
        Dataset(folder).video(NAME)


def test_a_missing_scene_among_others_is_an_error(folder):
    scene_path(folder, NAME).unlink()
    with pytest.raises(DatasetError, match=r"000007\.json: there is no such file"):
        Dataset(folder).video(NAME)


def detections(folder, frames, classes):
    path = perception_path(folder, NAME, PerceptionKind.OD)
    path.write_bytes(pickle.dumps({"bb": frames, "labels": classes}))


ONE = np.array([[10, 10, 19, 19]])
DETECTIONS_WRONG = [
    ([ONE] * 9, [np.array([140])] * 9, "has 9 frames, the labels have 10"),
    ([ONE] * 10, [np.array([140])] * 9, "10 frames of boxes, but 9 of labels"),
    ([ONE] * 10, [np.array([140, 1])] * 10, r"frame 0: 1 boxes, but labels of shape \(2,\)"),
    ([ONE[:, :3]] * 10, [np.array([140])] * 10, r"shape \(1, 3\); expected \(n, 4\)"),
    ([ONE * np.nan] * 10, [np.array([140])] * 10, "frame 0: holds a number that is not finite"),
    ([ONE[:, ::-1]] * 10, [np.array([140])] * 10, r"frame 0: has the inverted box \[19, 19, 10"),
    ([ONE * 40] * 10, [np.array([140])] * 10, "reaches beyond 320 x 240 px"),
    ([ONE] * 10, [np.array([193])] * 10, "has a class beyond 0…192"),
    ([ONE] * 10, [np.array(["spl"])] * 10, "'U3'"),
    ([ONE] * 10, "labels", "expected a list of arrays"),
    ([[[1, 2], [3]]] * 10, [np.array([140])] * 10, "expected an array of numbers"),
]


@pytest.mark.parametrize(("frames", "classes", "text"), DETECTIONS_WRONG)
def test_wrong_detections_are_refused_with_the_reason(folder, frames, classes, text):
    detections(folder, frames, classes)
    dataset = Dataset(folder)
    video = dataset.video(NAME)
    with pytest.raises(DatasetError, match=text):
        dataset.perception(video, PerceptionKind.OD)


def test_a_pickle_without_the_two_lists_is_refused(folder):
    perception_path(folder, NAME, PerceptionKind.OD).write_bytes(pickle.dumps([1, 2]))
    assert 'expected a dict with "bb" and "labels"' in refused(folder)


def test_empty_frames_may_have_any_shape_and_fractions_are_cut(folder):
    empty = [np.array([]), np.zeros((0, 4))] * 4
    detections(
        folder,
        [*empty, ONE + 0.9, ONE.astype(np.float32)],
        [*[np.array([])] * 8, np.array([140]), np.array([140])],
    )
    dataset = Dataset(folder)
    perception = dataset.perception(dataset.video(NAME), PerceptionKind.OD)
    assert [boxes.shape for boxes in perception.boxes] == [(0, 4)] * 8 + [(1, 4)] * 2
    assert perception.boxes[8].tolist() == [[10, 10, 19, 19]]


def test_thousands_of_detections_in_one_frame_are_read(folder):
    many = np.tile(ONE, (5000, 1))
    detections(folder, [many] * 10, [np.full(5000, 3)] * 10)
    dataset = Dataset(folder)
    perception = dataset.perception(dataset.video(NAME), PerceptionKind.OD)
    assert [len(classes) for classes in perception.classes] == [5000] * 10


LISTS_WRONG = [
    ("CLEVR_new_000007 3,4\n", "line 1: expected a video's name, a tab"),
    (f"{NAME}\t3,x\n", "expected frame numbers with commas"),
    (f"{NAME}\t-3\n", "frame -3 is in no video"),
    (f"{NAME}\t{10**30}\n", "is in no video"),
    (f"{NAME}\t3\n{NAME}\t4\n", "line 2: CLEVR_new_000007 is listed a second time"),
    (f"{NAME}\t12\n", "CLEVR_new_000007: lists frame 12; the labels have 10 frames"),
    ("CLEVR_new_000008\t3\n", "does not list CLEVR_new_000007"),
    (f"{NAME}\t0,3,4,7,8,9\n", "do not add up"),
]


@pytest.mark.parametrize(("text", "reason"), LISTS_WRONG)
def test_wrong_frame_lists_are_refused_with_the_reason(folder, text, reason):
    path = folder / "containment_and_occlusions" / "containment_only_static_annotations.txt"
    path.write_text(text)
    with pytest.raises(DatasetError, match=reason):
        Dataset(folder).video(NAME)


def test_a_frame_with_two_labels_is_refused(folder):
    path = folder / "containment_and_occlusions" / "visibility_rate_gt_0.txt"
    path.write_text(f"{NAME}\t0,1,2,3\n")
    with pytest.raises(DatasetError, match="a frame has two labels"):
        Dataset(folder).video(NAME)


def test_a_missing_frame_list_is_named(folder):
    (folder / "containment_and_occlusions" / "visibility_rate_gt_30.txt").unlink()
    with pytest.raises(DatasetError, match=r"gt_30\.txt: cannot be read"):
        Dataset(folder).video(NAME)


def test_an_empty_list_is_a_line_that_ends_after_the_tab(tmp_path):
    text = format_frame_list({"a": np.array([False, False]), "b": np.array([True, True])})
    assert text == "a\t\nb\t0,1\n"
    (tmp_path / "list.txt").write_text(text + "\n")
    assert read_frame_list(tmp_path / "list.txt") == {"a": (), "b": (0, 1)}


def test_damaged_exact_boxes_are_refused(folder):
    path = folder / "exact_boxes" / f"{NAME}.npy"
    path.write_bytes(path.read_bytes()[:-4])
    with pytest.raises(DatasetError, match="no whole array"):
        Dataset(folder).video(NAME)
    np.save(path, np.zeros((2, 10, 3), dtype=np.float32))
    with pytest.raises(DatasetError, match=r"expected \(2, 10, 4\) finite numbers, found"):
        Dataset(folder).video(NAME)
    np.save(path, np.array([object()]), allow_pickle=True)
    with pytest.raises(DatasetError, match="no whole array"):
        Dataset(folder).video(NAME)


def test_what_cannot_be_written_is_told(tmp_path, video):
    (tmp_path / "labels").write_text("a file in the way")
    with pytest.raises(DatasetError, match="cannot be written"):
        write_video(tmp_path, video)
