"""The networks by name, and how large they are."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from functools import partial
from typing import Final

from torch import nn

from aapa.errors import AnchoringError
from aapa.neural.guidance import GuidanceMode
from aapa.neural.models.baseline_lstm import BaselineLstm
from aapa.neural.models.nonlinear_lstm import NonlinearLstm
from aapa.neural.models.opnet import OPNet
from aapa.neural.models.transformer_lstm import TransformerLstm

LARGEST_SIZE: Final = 8192
"""No layer is wider: a file that asks for more is not one of ours."""


@dataclass(frozen=True, slots=True)
class Network:
    """A kind of network.

    Args:
        build: Makes one, its weights at random; takes sizes by name.
        sizes: The published sizes.
        guided: It takes the matrix W of `guidance.py`.
    """

    build: Callable[..., nn.Module]
    sizes: Mapping[str, int] = field(default_factory=dict)
    guided: bool = False


_OPNET: Final = {"who_hidden": 256, "where_hidden": 512}

NETWORKS: Final[Mapping[str, Network]] = {
    "opnet": Network(OPNet, _OPNET),
    "opnet-aa": Network(OPNet, _OPNET, guided=True),
    "opnet-mlp": Network(partial(OPNet, where="mlp"), _OPNET),
    "baseline-lstm": Network(BaselineLstm, {"hidden": 512}),
    "nonlinear-lstm": Network(NonlinearLstm, {"slot_hidden": 256, "hidden": 512}),
    "transformer-lstm": Network(
        TransformerLstm,
        {"slot_hidden": 256, "feedforward": 2048, "heads": 2, "layers": 2, "hidden": 512},
    ),
}
"""All of them, under the names of the command line."""


def network_named(name: str) -> Network:
    """Give a kind of network. Raises AnchoringError where there is none of that name."""
    network = NETWORKS.get(name)
    if network is not None:
        return network
    near = get_close_matches(name, NETWORKS, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    known = ", ".join(NETWORKS)
    raise AnchoringError(f"there is no network {name!r}; {hint}known are {known}")


def build_network(
    name: str, sizes: Mapping[str, object] | None = None, mode: GuidanceMode = "product"
) -> nn.Module:
    """Make a network, its weights at random.

    Args:
        name: Such as "opnet".
        sizes: What differs from the published sizes.
        mode: How W is going to act, if it is one with guidance.

    Raises:
        AnchoringError: There is no such network, it has no such size, or the size makes no sense.
    """
    network = network_named(name)
    every = dict(network.sizes)
    for key, size in (sizes or {}).items():
        if key not in network.sizes:
            known = ", ".join(network.sizes)
            raise AnchoringError(f"{name} has no size {key!r}; it has {known}")
        if isinstance(size, bool) or not isinstance(size, int) or not 0 < size <= LARGEST_SIZE:
            raise AnchoringError(f"{key} is {size!r}; it has to be from 1 to {LARGEST_SIZE}")
        every[key] = size
    if every.get("slot_hidden", 0) % every.get("heads", 1):
        raise AnchoringError(
            f"slot_hidden is {every['slot_hidden']}; it has to be a multiple of heads, "
            f"{every['heads']}"
        )
    if every.get("layers", 1) > 64:
        raise AnchoringError(f"layers is {every['layers']}; it has to be at most 64")
    model = network.build(**every)
    if isinstance(model, OPNet):
        model.renormalise = mode == "renormalised"
    return model


def parameter_count(model: nn.Module) -> int:
    """Give how many numbers a network has learned."""
    return sum(parameter.numel() for parameter in model.parameters())
