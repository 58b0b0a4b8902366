"""Where the published data set keeps what.

labels/CLEVR_new_000018_bb.json             the true boxes
scenes/CLEVR_new_000018.json                objects, paths, actions
od_perception/CLEVR_new_000018.pkl          what the Faster R-CNN saw
perfect_perception/CLEVR_new_000018.pkl     what a perfect detector would see
containment_and_occlusions/*.txt            which frames have which label
exact_boxes/CLEVR_new_000018.npy            the boxes before rounding (generated data only)
"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Final

FRAME_LISTS: Final = {
    "containment": "containment_annotations.txt",
    "containment_only_static": "containment_only_static_annotations.txt",
    "containment_with_move": "containment_with_move_annotations.txt",
    "visible_0": "visibility_rate_gt_0.txt",
    "visible_30": "visibility_rate_gt_30.txt",
    "visible_99": "visibility_rate_gt_99.txt",
}
"""The frame list behind each field of `FrameMasks`."""

_LABELS_END = "_bb.json"


class PerceptionKind(StrEnum):
    """Whose detections: those of the trained detector, or perfect ones."""

    OD = "od"
    PP = "pp"

    @property
    def folder(self) -> str:
        """The folder its pickles lie in."""
        return "od_perception" if self is PerceptionKind.OD else "perfect_perception"


def labels_path(root: Path, video: str) -> Path:
    """Give the file of a video's true boxes."""
    return root / "labels" / f"{video}{_LABELS_END}"


def scene_path(root: Path, video: str) -> Path:
    """Give a video's scene file."""
    return root / "scenes" / f"{video}.json"


def perception_path(root: Path, video: str, kind: PerceptionKind) -> Path:
    """Give the pickle of a video's detections."""
    return root / kind.folder / f"{video}.pkl"


def exact_boxes_path(root: Path, video: str) -> Path:
    """Give the file of a video's boxes before rounding."""
    return root / "exact_boxes" / f"{video}.npy"


def frame_lists_folder(root: Path) -> Path:
    """Give the folder of the frame lists."""
    return root / "containment_and_occlusions"


def video_of_labels(path: Path) -> str | None:
    """Give the video that a file of true boxes belongs to, or None if it is no such file."""
    name = path.name
    if not name.endswith(_LABELS_END) or name.startswith("."):
        return None
    return name.removesuffix(_LABELS_END)
