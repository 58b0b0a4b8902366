from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from aapa.errors import DatasetError
from aapa.lacater.generator import DetectorNoise, generate_video
from aapa.lacater.generator.outlines import rounded_boxes
from aapa.lacater.generator.preview import Painter, reconstructed
from aapa.lacater.generator.preview.annotation import (
    STATE_COLOURS,
    TRACK_COLOUR,
    Annotator,
    State,
    Track,
    picture_size,
)
from aapa.lacater.generator.preview.film import write_film
from aapa.lacater.generator.preview.painting import COLOURS
from aapa.lacater.generator.preview.palette import palette_image
from aapa.lacater.layout import PerceptionKind


@pytest.fixture(scope="module")
def made():
    return generate_video(100, 7, DetectorNoise())


def test_a_scene_file_gives_back_the_boxes_of_the_labels():
    for number in range(12):
        video = generate_video(100, number, DetectorNoise()).video
        again = reconstructed(video.scene, 300)
        assert np.array_equal(rounded_boxes(again.boxes), video.labels.boxes)


def test_a_scene_without_a_camera_is_seen_from_the_usual_place(made):
    scene = replace(made.video.scene, camera=None)
    boxes = reconstructed(scene, 300).boxes
    assert np.abs(boxes - made.video.labels.boxes).mean() < 25


def test_a_scene_that_is_too_short_or_strange_is_refused(made):
    scene = made.video.scene
    with pytest.raises(DatasetError, match="has 301 locations for 400 frames"):
        reconstructed(scene, 400)
    strange = replace(scene, objects=(replace(scene.objects[0], color="pink"), *scene.objects[1:]))
    with pytest.raises(DatasetError, match="there is no shape, size, colour and material"):
        reconstructed(strange, 300)


def test_things_are_painted_where_their_boxes_are(made):
    picture = Painter(reconstructed(made.video.scene, 300), 1).paint(0)
    assert picture.shape == (240, 320, 3)
    boxes = made.video.labels.boxes[:, 0]
    # The floor is gray; the snitch is golden and is the only thing that is.
    x1, y1, x2, y2 = boxes[0]
    middle = picture[(y1 + y2) // 2, (x1 + x2) // 2].astype(int)
    assert middle[0] > middle[2] + 60
    outside = np.ones((240, 320), dtype=bool)
    for a, b, c, d in boxes:
        # A cube is painted with sharp corners, which reach a little beyond its box.
        outside[max(b - 5, 0) : d + 6, max(a - 5, 0) : c + 6] = False
    floor = picture[outside].astype(int)
    assert np.abs(floor[:, 0] - floor[:, 1]).max() < 12


def test_what_is_contained_cannot_be_seen_in_the_picture(made):
    masks = made.video.masks
    frame = int(np.flatnonzero(masks.contained)[10])
    painter = Painter(reconstructed(made.video.scene, 300), 1)
    x1, y1, x2, y2 = made.video.labels.boxes[0, frame]
    inside = painter.paint(frame)[y1:y2, x1:x2].reshape(-1, 3).astype(int)
    gold = np.array(COLOURS["gold"])
    assert (np.abs(inside - gold).sum(axis=1) < 80).mean() < 0.03


def test_the_snitch_has_the_colour_of_its_label(made):
    annotator = Annotator(made.video, 2)
    blank = np.full((480, 640, 3), 128, dtype=np.uint8)
    for state in State:
        frames = np.flatnonzero(getattr(made.video.masks, state))
        if not len(frames):
            continue
        sheet = np.array(annotator.annotate(blank, int(frames[0])))
        x1, y1, x2, _ = made.video.labels.boxes[0, frames[0]] * 2
        assert tuple(sheet[y1 - 2, (x1 + x2) // 2]) == STATE_COLOURS[state]
    assert made.video.masks.carried.any()


def test_a_models_box_and_its_agreement_are_drawn(made):
    truth = made.video.labels.snitch.astype(float) + 30
    annotator = Annotator(made.video, 2, None, Track("some-model", truth, np.zeros(300)))
    blank = np.full((480, 640, 3), 128, dtype=np.uint8)
    sheet = np.array(annotator.annotate(blank, 0))
    x1, y1, x2, _ = (truth[0] * 2).astype(int)
    assert tuple(sheet[y1 - 1, (x1 + x2) // 2]) == TRACK_COLOUR
    nowhere = Track("some-model", np.full((300, 4), np.nan), np.zeros(300))
    plain = np.array(Annotator(made.video, 2, None, nowhere).annotate(blank, 0))
    assert tuple(plain[y1 - 1, (x1 + x2) // 2]) == (128, 128, 128)


def test_detections_are_drawn(made):
    seen = made.perceptions[PerceptionKind.OD]
    blank = np.zeros((480, 640, 3), dtype=np.uint8)
    with_them = np.array(Annotator(made.video, 2, seen).annotate(blank, 0))
    without = np.array(Annotator(made.video, 2).annotate(blank, 0))
    white = (255, 255, 255)
    more = (with_them[:480] == white).all(axis=2).sum() - (without[:480] == white).all(axis=2).sum()
    assert more > 50


def test_a_gif_has_every_picture_and_keeps_the_colours_of_the_labels(made, tmp_path):
    painter = Painter(reconstructed(made.video.scene, 300), 1)
    annotator = Annotator(made.video, 1)
    carried = int(np.flatnonzero(made.video.masks.carried)[0])
    frames = (0, 100, carried)
    path = tmp_path / "new" / "film.gif"
    write_film(path, (annotator.annotate(painter.paint(f), f) for f in frames), 2)
    film = Image.open(path)
    assert (film.n_frames, film.size) == (3, picture_size(1))
    film.seek(2)
    colours = {tuple(c) for c in np.array(film.convert("RGB")).reshape(-1, 3)}
    assert STATE_COLOURS[State.CARRIED] in colours
    assert [p.name for p in path.parent.iterdir()] == ["film.gif"]
    film.close()


def test_an_mp4_is_written(made, tmp_path):
    annotator = Annotator(made.video, 1)
    blank = np.full((240, 320, 3), 128, dtype=np.uint8)
    path = tmp_path / "film.mp4"
    write_film(path, (annotator.annotate(blank, f) for f in range(5)), 1)
    assert path.read_bytes()[4:8] == b"ftyp"


def test_a_film_that_cannot_be_written_is_refused(tmp_path):
    picture = Image.new("RGB", (4, 4))
    with pytest.raises(DatasetError, match=r"ends with \.gif or \.mp4"):
        write_film(tmp_path / "film.avi", [picture], 1)
    (tmp_path / "file").write_text("")
    with pytest.raises(DatasetError, match="cannot be written"):
        write_film(tmp_path / "file" / "film.gif", [picture], 1)


def test_the_palette_has_room_for_all_its_colours():
    palette = palette_image().getpalette()
    assert palette is not None
    colours = {tuple(palette[i : i + 3]) for i in range(0, len(palette), 3)}
    assert len(palette) <= 768
    assert set(STATE_COLOURS.values()) | {TRACK_COLOUR} <= colours
