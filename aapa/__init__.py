"""Action-aware perceptual anchoring: from detections to objects that stay when unseen."""

from __future__ import annotations

from aapa.alignment import Alignment, align
from aapa.anchoring import Anchoring, AnchoringState, step
from aapa.anchors import Anchor, AnchorStatus, Attachment
from aapa.camera import Camera
from aapa.columns import AnchorColumns, DetectionColumns
from aapa.costs import Cost, Place
from aapa.detections import Box, Detection, Position
from aapa.errors import AnchoringError, RecordingError
from aapa.parameters import AnchoringParameters

__all__ = [
    "Alignment",
    "Anchor",
    "AnchorColumns",
    "AnchorStatus",
    "Anchoring",
    "AnchoringError",
    "AnchoringParameters",
    "AnchoringState",
    "Attachment",
    "Box",
    "Camera",
    "Cost",
    "Detection",
    "DetectionColumns",
    "Place",
    "Position",
    "RecordingError",
    "align",
    "step",
]
