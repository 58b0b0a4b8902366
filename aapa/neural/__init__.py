"""Networks of object permanence: OPNet, OPNet+AA, and those they are compared with.

They need PyTorch, the extra [neural]; this module can be imported without it. Where to begin:
`features.py` says what a network is handed, `guidance.py` how OPNet+AA is told where to look,
`models/` holds the networks, `training/` how they are trained, `weights/` two that have been.
"""

from __future__ import annotations

from aapa.neural.checkpoints import Guidance, Meta, load_checkpoint, save_checkpoint
from aapa.neural.features import slot_classes, tensor_of
from aapa.neural.guidance import GuidanceMode, attention_weights, tracked_slots
from aapa.neural.prediction import predict

__all__ = [
    "Guidance",
    "GuidanceMode",
    "Meta",
    "attention_weights",
    "load_checkpoint",
    "predict",
    "save_checkpoint",
    "slot_classes",
    "tensor_of",
    "tracked_slots",
]
