"""Which format a recording has, and its frames."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path
from typing import assert_never

from aapa.errors import AnchoringError
from aapa.formats.coco import read_coco
from aapa.formats.mot import read_mot
from aapa.formats.refusals import Refused, refuse
from aapa.jsonl import RecordedFrame, read_frames


class InputFormat(StrEnum):
    """What recorded detections may come in."""

    JSONL = "jsonl"
    MOT = "mot"
    COCO = "coco"


class OutputFormat(StrEnum):
    """What anchors can be written in."""

    JSONL = "jsonl"
    MOT = "mot"


_BY_EXTENSION = {
    ".txt": InputFormat.MOT,
    ".csv": InputFormat.MOT,
    ".json": InputFormat.COCO,
}


def guess_format(path: Path) -> InputFormat:
    """Give the format that the end of a file's name stands for; JSON Lines where it tells none.

    Example:
        >>> str(guess_format(Path("det/det.txt"))), str(guess_format(Path("seen.jsonl")))
        ('mot', 'jsonl')
    """
    return _BY_EXTENSION.get(path.suffix.lower(), InputFormat.JSONL)


def read_recording(
    path: Path,
    format_: InputFormat | None = None,
    *,
    images: Path | None = None,
    type_name: str = "object",
    refused: Refused = refuse,
) -> Iterator[RecordedFrame]:
    """Give the frames of a recording in any of the formats.

    Args:
        path: The recording.
        format_: Its format; what the end of its name stands for if left out.
        images: For COCO results, the file with the images and categories.
        type_name: For MOT text, the type of every object.
        refused: What becomes of malformed lines or entries.

    Raises:
        AnchoringError: The recording cannot be opened or is malformed, or `images` does not fit.
    """
    chosen = guess_format(path) if format_ is None else format_
    if images is not None and chosen is not InputFormat.COCO:
        raise AnchoringError(f"{path} is read as {chosen}; only coco has a file of images")
    match chosen:
        case InputFormat.JSONL:
            return read_frames(path, refused)
        case InputFormat.MOT:
            return read_mot(path, type_name, refused)
        case InputFormat.COCO:
            return read_coco(path, images, refused)
        case _:
            assert_never(chosen)
