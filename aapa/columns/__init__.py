"""The anchoring of a crowd: the same cycle, over columns of numbers instead of objects.

With a thousand objects, most of a frame would go into making one Python object for each of them
and looking into it again. Here each attribute is one array, and an `Anchor` is made when it is
read. What comes out is the same to the last bit.
"""

from __future__ import annotations

from aapa.columns.anchors import AnchorColumns
from aapa.columns.detections import DetectionColumns

__all__ = ["AnchorColumns", "DetectionColumns"]
