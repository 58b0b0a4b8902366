"""The calibration: from a file and from a scene, and what is said of a wrong one."""

from __future__ import annotations

import math

import pytest

from aapa import AnchoringError
from aapa.errors import DatasetError
from aapa.lacater.camera import FloorCamera, camera_at, read_camera
from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint


def read(folder, text):
    path = folder / "camera.yaml"
    path.write_text(text, encoding="utf-8")
    return read_camera(path)


def test_a_camera_by_its_height_and_pitch(tmp_path):
    camera = read(tmp_path, "height: 5.3\npitch_deg: 30\n")
    assert camera == FloorCamera(5.3, pytest.approx(math.pi / 6), 350.0)
    assert read(tmp_path, "height: 5\npitch_deg: 30\nfocal_px: 400\n").focal == 400.0


def test_a_camera_by_its_place_is_that_of_the_generator(tmp_path):
    x, y, z = DEFAULT_PLACE
    camera = read(tmp_path, f"place: [{x}, {y}, {z}]\n")
    assert camera == camera_at(DEFAULT_PLACE)
    assert math.sin(camera.pitch) == pytest.approx(-Viewpoint.at(x, y, z).axes[2][2])
    assert camera.height == z
    aimed = read(tmp_path, "place: [3, 0, 4]\nlooks_at: [0, 0, 0]\n")
    assert aimed.pitch == pytest.approx(math.atan2(4, 3))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("height: 5\n", "pitch_deg is missing"),
        ("height: high\npitch_deg: 30\n", "height is 'high'; it has to be a number"),
        ("height: .nan\npitch_deg: 30\n", "height is nan; it has to be a number"),
        ("height: -1\npitch_deg: 30\n", "height is -1; it has to be above the floor"),
        ("height: 5\npitch_deg: 95\n", "looks down by 95.0 degrees"),
        ("height: 5\npitch_deg: 30\nfocal_px: 0\n", "focal_px is 0"),
        ("hight: 5\npitch_deg: 30\n", "no 'hight' in a calibration; did you mean height"),
        ("place: [1, 2]\n", r"place is \[1, 2\]; it has to be \[x, y, z\]"),
        ("place: [1, 2, 3]\nheight: 3\n", "say either place or height"),
        ("[1, 2]\n", "expected height, pitch_deg and focal_px"),
        ("height: [\n", "is no YAML"),
    ],
)
def test_a_wrong_calibration_is_refused_by_the_file_s_name(tmp_path, text, said):
    with pytest.raises(DatasetError, match=said) as caught:
        read(tmp_path, text)
    assert str(tmp_path / "camera.yaml") in str(caught.value)


def test_a_camera_that_looks_up_is_refused():
    with pytest.raises(AnchoringError, match="looks down by"):
        camera_at((0.0, 5.0, 1.0), (0.0, 0.0, 3.0))


def test_a_calibration_that_is_not_there_is_named(tmp_path):
    with pytest.raises(DatasetError, match="cannot be read"):
        read_camera(tmp_path / "camera.yaml")
