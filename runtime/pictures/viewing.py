"""The viewer opened on a run, or a file written for it."""

from __future__ import annotations

import re
from pathlib import Path

import rerun as rr

from icarus_lite.trace import Recording
from runtime.errors import UsageError
from runtime.pictures.layout import layout
from runtime.pictures.logging import log_run


def save_pictures(recording: Recording, path: Path) -> None:
    """Write a run as a file that the viewer opens, the one in a browser too.

    Raises:
        UsageError: the file cannot be written.
        TraceError: a line of the trace cannot be read.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    except OSError as error:
        raise UsageError(f"{path}: cannot be written: {error.strerror}") from error
    stream = _stream(recording)
    blueprint = layout(has_camera=_has_camera(recording))
    rr.save(path, default_blueprint=blueprint, recording=stream)
    log_run(recording, stream)
    rr.disconnect(recording=stream)


def show_pictures(recording: Recording) -> None:
    """Open the viewer on a run.

    Raises:
        UsageError: the viewer cannot be opened here.
        TraceError: a line of the trace cannot be read.
    """
    stream = _stream(recording)
    try:
        rr.spawn(default_blueprint=layout(has_camera=_has_camera(recording)), recording=stream)
    except RuntimeError as error:
        message = f"the viewer cannot be opened here: {error}; --save FILE.rrd writes a file for it"
        raise UsageError(message) from None
    log_run(recording, stream)
    stream.flush()


def _stream(recording: Recording) -> rr.RecordingStream:
    header = recording.header
    words = [recording.domain.name]
    words += [str(header[key]) for key in ("task", "robot") if key in header]
    return rr.RecordingStream(re.sub(r"[^A-Za-z0-9-]+", "-", "-".join(["icarus", *words])))


def _has_camera(recording: Recording) -> bool:
    return any(recording.record(cycle).get("anchors") for cycle in recording.cycles[:3])
