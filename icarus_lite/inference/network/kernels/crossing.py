"""Which pairs of an order of keys change when all keys do: found by sorting."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from icarus_lite.inference.network.kernels.columns import Numbers
from icarus_lite.inference.network.kernels.relation import Change, Pair

Slots = NDArray[np.intp]
_Edge = Literal["left", "right"]


def is_below(f: Numbers, g: Numbers, *, strict: bool) -> NDArray[np.bool_]:
    """Compare keys of left with keys of right objects, which broadcast."""
    return f < g if strict else f <= g


def crossed(
    old: tuple[Numbers, Numbers], new: tuple[Numbers, Numbers], *, strict: bool
) -> tuple[Slots, Slots]:
    """Give the pairs of which the answer has changed.

    Either it changes when the left key moves among the old right keys, or when the right key
    moves among the new left keys; if both, it has not changed.

    Args:
        old: (left,) and (right,) the keys before.
        new: Likewise the keys now.
        strict: Whether equal keys do not do.

    Returns:
        The left and the right slots.
    """
    (f_old, g_old), (f, g) = old, new
    low: _Edge = "right" if strict else "left"
    high: _Edge = "left" if strict else "right"
    order = np.argsort(g_old)
    ranked = g_old[order]
    i, place = _between(
        np.searchsorted(ranked, f_old, side=low), np.searchsorted(ranked, f, side=low)
    )
    j = order[place]
    at_first = is_below(f_old[i], g_old[j], strict=strict)
    changed = at_first != is_below(f[i], g[j], strict=strict)
    i, j = i[changed], j[changed]
    order = np.argsort(f)
    ranked = f[order]
    second, place = _between(
        np.searchsorted(ranked, g_old, side=high), np.searchsorted(ranked, g, side=high)
    )
    first = order[place]
    at_first = is_below(f_old[first], g_old[second], strict=strict)
    changed = at_first == is_below(f[first], g_old[second], strict=strict)
    return np.concatenate([i, first[changed]]), np.concatenate([j, second[changed]])


def net(added: list[Pair], removed: list[Pair]) -> Change:
    """Leave out the pairs that were gained and lost again."""
    both = set(added).intersection(removed)
    if not both:
        return added, removed
    return (
        [pair for pair in added if pair not in both],
        [pair for pair in removed if pair not in both],
    )


def _between(old: Slots, new: Slots) -> tuple[Slots, Slots]:
    """Give who has moved past what: each index with each place between its old and new one."""
    who = np.flatnonzero(old != new)
    low = np.minimum(old[who], new[who])
    counts = np.abs(old[who] - new[who])
    total = int(counts.sum())
    skipped = low - (np.cumsum(counts) - counts)
    return np.repeat(who, counts), np.arange(total, dtype=np.intp) + np.repeat(skipped, counts)
