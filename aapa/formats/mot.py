"""MOT Challenge text: detections in, tracks out, one object a line.

frame, id, bb_left, bb_top, bb_width, bb_height, conf, x, y, z

Frames and pixels count from 1 in this format and from 0 everywhere else here, so that the first
frame is read as 0 and written as 1, and the top left pixel likewise. The order of the lines means
nothing. A frame that no line names is one in which nothing was detected.

Source: Leal-Taixé et al. 2015, "MOTChallenge 2015", section 3.3; Milan et al. 2016, table 3.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path

from aapa.anchors import Anchor
from aapa.detections import Detection
from aapa.errors import AnchoringError, RecordingError
from aapa.formats.refusals import Refused, refuse
from aapa.jsonl import RecordedFrame
from aapa.validation import checked_detections

_COLUMNS = (
    "frame",
    "id",
    "bb_left",
    "bb_top",
    "bb_width",
    "bb_height",
    "conf",
    "x",
    "y",
    "z",
)
_FEWEST_COLUMNS = 6
_LONGEST_GAP = 100_000
"""Frames. At 30 a second nearly an hour in which nothing is seen: rather a wrong column."""


def read_mot(
    path: Path, type_name: str = "object", refused: Refused = refuse
) -> Iterator[RecordedFrame]:
    """Give the frames of a MOT Challenge file of detections, the empty ones between included.

    Args:
        path: The file, such as `det/det.txt`.
        type_name: The type of every object: the format tells none.
        refused: What becomes of a malformed line.

    Raises:
        AnchoringError: The file cannot be read.
        RecordingError: A line is malformed; the text names file, line and column.
    """
    frames: dict[int, list[Detection]] = defaultdict(list)
    lines: dict[int, int] = {}
    for number, line in enumerate(_lines(path), start=1):
        if not line.strip():
            continue
        try:
            frame, detection = _Line(str(path), number).detection(line, type_name)
        except RecordingError as error:
            refused(error)
            continue
        frames[frame].append(detection)
        lines.setdefault(frame, number)
    previous = -1
    for frame in sorted(frames):
        if frame - previous > _LONGEST_GAP:
            raise RecordingError(
                f"it is {frame + 1}, and nothing is seen in the {frame - previous - 1:,} frames "
                f"before; expected gaps of at most {_LONGEST_GAP:,}",
                path=str(path),
                line=lines[frame],
                key="frame",
            )
        for empty in range(previous + 1, frame):
            yield RecordedFrame(empty, ())
        yield RecordedFrame(frame, tuple(frames[frame]))
        previous = frame


class MotWriter:
    """Anchors as MOT Challenge lines; each name gets a number when it first occurs, from 1.

    Example:
        >>> from aapa import AnchorStatus
        >>> cone = Anchor("cone-1", "cone", (9.0, 19.0, 39.0, 59.0), AnchorStatus.VISIBLE)
        >>> MotWriter().lines(0, [cone])
        ['1,1,10,20,30,40,0,-1,-1,-1']
    """

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}

    def lines(self, frame: int, anchors: Iterable[Anchor]) -> list[str]:
        """Give one line, without its end, for each anchor of a frame.

        Args:
            frame: Its number, counted from 0.
            anchors: In the order in which they are written.
        """
        return [self._line(frame, anchor) for anchor in anchors]

    def _line(self, frame: int, anchor: Anchor) -> str:
        number = self._numbers.setdefault(anchor.name, len(self._numbers) + 1)
        x1, y1, x2, y2 = anchor.box
        values = (x1 + 1, y1 + 1, x2 - x1, y2 - y1, anchor.confidence)
        fields = ",".join(_shortest(value) for value in values)
        return f"{frame + 1},{number},{fields},-1,-1,-1"


def _shortest(value: float) -> str:
    """Give a number to a millionth, without an exponent, which not every reader takes."""
    return f"{value:.6f}".rstrip("0").rstrip(".")


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="utf-8-sig").splitlines()
    except OSError as error:
        raise AnchoringError(f"cannot read {path}: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise AnchoringError(f"{path}: is no text: byte {error.start} is not UTF-8") from error


class _Line:
    """Where a line stands, and how to read it."""

    def __init__(self, path: str, number: int) -> None:
        self._path = path
        self._number = number

    def detection(self, line: str, type_name: str) -> tuple[int, Detection]:
        texts = [text.strip() for text in line.split(",")] if "," in line else line.split()
        if not _FEWEST_COLUMNS <= len(texts) <= len(_COLUMNS):
            raise self._error(
                f"it has {len(texts)} columns; expected {_FEWEST_COLUMNS} to {len(_COLUMNS)}: "
                f"{', '.join(_COLUMNS)}"
            )
        values = {
            key: self._number_of(key, text) for key, text in zip(_COLUMNS, texts, strict=False)
        }
        frame = values["frame"]
        if not frame.is_integer() or frame < 1:
            raise self._error(f"expected a whole number of at least 1, found {texts[0]!r}", "frame")
        for key in ("bb_width", "bb_height"):
            if values[key] <= 0:
                raise self._error(f"it is {values[key]:g}; expected above 0 px", key)
        left, top = values["bb_left"] - 1, values["bb_top"] - 1
        box = (left, top, left + values["bb_width"], top + values["bb_height"])
        # A score only orders what is otherwise the same; detectors give any number, or -1 for none.
        score = min(1.0, max(0.0, values.get("conf", 1.0)))
        try:
            [detection] = checked_detections([Detection(type_name, box, score)], "image")
        except AnchoringError as error:
            raise self._error(str(error)) from error
        return int(frame) - 1, detection

    def _number_of(self, key: str, text: str) -> float:
        try:
            # Python reads 1_000 as a number, the format does not.
            value = float("?" if "_" in text else text)
        except ValueError:
            raise self._error(f"expected a number, found {text!r}", key) from None
        if not math.isfinite(value):
            raise self._error(f"expected a finite number, found {text!r}", key)
        return value

    def _error(self, message: str, key: str = "") -> RecordingError:
        return RecordingError(message, path=self._path, line=self._number, key=key)
