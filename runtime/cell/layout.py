"""Where things stand at first: a seeded, non-overlapping layout inside the area the camera sees."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from runtime.cell.arrangement import FIXTURE, PlacedPart
from runtime.errors import UsageError
from runtime.kinematics import Matrix
from runtime.parts import PartModel, Primitive

FIXTURE_HEIGHT_M: Final = 0.006

_TRIES: Final = 400  # places tried for one part before the layout starts over
_LAYOUTS: Final = 20


@dataclass(frozen=True, slots=True)
class LayoutParameters:
    """What stands in the cell and where it may stand.

    Args:
        parts: Types of the parts, one entry each; "case" goes into the fixture.
        x_m: From and to, for every part's whole footprint, m in the base frame.
        y_m: Likewise.
        reach_m: No part's centre is nearer to or farther from the base axis than this: close to
            the axis a straight move down would pass a singularity.
        gap_m: Least free space between two parts, for the fingers.
        fixture_xy_m: Nominal place of the fixture.
        fixture_shift_m: The fixture is off its nominal place by at most this in x and in y.
    """

    parts: tuple[str, ...] = (
        "case",
        "casingtop",
        "hubcover",
        "input",
        "output",
        "transfer",
        "plug",
        "bearing",
        "bearing",
    )
    x_m: tuple[float, float] = (0.25, 0.60)
    y_m: tuple[float, float] = (-0.28, 0.28)
    reach_m: tuple[float, float] = (0.30, 0.62)
    gap_m: float = 0.028
    fixture_xy_m: tuple[float, float] = (0.40, 0.16)
    fixture_shift_m: float = 0.012


@dataclass(frozen=True, slots=True)
class Layout:
    """The parts in their first places, and the fixture."""

    parts: tuple[PlacedPart, ...]
    fixture: PlacedPart


def random_layout(
    models: Mapping[str, PartModel], seed: int, parameters: LayoutParameters | None = None
) -> Layout:
    """Draw a layout; the same seed and parameters give the same layout.

    Raises:
        UsageError: A type is unknown, or the parts do not fit into the area.
    """
    parameters = parameters or LayoutParameters()
    for kind in parameters.parts:
        if kind not in models:
            raise UsageError(f"No part of type {kind!r} is known; there are {', '.join(models)}.")
    rng = np.random.default_rng([seed, 0])
    shift = rng.uniform(-parameters.fixture_shift_m, parameters.fixture_shift_m, 2)
    x, y = np.asarray(parameters.fixture_xy_m) + shift
    fixture = PlacedPart(FIXTURE, _fixture_model(), _standing(float(x), float(y), 0.003))
    for _ in range(_LAYOUTS):
        placed = _attempt(models, parameters, fixture, rng)
        if placed is not None:
            return Layout(placed, fixture)
    raise UsageError(
        f"{len(parameters.parts)} parts do not fit into the area; use fewer parts or a smaller gap."
    )


def _attempt(
    models: Mapping[str, PartModel],
    parameters: LayoutParameters,
    fixture: PlacedPart,
    rng: np.random.Generator,
) -> tuple[PlacedPart, ...] | None:
    """Place the parts, largest first; None if one finds no free place."""
    names = _names(parameters.parts)
    placed: dict[str, PlacedPart] = {}
    rooms = [fixture]
    by_size = sorted(names, key=lambda name: (-max(models[names[name]].size[:2]), name))
    for name in by_size:
        model = models[names[name]]
        height = model.size[2] / 2
        if model.type == "case" and "case" not in {p.model.type for p in placed.values()}:
            x, y, _ = fixture.position
            pose = _standing(x, y, FIXTURE_HEIGHT_M + height)
            placed[name] = PlacedPart(name, model, pose, parent=FIXTURE)
            continue
        for _ in range(_TRIES):
            x = float(rng.uniform(*_inside(parameters.x_m, model.size[0])))
            y = float(rng.uniform(*_inside(parameters.y_m, model.size[1])))
            part = PlacedPart(name, model, _standing(x, y, height))
            if parameters.reach_m[0] <= math.hypot(x, y) <= parameters.reach_m[1] and all(
                _apart(part, other) >= parameters.gap_m for other in rooms
            ):
                placed[name] = part
                rooms.append(part)
                break
        else:
            return None
    return tuple(placed[name] for name in names)


def _names(kinds: Sequence[str]) -> dict[str, str]:
    """Give each part a name, such as "bearing-2", with its type."""
    seen: dict[str, int] = {}
    names: dict[str, str] = {}
    for kind in kinds:
        seen[kind] = seen.get(kind, 0) + 1
        names[f"{kind}-{seen[kind]}"] = kind
    return names


def _inside(limits: tuple[float, float], size: float) -> tuple[float, float]:
    return limits[0] + size / 2, limits[1] - size / 2


def _apart(one: PlacedPart, other: PlacedPart) -> float:
    """Give the distance between two footprints, taken as discs or unturned rectangles."""
    dx, dy = abs(one.position[0] - other.position[0]), abs(one.position[1] - other.position[1])
    radius = 0.0
    for model in (one.model, other.model):
        if all(solid.shape == "cylinder" for solid in model.primitives):
            radius += model.size[0] / 2
        else:
            dx -= model.size[0] / 2
            dy -= model.size[1] / 2
    return math.hypot(max(dx, 0.0), max(dy, 0.0)) - radius


def _standing(x: float, y: float, z: float) -> Matrix:
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def _fixture_model() -> PartModel:
    size = (0.150, 0.190, FIXTURE_HEIGHT_M)
    plate = Primitive("box", size, (0.0, 0.0, 0.0), (0.22, 0.23, 0.25))
    return PartModel(FIXTURE, (plate,), size, 0.0, size[0])
