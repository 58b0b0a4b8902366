"""Confidences without float dust, as Python rounds them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def rounded_each(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give (n) each value to nine digits.

    numpy rounds by multiplying and dividing, which differs in the last bit. Of confidences there
    are few different ones, however many anchors.
    """
    different, which = np.unique(values, return_inverse=True)
    exact = np.array([round(value, 9) for value in different.tolist()], dtype=np.float64)
    result: NDArray[np.float64] = exact[which]
    return result
