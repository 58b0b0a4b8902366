"""Reads the detections of a video."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from aapa.errors import DatasetError
from aapa.lacater.classes import CLASS_NAMES
from aapa.lacater.unpickling import load_arrays
from aapa.lacater.video import HEIGHT, WIDTH, Perception

_CLIPPING = 1
"""Px by which a box that was clipped to the picture and rounded may reach beyond it."""


def read_perception(path: Path) -> Perception:
    """Read the detections of a video.

    Raises:
        DatasetError: The file cannot be read, is hostile, or does not hold detections.
    """
    content = load_arrays(path)
    if not isinstance(content, dict) or not {"bb", "labels"} <= set(content):
        raise DatasetError('expected a dict with "bb" and "labels"', path=str(path))
    boxes, classes = content["bb"], content["labels"]
    if not isinstance(boxes, list | tuple) or not isinstance(classes, list | tuple):
        raise DatasetError("expected a list of arrays, one a frame", path=str(path), key="bb")
    if len(boxes) != len(classes):
        raise DatasetError(
            f"{len(boxes)} frames of boxes, but {len(classes)} of labels", path=str(path)
        )
    frames = [
        _detections(*pair, path, f"frame {number}")
        for number, pair in enumerate(zip(boxes, classes, strict=True))
    ]
    return Perception(tuple(b for b, _ in frames), tuple(c for _, c in frames))


def _detections(
    boxes: object, classes: object, path: Path, where: str
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    found, numbers = _numbers(boxes, path, where), _numbers(classes, path, where)
    found = found.reshape(0, 4) if found.size == 0 else found
    if found.ndim != 2 or found.shape[1] != 4:
        raise DatasetError(
            f"boxes have the shape {found.shape}; expected (n, 4)", path=str(path), key=where
        )
    if numbers.ndim != 1 or len(numbers) != len(found):
        raise DatasetError(
            f"{len(found)} boxes, but labels of shape {numbers.shape}", path=str(path), key=where
        )
    inverted = (found[:, 2:] < found[:, :2]).any(axis=1)
    if inverted.any():
        box = found[int(np.flatnonzero(inverted)[0])].tolist()
        raise DatasetError(
            f"has the inverted box {box}; expected x1 ≤ x2 and y1 ≤ y2", path=str(path), key=where
        )
    beyond = (found < -_CLIPPING) | (found > np.array([WIDTH, HEIGHT] * 2) + _CLIPPING)
    if beyond.any():
        box = found[int(np.flatnonzero(beyond.any(axis=1))[0])].tolist()
        raise DatasetError(
            f"has the box {box}, which reaches beyond {WIDTH} x {HEIGHT} px",
            path=str(path),
            key=where,
        )
    if numbers.size and not 0 <= int(numbers.min()) <= int(numbers.max()) < len(CLASS_NAMES):
        raise DatasetError(
            f"has a class beyond 0…{len(CLASS_NAMES) - 1}", path=str(path), key=where
        )
    return found, numbers


def _numbers(value: object, path: Path, where: str) -> NDArray[np.int64]:
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise DatasetError("expected an array of numbers", path=str(path), key=where) from error
    if array.size == 0:
        return np.zeros((0, 4) if array.ndim == 2 else (0,), dtype=np.int64)
    if array.dtype.kind not in "iuf":
        raise DatasetError("expected an array of numbers", path=str(path), key=where)
    if not np.isfinite(array).all():
        raise DatasetError(
            "holds a number that is not finite (NaN or infinite)", path=str(path), key=where
        )
    if float(np.abs(array).max()) > 1e9:
        raise DatasetError("holds a number beyond 10⁹", path=str(path), key=where)
    # The published code casts boxes to whole px, towards zero.
    return array.astype(np.int64)
