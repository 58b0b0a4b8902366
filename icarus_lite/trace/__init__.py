"""What happened, recorded and read back."""

from icarus_lite.trace.frames import Frame, beliefs_line, outcome_from_json, read_frames
from icarus_lite.trace.reader import Trace, inputs_of, read_trace
from icarus_lite.trace.record import TraceWriter, cycle_record, ensure_writable, header

__all__ = [
    "Frame",
    "Trace",
    "TraceWriter",
    "beliefs_line",
    "cycle_record",
    "ensure_writable",
    "header",
    "inputs_of",
    "outcome_from_json",
    "read_frames",
    "read_trace",
]
