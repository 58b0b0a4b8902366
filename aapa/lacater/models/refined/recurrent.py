"""A gated recurrent unit with a linear layer on top, in numpy: small enough to need no more.

Source: Cho et al. 2014; the equations and the order of the gates are those of PyTorch's GRU.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from numpy.lib.npyio import NpzFile
from numpy.typing import NDArray

from aapa.errors import DatasetError

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Weights:
    """The numbers that were learned, for n inputs, h hidden units and m outputs.

    Args:
        into: (3h, n) from the input to the gates: reset, update, new.
        into_bias: (3h,)
        back: (3h, h) from the hidden units to the gates.
        back_bias: (3h,)
        out: (m, h + n) from hidden units and input to the output.
        out_bias: (m,)
    """

    into: Array
    into_bias: Array
    back: Array
    back_bias: Array
    out: Array
    out_bias: Array

    @property
    def hidden(self) -> int:
        """The number of hidden units."""
        return int(self.back.shape[1])


class GatedUnit:
    """Runs the unit step by step.

    Args:
        weights: What was learned.
    """

    def __init__(self, weights: Weights) -> None:
        self._weights = weights
        self._hidden = np.zeros(weights.hidden)

    def step(self, inputs: Array) -> Array:
        """Take in (n,) inputs, and give (m,) outputs."""
        w, before, size = self._weights, self._hidden, self._weights.hidden
        new = w.into @ inputs + w.into_bias
        old = w.back @ before + w.back_bias
        gates = 1.0 / (1.0 + np.exp(-(new[: 2 * size] + old[: 2 * size])))
        reset, update = gates[:size], gates[size:]
        proposed = np.tanh(new[2 * size :] + reset * old[2 * size :])
        self._hidden = proposed + update * (before - proposed)
        output: Array = w.out @ np.concatenate([self._hidden, inputs]) + w.out_bias
        return output


def read_weights(path: Path, inputs: int, outputs: int) -> Weights:
    """Read what was learned.

    Args:
        path: A .npz file with an array for each field of `Weights`.
        inputs: How many the unit has to take.
        outputs: How many it has to give.

    Raises:
        DatasetError: The file cannot be read, or is not of such a unit.
    """
    try:
        # Opened here, since numpy leaves a file open that turns out to be none of its own.
        with path.open("rb") as stream, NpzFile(stream, allow_pickle=False) as file:
            arrays = {name: file[name].astype(np.float64) for name in file.files}
    except (OSError, ValueError, EOFError, BadZipFile) as error:
        raise DatasetError(f"cannot be read as weights: {error}", path=str(path)) from error
    names = [field.name for field in fields(Weights)]
    if sorted(arrays) != sorted(names):
        raise DatasetError(f"expected the arrays {', '.join(names)}", path=str(path))
    weights = Weights(**arrays)
    size = len(weights.into) // 3
    wanted = {
        "into": (3 * size, inputs),
        "into_bias": (3 * size,),
        "back": (3 * size, size),
        "back_bias": (3 * size,),
        "out": (outputs, size + inputs),
        "out_bias": (outputs,),
    }
    for name, shape in wanted.items():
        if arrays[name].shape != shape or not np.isfinite(arrays[name]).all():
            raise DatasetError(
                f"expected {shape} finite numbers, found {arrays[name].shape}",
                path=str(path),
                key=name,
            )
    return weights


def write_weights(path: Path, weights: Weights) -> None:
    """Write what was learned, in single precision."""
    arrays = {
        field.name: getattr(weights, field.name).astype(np.float32) for field in fields(Weights)
    }
    np.savez_compressed(path, **arrays)
