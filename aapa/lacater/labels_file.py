"""Reads the true boxes of a video, and refuses those of another resolution."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from aapa.errors import DatasetError
from aapa.lacater.json_file import read_json
from aapa.lacater.scene import Scene
from aapa.lacater.video import HEIGHT, WIDTH, Labels

_ROUNDING = 1
"""Px. Corner and size are rounded apart, so that their sum may lie this far beyond the picture."""

_SLACK = 8
"""Px by which the place in the scene file may lie outside of an object's box."""


def read_labels(path: Path) -> Labels:
    """Read the true boxes of a video.

    Raises:
        DatasetError: The file is no label file, or its boxes are not of a 320 x 240 picture.
    """
    entry = read_json(path)
    if not isinstance(entry, dict) or not entry:
        raise DatasetError("expected an object of lists of boxes", path=str(path))
    rows = []
    for key, boxes in entry.items():
        rows.append(_label_boxes(boxes, path, key))
        if len(rows[-1]) != len(rows[0]):
            raise DatasetError(
                f"has {len(rows[-1])} boxes, the first object has {len(rows[0])}",
                path=str(path),
                key=key,
            )
    return Labels(tuple(entry), np.stack(rows).astype(np.int32))


def check_resolution(labels: Labels, scene: Scene, path: Path) -> None:
    """Refuse labels of a smaller picture: the objects are not where the scene projects them.

    Raises:
        DatasetError: Most objects of the first frame are elsewhere.
    """
    off = 0
    known = {thing.key: thing.pixel_coords for thing in scene.objects}
    for key, box in zip(labels.keys, labels.boxes[:, 0].tolist(), strict=True):
        x, y, _ = known.get(key, (math.nan, math.nan, 0.0))
        across = box[0] - _SLACK <= x <= box[2] + _SLACK
        off += not (across and box[1] - _SLACK <= y <= box[3] + _SLACK)
    if 2 * off > len(labels.keys):
        raise DatasetError(
            "most objects are not where the scene has them in a "
            f"{WIDTH} x {HEIGHT} px picture; labels and scene are of different videos, or the "
            "labels of another resolution",
            path=str(path),
        )


def _label_boxes(value: object, path: Path, key: str) -> NDArray[np.int64]:
    if not isinstance(value, list) or not value:
        raise DatasetError("expected a list of boxes, one a frame", path=str(path), key=key)
    try:
        boxes = np.array(value)
    except ValueError as error:
        raise DatasetError("expected boxes of 4 numbers", path=str(path), key=key) from error
    if boxes.ndim != 2 or boxes.shape[1] != 4 or boxes.dtype.kind not in "iu":
        raise DatasetError(
            "expected boxes [x, y, width, height] in whole px", path=str(path), key=key
        )
    wrong = (boxes < 0).any(axis=1)
    if wrong.any():
        frame = int(np.flatnonzero(wrong)[0])
        raise DatasetError(
            f"frame {frame} has the box {value[frame]}; x, y, width and height are at least 0",
            path=str(path),
            key=key,
        )
    boxes = boxes.astype(np.int64)
    boxes[:, 2:] += boxes[:, :2]
    beyond = (boxes[:, 2] > WIDTH + _ROUNDING) | (boxes[:, 3] > HEIGHT + _ROUNDING)
    if beyond.any():
        frame = int(np.flatnonzero(beyond)[0])
        raise DatasetError(
            f"frame {frame} has the box {value[frame]}, which reaches beyond {WIDTH} x {HEIGHT} px;"
            " these labels are of another resolution",
            path=str(path),
            key=key,
        )
    return boxes
