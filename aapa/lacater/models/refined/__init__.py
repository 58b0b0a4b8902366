"""`aapa-refined`: the box of `aapa-plus`, put right by a small network.

`evidence` is what it is told, `recurrent` the network, `tracker` both put together.
"""

from __future__ import annotations

from aapa.lacater.models.refined.tracker import Refined, shipped_weights

__all__ = ["Refined", "shipped_weights"]
