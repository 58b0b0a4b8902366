"""Trained networks on disk: numbers in the safetensors format, everything else as JSON in it.

Nothing in such a file is ever run. What it says of itself is checked before a network is made.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TypeGuard

from aapa.errors import AnchoringError, DatasetError
from aapa.neural.extra import require_torch
from aapa.neural.guidance import GUIDANCE_MODES, GuidanceMode

if TYPE_CHECKING:
    from torch import Tensor
    from torch.nn import Module

METADATA: Final = "icarus"
"""The entry of a file's metadata that holds ours, as JSON."""

LARGEST_FILE: Final = 256 * 1024 * 1024
"""Bytes. A file that is larger is none of ours, and is not read."""

_FORMAT = 1


@dataclass(frozen=True, slots=True)
class Guidance:
    """How OPNet+AA is told what to look at.

    Args:
        weight: w, as it was trained.
        mode: How W acts.
    """

    weight: float
    mode: GuidanceMode


@dataclass(frozen=True, slots=True)
class Meta:
    """What a file says of the network in it.

    Args:
        network: Its name in `NETWORKS`.
        sizes: Where they differ from the published ones.
        guidance: How it is told what to look at; None if it is not.
        recipe: How it was trained: hyper-parameters, data, seed, time, score.
    """

    network: str
    sizes: Mapping[str, int] = field(default_factory=dict)
    guidance: Guidance | None = None
    recipe: Mapping[str, Any] = field(default_factory=dict)


def load_checkpoint(path: Path, mode: GuidanceMode | None = None) -> tuple[Module, Meta]:
    """Read a trained network.

    Args:
        path: The file.
        mode: How W is going to act, where that is not to be as in training.

    Returns:
        The network, in single precision and ready to predict, and what the file says of it.

    Raises:
        AnchoringError: PyTorch is not installed.
        DatasetError: The file cannot be read, or does not hold a whole network.
    """
    require_torch()
    from aapa.neural.models import build_network  # noqa: PLC0415 - an extra

    tensors, entry = read_tensors(path)
    meta = _meta_of(entry, path)
    try:
        trained = meta.guidance.mode if meta.guidance is not None else "product"
        model = build_network(meta.network, meta.sizes, mode or trained)
    except AnchoringError as error:
        raise DatasetError(str(error), path=str(path)) from error
    _check_tensors(tensors, model.state_dict(), path)
    model.load_state_dict({name: tensor.float() for name, tensor in tensors.items()})
    model.eval()
    return model, meta


def save_checkpoint(path: Path, model: Module, meta: Meta, *, half: bool = True) -> None:
    """Write a trained network; the file appears whole or not at all.

    Args:
        path: Where to.
        model: A network of `NETWORKS`.
        meta: What to say of it.
        half: In half precision, which takes half the space and changes boxes by less than the
            tenth part of a pixel.

    Raises:
        DatasetError: The file cannot be written.
    """
    tensors = {
        name: tensor.detach().half() if half else tensor.detach()
        for name, tensor in model.state_dict().items()
    }
    guidance = meta.guidance
    entry = {
        "format": _FORMAT,
        "network": meta.network,
        "sizes": dict(meta.sizes),
        "guidance": guidance and {"weight": guidance.weight, "mode": guidance.mode},
        "recipe": dict(meta.recipe),
    }
    write_tensors(path, tensors, entry)


def read_tensors(path: Path) -> tuple[dict[str, Tensor], dict[str, Any]]:
    """Read a file of ours: its tensors, and its JSON.

    Raises:
        DatasetError: It cannot be read, or is no such file.
    """
    from safetensors import SafetensorError, safe_open  # noqa: PLC0415 - an extra

    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise DatasetError(
                f"is {size} bytes long; a network has at most {LARGEST_FILE}", path=str(path)
            )
        with safe_open(path, "pt") as file:
            text = (file.metadata() or {}).get(METADATA)
            tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
        entry = json.loads(text) if text is not None else None
    except OSError as error:
        reason = error.strerror or str(error)
        raise DatasetError(f"cannot be read: {reason}", path=str(path)) from error
    except (SafetensorError, ValueError, RecursionError) as error:
        raise DatasetError(
            f"is no network in the safetensors format: {error}", path=str(path)
        ) from error
    if not isinstance(entry, dict):
        raise DatasetError(f"its metadata have no entry {METADATA!r} of ours", path=str(path))
    if entry.get("format") != _FORMAT:
        raise DatasetError(
            f"has format {entry.get('format')!r}; this version reads {_FORMAT}", path=str(path)
        )
    return tensors, entry


def write_tensors(path: Path, tensors: Mapping[str, Tensor], entry: Mapping[str, Any]) -> None:
    """Write tensors and JSON to a file that appears whole or not at all.

    Raises:
        DatasetError: The file cannot be written.
    """
    from safetensors import SafetensorError  # noqa: PLC0415 - an extra
    from safetensors.torch import save  # noqa: PLC0415

    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    whole = {name: tensor.contiguous() for name, tensor in tensors.items()}
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            text = json.dumps({"format": _FORMAT, **entry})
            partial.write_bytes(save(whole, {METADATA: text}))
            partial.replace(path)
        finally:
            partial.unlink(missing_ok=True)
    except (OSError, SafetensorError) as error:
        raise DatasetError(f"cannot be written: {error}", path=str(path)) from error


def _meta_of(entry: Mapping[str, Any], path: Path) -> Meta:
    name, sizes, recipe = entry.get("network"), entry.get("sizes", {}), entry.get("recipe", {})
    if not isinstance(name, str):
        raise DatasetError("does not say which network it is", path=str(path))
    if not isinstance(sizes, dict) or not isinstance(recipe, dict):
        raise DatasetError("sizes and recipe have to be objects", path=str(path))
    return Meta(name, sizes, _guidance_of(entry.get("guidance"), path), recipe)


def _guidance_of(entry: object, path: Path) -> Guidance | None:
    if entry is None:
        return None
    if isinstance(entry, dict):
        weight, mode = entry.get("weight"), entry.get("mode")
        if _is_weight(weight) and mode in GUIDANCE_MODES:
            return Guidance(float(weight), mode)
    modes = ", ".join(GUIDANCE_MODES)
    raise DatasetError(
        f"its guidance is {entry!r}; expected a weight above 0 and a mode of {modes}",
        path=str(path),
    )


def _is_weight(value: object) -> TypeGuard[float]:
    return (
        isinstance(value, int | float) and not isinstance(value, bool) and 0 < value < float("inf")
    )


def _check_tensors(found: Mapping[str, Tensor], expected: Mapping[str, Tensor], path: Path) -> None:
    odd = sorted(set(found) ^ set(expected))
    if odd:
        lack = "lacks" if odd[0] in expected else "has, beyond the network,"
        raise DatasetError(f"{lack} the tensor {odd[0]}", path=str(path))
    for name, tensor in found.items():
        if tensor.shape != expected[name].shape:
            raise DatasetError(
                f"has the shape {tuple(tensor.shape)}; expected {tuple(expected[name].shape)}",
                path=str(path),
                key=name,
            )
        if not tensor.is_floating_point():
            raise DatasetError("holds no numbers with a fraction", path=str(path), key=name)
        if not bool(tensor.isfinite().all()):
            raise DatasetError("holds a number that is not finite", path=str(path), key=name)
