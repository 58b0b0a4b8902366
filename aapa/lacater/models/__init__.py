"""Models of object permanence: each follows the snitch through a video, frame by frame.

`model.py` says what a model is and what it is handed, `network.py` what one that was trained is;
`catalogue.py` knows all by name.
"""

from __future__ import annotations

from aapa.lacater.models.catalogue import PAPER_MODELS, model_named, models_named
from aapa.lacater.models.model import ActionReport, Frame, Model, SureTracker, Tracker
from aapa.lacater.models.network import Footage, Network

__all__ = [
    "PAPER_MODELS",
    "ActionReport",
    "Footage",
    "Frame",
    "Model",
    "Network",
    "SureTracker",
    "Tracker",
    "model_named",
    "models_named",
]
