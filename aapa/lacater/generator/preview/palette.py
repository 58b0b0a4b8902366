"""The 256 colours of a GIF: those of the labels as they are, and shades of those of the things.

One palette serves every video, so that a label always has its colour and nothing flickers.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from PIL import Image

from aapa.lacater.generator.preview.annotation import FIXED_COLOURS
from aapa.lacater.generator.preview.painting import COLOURS

_DARK_SHADES, _LIGHT_SHADES = 13, 7
_GRAYS = 48


@cache
def palette_image() -> Image.Image:
    """Give an image that has the palette, for `Image.quantize`."""
    colours = [np.array(colour, dtype=np.float64) for colour in FIXED_COLOURS]
    for colour in COLOURS.values():
        full = np.array(colour, dtype=np.float64)
        colours += [full * share for share in np.linspace(0.3, 1.08, _DARK_SHADES)]
        colours += [
            full * 1.05 + (255.0 - full * 1.05) * share
            for share in np.linspace(0.12, 0.9, _LIGHT_SHADES)
        ]
    colours += [np.full(3, level) for level in np.linspace(40.0, 215.0, _GRAYS)]
    table = np.clip(np.rint(np.array(colours)), 0, 255).astype(np.uint8)
    image = Image.new("P", (1, 1))
    image.putpalette(table.tobytes())
    return image
