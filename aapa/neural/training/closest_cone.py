"""Where the attention may be taught to be: at the snitch, or at the cone that it vanished under.

A rule without actions and without labels: what vanishes is under the nearest thing, if that is a
cone, until it is seen again. The published loader works such a target out, and the published
training makes no use of it. Ours may, in its first epochs, because it takes the network long to
find out by itself whom to follow.

Source: Shamsian et al. 2020 (the published code, data loader). There, slots that are empty in a
frame count as things in the corner of the picture; here they do not count.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_SNITCH = 0


def closest_cone(table: NDArray[np.int16]) -> NDArray[np.int8]:
    """Give (frames,) the slot to attend to.

    Args:
        table: (frames, 15, 6) of a video, see `features.slot_table`.
    """
    seen = table[:, :, 4] > 0
    cones = table[:, :, 5] > 0
    # Twice the centres, so that they stay whole.
    places = (table[:, :, :2] + table[:, :, 2:4]).astype(np.int64)
    slots = np.zeros(len(table), dtype=np.int8)
    last = places[0, _SNITCH]
    followed: list[int] = [_SNITCH]
    for frame in range(len(table)):
        visible = seen[frame]
        back = next((depth for depth, slot in enumerate(followed) if visible[slot]), None)
        if back is not None:
            # The innermost that is seen again is what is followed; what covered it is done with.
            del followed[back + 1 :]
        else:
            cover = _nearest(places[frame], visible, last)
            if cover is not None and cones[frame, cover]:
                followed.append(cover)
        slots[frame] = followed[-1]
        if visible[followed[-1]]:
            last = places[frame, followed[-1]]
    return slots


def _nearest(
    places: NDArray[np.int64], seen: NDArray[np.bool_], place: NDArray[np.int64]
) -> int | None:
    candidates = np.flatnonzero(seen)
    if not len(candidates):
        return None
    offsets = places[candidates] - place
    return int(candidates[np.argmin((offsets * offsets).sum(axis=1))])
