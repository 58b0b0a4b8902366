"""Writes pictures as a film: an animated GIF, or an MP4 through ffmpeg.

The extra `preview` brings Pillow and an ffmpeg.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterable
from pathlib import Path
from typing import Final

from PIL import Image

from aapa.errors import DatasetError
from aapa.lacater.generator.preview.palette import palette_image

FRAMES_PER_SECOND: Final = 24
"""As the published videos have it."""

GIF_STEP: Final = 2
"""A GIF has every second frame: it stays small, and few programs play faster ones."""


def write_film(path: Path, pictures: Iterable[Image.Image], step: int) -> None:
    """Write pictures as a film.

    Args:
        path: Ends with .gif or .mp4.
        pictures: All of one size.
        step: How many frames of the video each picture stands for.

    Raises:
        DatasetError: The ending is another, the file cannot be written, or for an MP4 there is
            no ffmpeg.
    """
    ending = path.suffix.lower()
    if ending not in (".gif", ".mp4"):
        raise DatasetError("a film ends with .gif or .mp4", path=str(path))
    partial = path.with_name(f".{path.name}.part{ending}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        (_write_gif if ending == ".gif" else _write_mp4)(partial, pictures, step)
        partial.replace(path)
    except OSError as error:
        raise DatasetError(
            f"cannot be written: {error.strerror or error}", path=str(path)
        ) from error
    finally:
        if partial.exists():
            partial.unlink()


def _write_gif(path: Path, pictures: Iterable[Image.Image], step: int) -> None:
    small = [
        picture.quantize(palette=palette_image(), dither=Image.Dither.NONE) for picture in pictures
    ]
    small[0].save(
        path,
        save_all=True,
        append_images=small[1:],
        duration=round(1000 * step / FRAMES_PER_SECOND),
        loop=0,
        optimize=False,
    )


def _write_mp4(path: Path, pictures: Iterable[Image.Image], step: int) -> None:
    try:
        import imageio_ffmpeg  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise DatasetError(
            "an MP4 needs ffmpeg: pip install 'icarus-lite[preview]'; a .gif does without",
            path=str(path),
        ) from error
    frames = iter(pictures)
    first = next(frames)
    command = [
        imageio_ffmpeg.get_ffmpeg_exe(),
        *("-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"),
        *("-s", f"{first.width}x{first.height}", "-r", f"{FRAMES_PER_SECOND / step:g}"),
        *("-i", "-", "-an", "-vcodec", "libx264", "-pix_fmt", "yuv420p", "-crf", "18"),
        str(path),
    ]
    with subprocess.Popen(  # noqa: S603 - the program comes with the package
        command, stdin=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        assert process.stdin is not None
        assert process.stderr is not None
        try:
            process.stdin.write(first.tobytes())
            for frame in frames:
                process.stdin.write(frame.tobytes())
            process.stdin.close()
        except BrokenPipeError:
            # It says why below.
            pass
        complaint = process.stderr.read().decode(errors="replace").strip()
    if process.returncode:
        raise DatasetError(f"ffmpeg failed: {complaint}", path=str(path))
