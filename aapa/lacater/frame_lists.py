"""The frame lists: one line a video, its name, a tab, and the numbers of its frames."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from aapa.errors import DatasetError

_LARGEST_FRAME = 100_000


def read_frame_list(path: Path) -> dict[str, tuple[int, ...]]:
    """Give the frames listed for each video, in the order of the file.

    Raises:
        DatasetError: The file cannot be read, or a line is no frame list.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8"
        raise DatasetError(f"cannot be read: {reason}", path=str(path)) from error
    listed: dict[str, tuple[int, ...]] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        video, tab, frames = line.partition("\t")
        where = f"line {number}"
        if not tab or not video:
            raise DatasetError(
                "expected a video's name, a tab and frame numbers", path=str(path), key=where
            )
        if video in listed:
            raise DatasetError(f"{video} is listed a second time", path=str(path), key=where)
        listed[video] = _frames(frames.strip(), path, f"{where} ({video})")
    return listed


def format_frame_list(masks: Mapping[str, NDArray[np.bool_]]) -> str:
    r"""Give the text of a frame list, one line a video, in the order given.

    Example:
        >>> format_frame_list({"CLEVR_new_000018": np.array([False, True, True])})
        'CLEVR_new_000018\t1,2\n'
    """
    return "".join(
        f"{video}\t{','.join(map(str, np.flatnonzero(mask).tolist()))}\n"
        for video, mask in masks.items()
    )


def mask_of(frames: tuple[int, ...], count: int) -> NDArray[np.bool_]:
    """Give the (count,) mask of the listed frames; a frame beyond the video is an IndexError."""
    mask = np.zeros(count, dtype=np.bool_)
    mask[list(frames)] = True
    return mask


def _frames(text: str, path: Path, where: str) -> tuple[int, ...]:
    if not text:
        return ()
    try:
        frames = tuple(map(int, text.split(",")))
    except ValueError as error:
        raise DatasetError(
            "expected frame numbers with commas between them", path=str(path), key=where
        ) from error
    if min(frames) < 0 or max(frames) > _LARGEST_FRAME:
        raise DatasetError(
            f"frame {min(frames) if min(frames) < 0 else max(frames)} is in no video",
            path=str(path),
            key=where,
        )
    return frames
