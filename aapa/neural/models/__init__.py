"""The networks, one a module; `catalogue.py` knows them by name.

All take (batch, frames, 15, numbers) features and, if they attend, (batch, frames, 15) weights,
and give (batch, frames, 4) boxes as shares of the picture. They need PyTorch, the extra [neural].
"""

from __future__ import annotations

from aapa.neural.models.baseline_lstm import BaselineLstm
from aapa.neural.models.catalogue import NETWORKS, build_network, parameter_count
from aapa.neural.models.nonlinear_lstm import NonlinearLstm
from aapa.neural.models.opnet import OPNet
from aapa.neural.models.transformer_lstm import TransformerLstm

__all__ = [
    "NETWORKS",
    "BaselineLstm",
    "NonlinearLstm",
    "OPNet",
    "TransformerLstm",
    "build_network",
    "parameter_count",
]
