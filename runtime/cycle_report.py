"""What one cycle of the loop came to: for the trace, and for whoever watches."""

from __future__ import annotations

from dataclasses import dataclass

from aapa import Anchor, Detection
from icarus_lite import Decision, Outcome, Percept
from icarus_lite.trace import cycle_record
from runtime.drivers import ArmState


@dataclass(frozen=True, slots=True)
class CycleReport:
    """One finished cycle, for the trace and for whoever watches."""

    decision: Decision
    outcomes: tuple[Outcome, ...]
    percepts: tuple[Percept, ...]
    anchors: tuple[Anchor, ...]
    detections: tuple[Detection, ...]
    arm: ArmState

    def record(self, **extra: object) -> dict[str, object]:
        """Give the cycle as a line of the trace."""
        return cycle_record(
            self.decision,
            self.percepts,
            self.outcomes,
            detections=[detection_row(d) for d in self.detections],
            anchors=[anchor_row(a) for a in self.anchors],
            arm={
                "joints": list(self.arm.joints),
                "tcp_pose": list(self.arm.tcp_pose),
                "gripper_closed": self.arm.gripper_closed,
                "gripped": self.arm.gripped,
                "timestamp_s": self.arm.timestamp_s,
            },
            **extra,
        )


def detection_row(detection: Detection) -> dict[str, object]:
    """Give a detection as JSON."""
    row: dict[str, object] = {
        "type": detection.type,
        "box": [round(v, 2) for v in detection.box],
        "score": round(detection.score, 3),
    }
    if detection.position is not None:
        row["position"] = [round(v, 5) for v in detection.position]
    return row


def anchor_row(anchor: Anchor) -> dict[str, object]:
    """Give an anchor as JSON, as in the anchors file, with all that it takes to go on from it."""
    return {
        "name": anchor.name,
        "type": anchor.type,
        "box": [round(v, 2) for v in anchor.box],
        "status": str(anchor.status),
        "parent": anchor.parent,
        "confidence": round(anchor.confidence, 3),
        "position": None if anchor.position is None else [round(v, 5) for v in anchor.position],
        "size": None if anchor.size is None else [round(v, 5) for v in anchor.size],
        "last_seen": anchor.last_seen,
        "streak": anchor.streak,
        "reason": anchor.reason,
    }
