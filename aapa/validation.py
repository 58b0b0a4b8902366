"""What comes in from outside is checked once, here, so that everything behind can rely on it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from aapa.camera import Camera
from aapa.detections import Box, Detection, Position
from aapa.errors import AnchoringError
from aapa.parameters import Space

_LARGEST_COORDINATE = 1e9


def checked_detections(detections: Iterable[Detection], space: Space) -> tuple[Detection, ...]:
    """Give the detections with plain float tuples for boxes, positions and sizes.

    Args:
        detections: One frame's detections, in any order.
        space: "base" demands a position of every detection.

    Raises:
        AnchoringError: A detection is malformed (the text says which and why), or two carry
            the same name.
    """
    given = tuple(detections)
    if space == "image" and _are_plain(given):
        return given
    result = tuple([_checked(number, each, space) for number, each in enumerate(given, start=1)])
    names = [detection.name for detection in result if detection.name is not None]
    if len(set(names)) != len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise AnchoringError(f"two detections carry the name {twice!r}; a body has one place")
    return result


def check_within(detections: Iterable[Detection], image_size: tuple[int, int]) -> None:
    """Make sure that detections are of a picture of this size.

    Boxes may reach beyond its border, as those of some detectors do.

    Args:
        detections: Checked ones.
        image_size: Width and height of the picture, px.

    Raises:
        AnchoringError: A box lies wholly outside.
    """
    width, height = image_size
    for number, detection in enumerate(detections, start=1):
        x1, y1, x2, y2 = detection.box
        # A body reports where it is, which need not be where the camera looks.
        if detection.name is None and (x1 > width or y1 > height or x2 < 0 or y2 < 0):
            raise AnchoringError(
                f"detection {number} ({detection.type}) has the box {detection.box}, outside of "
                f"the picture of {width} x {height} px; is it of another resolution?"
            )


def check_camera(camera: Camera) -> None:
    """Make sure that a camera can project.

    Raises:
        AnchoringError: Its image is empty, its focal length not above 0, its position not
            finite, or its rotation not orthonormal.
    """
    if camera.width <= 0 or camera.height <= 0:
        raise AnchoringError(
            f"the camera's image is {camera.width} x {camera.height} px; both have to be above 0"
        )
    if not camera.focal_px > 0:
        raise AnchoringError(f"the camera's focal length is {camera.focal_px} px; expected above 0")
    _numbers("the camera", "position", camera.position, 3)
    rotation = np.asarray(camera.rotation)
    if rotation.shape != (3, 3):
        raise AnchoringError(f"the camera's rotation has shape {rotation.shape}; expected (3, 3)")
    # NaN fails the comparison too; the determinant tells a mirror from a rotation.
    orthonormal = bool(np.all(np.abs(rotation.T @ rotation - np.eye(3)) < 1e-6))
    if not orthonormal or np.linalg.det(rotation) < 0:
        raise AnchoringError(
            "the camera's rotation is not a rotation; its columns are its right, down and forward "
            "axes in the base frame, each of length 1"
        )


def _are_plain(detections: Sequence[object]) -> bool:
    """Tell whether all are as most are: in order, with nothing to convert, and no bodies."""
    most = _LARGEST_COORDINATE
    for detection in detections:
        if type(detection) is not Detection:
            return False
        corners: Sequence[float] = detection.box
        if type(corners) is not tuple or len(corners) != 4:
            return False
        x1, y1, x2, y2 = corners
        # NaN fails every comparison.
        if not (
            type(x1) is float
            and type(y1) is float
            and type(x2) is float
            and type(y2) is float
            and -most <= x1 <= x2 <= most
            and -most <= y1 <= y2 <= most
        ):
            return False
        score, name = detection.score, detection.type
        if not (
            type(score) is float
            and 0.0 <= score <= 1.0
            and detection.position is None
            and detection.size is None
            and detection.name is None
            and type(name) is str
            and name
        ):
            return False
    return True


def _checked(number: int, detection: Detection, space: Space) -> Detection:
    if not isinstance(detection, Detection):
        raise AnchoringError(f"detection {number} is a {type(detection).__name__}, no Detection")
    if not _is_name(detection.type):
        raise AnchoringError(f"detection {number} has type {detection.type!r}; expected a name")
    who = f"detection {number} ({detection.name or detection.type})"
    if detection.name is not None and not _is_name(detection.name):
        raise AnchoringError(f"{who} has name {detection.name!r}; expected a name or None")
    score = detection.score
    if type(score) is not float or not 0 <= score <= 1:
        score = _score(who, score)
    if detection.position is None and space == "base":
        raise AnchoringError(
            f"{who} has no position; in base space every detection needs one "
            '(or anchor in the image, with space "image")'
        )
    return Detection(
        detection.type,
        _box(who, detection.box),
        score,
        None if detection.position is None else _position(who, detection.position),
        None if detection.size is None else _size(who, detection.size),
        detection.name,
    )


def _is_name(value: object) -> bool:
    return isinstance(value, str) and value != ""


def _score(who: str, value: object) -> float:
    score = _numbers(who, "score", (value,), 1)[0]
    if not 0 <= score <= 1:
        raise AnchoringError(f"{who} has score {score}; it has to be within 0…1")
    return score


def _box(who: str, value: object) -> Box:
    x1, y1, x2, y2 = _numbers(who, "box", value, 4)
    if x2 < x1 or y2 < y1:
        raise AnchoringError(
            f"{who} has the inverted box {(x1, y1, x2, y2)}; expected x1 ≤ x2 and y1 ≤ y2, in px "
            "from the top left"
        )
    return x1, y1, x2, y2


def _position(who: str, value: object) -> Position:
    x, y, z = _numbers(who, "position", value, 3)
    return x, y, z


def _size(who: str, value: object) -> tuple[float, float]:
    width, height = _numbers(who, "size", value, 2)
    if width < 0 or height < 0:
        raise AnchoringError(f"{who} has size {(width, height)}; width and height are at least 0 m")
    return width, height


def _numbers(who: str, what: str, value: object, count: int) -> list[float]:
    try:
        # The sum refuses text, which float alone would read.
        numbers = [float(number + 0.0) for number in value]  # type: ignore[attr-defined]
    except (TypeError, ValueError, OverflowError):
        numbers = []
    if len(numbers) != count:
        shown = value[0] if count == 1 and isinstance(value, tuple) else value
        expected = "a number" if count == 1 else f"{count} numbers"
        raise AnchoringError(f"{who} has {what} {shown!r}; expected {expected}")
    for number in numbers:
        # NaN fails the comparison too.
        if not -_LARGEST_COORDINATE <= number <= _LARGEST_COORDINATE:
            raise AnchoringError(
                f"{who} has {number} in its {what}; expected finite numbers, in px or m"
            )
    return numbers
