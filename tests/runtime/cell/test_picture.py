from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest

from runtime.cell.picture import Picture, save_png
from runtime.errors import RuntimeFault, UsageError


@pytest.fixture
def picture(cell):
    try:
        made = Picture(cell, 320, 240)
    except RuntimeFault as fault:
        pytest.skip(str(fault))
    yield made
    made.close()


def test_pictures_show_the_cell(picture, cell):
    overview, wrist = picture.take(), picture.take("wrist")
    assert overview.shape == wrist.shape == (240, 320, 3)
    assert overview.std() > 20
    # The wrist picture and the segmentation show the same scene: an orange cover, a red output.
    ids = cell.view().ids
    for index, channel in ((2, 0), (4, 0)):
        colour = wrist[ids == index].mean(axis=0)
        assert colour[channel] > 1.3 * colour[2]


def test_the_portrait_marks_what_is_detected(picture, cell):
    marked = picture.portrait(cell.look()[0])
    assert marked.shape == (240, 320, 3)
    green = np.all(marked == (90, 255, 120), axis=2)
    assert 100 < green.sum() < 2000
    assert not green[:, 150:].any()  # the inset is on the left


def test_a_png_holds_the_pixels(tmp_path):
    image = np.random.default_rng(0).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    save_png(image, tmp_path / "p.png")
    data = (tmp_path / "p.png").read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    assert struct.unpack(">II", data[16:24]) == (7, 5)
    length = struct.unpack(">I", data[33:37])[0]
    rows = np.frombuffer(zlib.decompress(data[41 : 41 + length]), np.uint8).reshape(5, 22)
    assert np.array_equal(rows[:, 1:].reshape(5, 7, 3), image)


def test_what_cannot_be_drawn_is_said_in_one_sentence(cell, monkeypatch):
    with pytest.raises(UsageError, match="at most 1280 x 960"):
        Picture(cell, 4000, 3000)

    def refuse(*_):
        raise OSError("no display")

    monkeypatch.setattr("mujoco.Renderer", refuse)
    with pytest.raises(RuntimeFault, match="neither EGL nor OSMesa works here"):
        Picture(cell, 320, 240)
