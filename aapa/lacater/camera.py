"""Where the camera of a video stands, for a model that may know it: from a file, or the scene's.

A camera here is level, and looks down upon a floor: its height, its pitch and its focal length
are all there is to know. A calibration is a YAML file, `camera.yaml` beside `labels/`:

    height: 5.34        # above the floor; in units of the scene, in which a large cone is 0.75
    pitch_deg: 28.3     # how far it looks down
    focal_px: 350       # 350, CATER's lens, if left out

or, in place of height and pitch, `place: [7.48, -6.51, 5.34]` and, if it is not CATER's,
`looks_at: [0.01, 0.0, 0.0]`, with the floor at z = 0. LA-CATER's scene files name the place.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import yaml

from aapa.errors import AnchoringError, DatasetError

CALIBRATION_FILE: Final = "camera.yaml"
"""The name of the calibration in a data set's folder; it counts for all videos."""

_FOCAL_PX: Final = 350.0
_LOOKS_AT: Final = (0.01433, 0.00261, 0.00113)
_KNOWN: Final = ("height", "pitch_deg", "focal_px", "place", "looks_at")


@dataclass(frozen=True, slots=True)
class FloorCamera:
    """A level camera above a floor; its principal point is the middle of the image.

    Args:
        height: Above the floor, in units of the scene.
        pitch: How far it looks down, rad, in (0, pi/2).
        focal: Focal length, px.
    """

    height: float
    pitch: float
    focal: float = _FOCAL_PX


def camera_at(
    place: Sequence[float], looks_at: Sequence[float] = _LOOKS_AT, focal: float = _FOCAL_PX
) -> FloorCamera:
    """Give the camera that looks from a place to another, (x, y, z) in units of the scene.

    Raises:
        AnchoringError: It does not look down from above the floor.

    Example:
        >>> camera_at((7.48113, -6.50764, 5.34367)).height
        5.34367
    """
    x, y, z = (float(to) - float(here) for here, to in zip(place, looks_at, strict=True))
    pitch = math.atan2(-z, math.hypot(x, y))
    return _checked(float(place[2]), pitch, focal)


def read_camera(path: Path) -> FloorCamera:
    """Read a calibration.

    Raises:
        DatasetError: The file cannot be read, or is no calibration; the text says what is wrong.
    """
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DatasetError(f"cannot be read: {error.strerror}", path=str(path)) from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise DatasetError(f"is no YAML: {error}", path=str(path)) from error
    try:
        return _camera_of(values)
    except AnchoringError as error:
        raise DatasetError(str(error), path=str(path)) from error


def _camera_of(values: object) -> FloorCamera:
    if not isinstance(values, dict):
        raise AnchoringError("expected height, pitch_deg and focal_px, or place, with their values")
    for name in values:
        if name not in _KNOWN:
            near = difflib.get_close_matches(str(name), _KNOWN, n=1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(_KNOWN)}"
            raise AnchoringError(f"there is no {name!r} in a calibration; {hint}")
    focal = _number(values, "focal_px") if "focal_px" in values else _FOCAL_PX
    if "place" in values:
        if "height" in values or "pitch_deg" in values:
            raise AnchoringError("say either place or height and pitch_deg: they might contradict")
        target = _point(values, "looks_at") if "looks_at" in values else _LOOKS_AT
        return camera_at(_point(values, "place"), target, focal)
    return _checked(_number(values, "height"), math.radians(_number(values, "pitch_deg")), focal)


def _number(values: Mapping[object, object], name: str) -> float:
    value = values.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        said = "is missing" if name not in values else f"is {value!r}; it has to be a number"
        raise AnchoringError(f"{name} {said}")
    return float(value)


def _point(values: Mapping[object, object], name: str) -> tuple[float, float, float]:
    value = values.get(name)
    if not isinstance(value, list) or len(value) != 3:
        raise AnchoringError(f"{name} is {value!r}; it has to be [x, y, z]")
    x, y, z = (_number({name: part}, name) for part in value)
    return x, y, z


def _checked(height: float, pitch: float, focal: float) -> FloorCamera:
    if height <= 0:
        raise AnchoringError(f"the camera's height is {height:g}; it has to be above the floor")
    if not 0 < pitch < math.pi / 2:
        raise AnchoringError(
            f"the camera looks down by {math.degrees(pitch):.1f} degrees; "
            "it has to be more than 0 and less than 90"
        )
    if focal <= 0:
        raise AnchoringError(f"focal_px is {focal:g}; it has to be above 0")
    return FloorCamera(height, pitch, focal)
