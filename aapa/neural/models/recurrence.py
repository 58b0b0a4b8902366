"""The LSTM layers of all models: one layer, one direction, no biases, the batch first."""

from __future__ import annotations

from torch import Tensor, nn


class Lstm(nn.LSTM):
    """An LSTM layer that starts from zeros and gives its states alone.

    Args:
        inputs: The size of what it reads in a frame.
        hidden: The size of what it gives.
    """

    def __init__(self, inputs: int, hidden: int) -> None:
        super().__init__(inputs, hidden, bias=False, batch_first=True)

    def forward(self, sequence: Tensor) -> Tensor:  # type: ignore[override] # states alone
        """Give (batch, frames, hidden), of a (batch, frames, inputs) sequence."""
        states: Tensor = super().forward(sequence)[0]
        return states
