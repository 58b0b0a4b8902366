"""Recorded detections in, anchors out: JSON Lines, UTF-8, one frame a line."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

import numpy as np

from aapa.anchors import Anchor
from aapa.camera import Camera
from aapa.detections import Detection
from aapa.errors import AnchoringError, RecordingError
from aapa.validation import check_camera, check_within, checked_detections

_FRAME_KEYS = frozenset({"frame", "width", "height", "camera", "detections", "actions"})
_ACTION_STATUSES = ("succeeded", "failed", "running")


@dataclass(frozen=True, slots=True)
class RecordedAction:
    """An action that ended, or still ran, before its frame was taken.

    Args:
        name: The action, such as "contain".
        args: What it was done with, such as ("cone-1", "snitch-1").
        status: "succeeded", "failed" or "running".
    """

    name: str
    args: tuple[str, ...] = ()
    status: str = "succeeded"


@dataclass(frozen=True, slots=True)
class RecordedFrame:
    """One line of a recording.

    Args:
        frame: The number it goes by.
        detections: What was detected, in the order of the line.
        actions: What had been done, in the order of the line.
        image_size: Width and height of the image, px, where the line tells them.
        extra: The keys of the line that mean nothing here, kept as they are.
        camera: The camera and its pose, where the line tells them.
    """

    frame: int
    detections: tuple[Detection, ...]
    actions: tuple[RecordedAction, ...] = ()
    image_size: tuple[int, int] | None = None
    extra: Mapping[str, object] = field(default_factory=dict)
    camera: Camera | None = None


def read_frames(
    path: Path, refused: Callable[[AnchoringError], None] | None = None
) -> Iterator[RecordedFrame]:
    """Give the frames of a recording, read as they are asked for; blank lines are passed over.

    Args:
        path: The recording.
        refused: Told of each malformed line, which is then passed over; without it, the first
            one is raised.

    Raises:
        AnchoringError: The file cannot be opened.
        RecordingError: A line is malformed; the text names file, line and key.
    """
    try:
        stream = path.open("rb")
    except OSError as error:
        raise AnchoringError(f"cannot read {path}: {error.strerror}") from error
    last: int | None = None
    with stream:
        for number, line in enumerate(stream, start=1):
            if not line.strip():
                continue
            try:
                place = _Line(str(path), number)
                frame = place.frame(line)
                if last is not None and frame.frame <= last:
                    place.refuse_order(frame.frame, last)
            except RecordingError as error:
                if refused is None:
                    raise
                refused(error)
                continue
            last = frame.frame
            yield frame


def anchors_line(frame: int, anchors: Iterable[Anchor], *, reasons: bool = False) -> str:
    """Give one line (without its end) for the anchors of a frame, in their order.

    Args:
        frame: Its number.
        anchors: What is believed to be there.
        reasons: Whether to tell of each why.

    Example:
        >>> anchors_line(3, ())
        '{"frame": 3, "anchors": []}'
    """
    entries = [
        {
            "name": anchor.name,
            "type": anchor.type,
            "box": list(anchor.box),
            "status": str(anchor.status),
            "parent": anchor.parent,
            "confidence": anchor.confidence,
            **({"reason": anchor.reason} if reasons else {}),
        }
        for anchor in anchors
    ]
    return json.dumps({"frame": frame, "anchors": entries}, ensure_ascii=False)


@dataclass(frozen=True, slots=True)
class _Line:
    """Where a line stands, and how to read it."""

    path: str
    number: int

    def frame(self, line: bytes) -> RecordedFrame:
        try:
            entry = json.loads(line.decode("utf-8"))
        except UnicodeDecodeError:
            self._refuse("the line is not UTF-8")
        except json.JSONDecodeError as error:
            self._refuse(f"the line is not JSON: {error.msg} at column {error.colno}")
        except ValueError:
            # Python refuses to read integers of thousands of digits.
            self._refuse("the line holds a number that is too long")
        except RecursionError:
            self._refuse("the line is nested too deeply")
        if not isinstance(entry, dict):
            self._refuse(f"expected an object with the keys of a frame, found {_kind(entry)}")
        size = self._image_size(entry)
        return RecordedFrame(
            self._integer(entry, "frame", least=0),
            self._detections(entry, size),
            tuple(self._action(item) for item in self._list(entry, "actions", default=[])),
            size,
            {key: value for key, value in entry.items() if key not in _FRAME_KEYS},
            self._camera(entry, size),
        )

    def refuse_order(self, frame: int, last: int) -> NoReturn:
        self._refuse(
            f"frame {frame} comes after frame {last}; a recording is in the order of time, "
            "each frame once",
            "frame",
        )

    def _detections(
        self, entry: Mapping[str, object], size: tuple[int, int] | None
    ) -> tuple[Detection, ...]:
        detections = tuple(self._detection(item) for item in self._list(entry, "detections"))
        try:
            checked = checked_detections(detections, "image")
            if size is not None:
                check_within(checked, size)
        except AnchoringError as error:
            self._refuse(str(error), "detections")
        return checked

    def _detection(self, item: object) -> Detection:
        if not isinstance(item, dict):
            self._refuse(f"expected objects with type and box, found {_kind(item)}", "detections")
        size = self._numbers(item, "size", 2)
        position = self._numbers(item, "position", 3)
        box = self._numbers(item, "box", 4)
        if box is None:
            self._refuse("it is missing; expected [x1, y1, x2, y2] in px", "box")
        score = item.get("score", 1.0)
        if isinstance(score, bool) or not isinstance(score, int | float):
            self._refuse(f"expected a number within 0…1, found {_kind(score)}", "score")
        return Detection(
            self._text(item, "type"),
            (box[0], box[1], box[2], box[3]),
            score,
            None if position is None else (position[0], position[1], position[2]),
            None if size is None else (size[0], size[1]),
            None if item.get("name") is None else self._text(item, "name"),
        )

    def _camera(self, entry: Mapping[str, object], size: tuple[int, int] | None) -> Camera | None:
        item = entry.get("camera")
        if item is None:
            return None
        if not isinstance(item, dict):
            self._refuse(f"expected focal_px, position and rotation, found {_kind(item)}", "camera")
        if size is None:
            self._refuse("a camera needs the image's width and height beside it", "camera")
        focal_px, near_m = self._number(item, "focal_px"), self._number(item, "near_m", 0.0)
        position = self._numbers(item, "position", 3)
        rows = self._list(item, "rotation")
        rotation = [self._numbers({"rotation": row}, "rotation", 3) for row in rows]
        if position is None or len(rotation) != 3 or None in rotation:
            self._refuse("expected a position of 3 numbers and a rotation of 3 x 3", "camera")
        axes = np.array(rotation, dtype=np.float64)
        camera = Camera(*size, focal_px, (position[0], position[1], position[2]), axes, near_m)
        try:
            check_camera(camera)
        except AnchoringError as error:
            self._refuse(str(error), "camera")
        return camera

    def _action(self, item: object) -> RecordedAction:
        if not isinstance(item, dict):
            self._refuse(f"expected objects with name and args, found {_kind(item)}", "actions")
        args = self._list(item, "args", default=[])
        if not all(isinstance(arg, str) for arg in args):
            self._refuse("expected a list of names", "args")
        status = item.get("status", "succeeded")
        if status not in _ACTION_STATUSES:
            allowed = ", ".join(_ACTION_STATUSES)
            self._refuse(f"expected one of {allowed}; found {status!r}", "status")
        names = tuple(str(arg) for arg in args)
        return RecordedAction(self._text(item, "name"), names, str(status))

    def _image_size(self, entry: Mapping[str, object]) -> tuple[int, int] | None:
        if "width" not in entry and "height" not in entry:
            return None
        return self._integer(entry, "width", least=1), self._integer(entry, "height", least=1)

    def _integer(self, entry: Mapping[str, object], key: str, *, least: int) -> int:
        value = self._present(entry, key)
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            self._refuse(f"expected a whole number of at least {least}, found {value!r}", key)
        return value

    def _text(self, entry: Mapping[str, object], key: str) -> str:
        value = self._present(entry, key)
        if not isinstance(value, str) or not value:
            self._refuse(f"expected a name, found {value!r}", key)
        return value

    def _list(
        self, entry: Mapping[str, object], key: str, default: list[object] | None = None
    ) -> list[object]:
        if key not in entry and default is not None:
            return default
        value = self._present(entry, key)
        if not isinstance(value, list):
            self._refuse(f"expected a list, found {_kind(value)}", key)
        return value

    def _numbers(self, entry: Mapping[str, object], key: str, count: int) -> list[float] | None:
        value = entry.get(key)
        if value is None:
            return None
        if not isinstance(value, list) or len(value) != count:
            self._refuse(f"expected a list of {count} numbers, found {_kind(value)}", key)
        if any(isinstance(number, bool) or not isinstance(number, int | float) for number in value):
            self._refuse(f"expected {count} numbers, found {value!r}", key)
        return value

    def _number(self, entry: Mapping[str, object], key: str, default: float | None = None) -> float:
        value = self._present(entry, key) if default is None else entry.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int | float):
            self._refuse(f"expected a number, found {_kind(value)}", key)
        return value

    def _present(self, entry: Mapping[str, object], key: str) -> object:
        if key not in entry:
            self._refuse("it is missing", key)
        return entry[key]

    def _refuse(self, message: str, key: str = "") -> NoReturn:
        raise RecordingError(message, path=self.path, line=self.number, key=key)


def _kind(value: object) -> str:
    kinds = {dict: "an object", str: "text", bool: "true or false", type(None): "null"}
    if isinstance(value, list):
        return f"a list of {len(value)}"
    return kinds.get(type(value), "a number")
