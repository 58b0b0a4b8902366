"""What happened, recorded and read back."""

from icarus_lite.trace.asking import (
    Comparison,
    Times,
    compare,
    condition_of,
    matching,
    pattern_of,
    when,
)
from icarus_lite.trace.frames import Frame, beliefs_line, outcome_from_json, read_frames
from icarus_lite.trace.ground_text import parse_action, parse_belief
from icarus_lite.trace.reader import Trace, inputs_of, read_trace, stream_trace
from icarus_lite.trace.record import TraceWriter, cycle_record, ensure_writable, header
from icarus_lite.trace.recording import Instant, Recording
from icarus_lite.trace.replaying import LOST, Divergence, Replay, replay
from icarus_lite.trace.resuming import RESUMED, resumed_agent
from icarus_lite.trace.serving import serves
from icarus_lite.trace.telling import Episode, Story, tell

__all__ = [
    "LOST",
    "RESUMED",
    "Comparison",
    "Divergence",
    "Episode",
    "Frame",
    "Instant",
    "Recording",
    "Replay",
    "Story",
    "Times",
    "Trace",
    "TraceWriter",
    "beliefs_line",
    "compare",
    "condition_of",
    "cycle_record",
    "ensure_writable",
    "header",
    "inputs_of",
    "matching",
    "outcome_from_json",
    "parse_action",
    "parse_belief",
    "pattern_of",
    "read_frames",
    "read_trace",
    "replay",
    "resumed_agent",
    "serves",
    "stream_trace",
    "tell",
    "when",
]
