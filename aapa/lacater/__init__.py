"""The LA-CATER data set: its files, the rules behind its labels, and how models are scored.

Nothing here knows what an action means for who moves with whom: attachments come from outside.

Where to begin: `video.py` holds the data of one video, `layout.py` says where the files lie,
`reading.py` and `writing.py` read and write them, `label_rules.py` derives labels, `metric.py`
scores, and `models/` tracks the snitch.
"""

from __future__ import annotations

from aapa.lacater.label_rules import frame_masks, perfect_perception
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.metric import VideoScore, score_video
from aapa.lacater.reading import Dataset
from aapa.lacater.scene import Movement, Scene, SceneObject
from aapa.lacater.video import FrameMasks, Labels, Perception, Video
from aapa.lacater.writing import write_frame_lists, write_video

__all__ = [
    "Dataset",
    "FrameMasks",
    "Labels",
    "Movement",
    "Perception",
    "PerceptionKind",
    "Scene",
    "SceneObject",
    "Video",
    "VideoScore",
    "frame_masks",
    "perfect_perception",
    "score_video",
    "write_frame_lists",
    "write_video",
]
