"""Pictures of a video, published or generated: the scene drawn anew from its scene file.

`reconstruction` finds where everything was in each frame, `painting` draws it, `annotation` puts
the labels over it, and `film` writes a GIF or an MP4. The last two need the extra `preview`.
"""

from __future__ import annotations

from aapa.lacater.generator.preview.painting import Painter
from aapa.lacater.generator.preview.reconstruction import reconstructed

__all__ = ["Painter", "reconstructed"]
