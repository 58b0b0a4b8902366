"""What others record, in and out: MOT Challenge text and COCO results beside our JSON Lines.

`recordings` chooses; `mot` and `coco` each know one format. All give the same frames.
"""

from __future__ import annotations

from aapa.formats.mot import MotWriter
from aapa.formats.recordings import InputFormat, OutputFormat, guess_format, read_recording

__all__ = ["InputFormat", "MotWriter", "OutputFormat", "guess_format", "read_recording"]
