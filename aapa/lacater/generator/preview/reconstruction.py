"""What was filmed, found again from a scene file.

The file has every path interpolated linearly; the record says which part of it was which action,
and with that the easing of the pictures is put back. Boxes computed from the result are those of
the labels, which is a check on both.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from aapa.errors import DatasetError
from aapa.lacater.classes import class_number
from aapa.lacater.generator.bodies import RADII, SNITCH_RADIUS, Body
from aapa.lacater.generator.motion import QUARTER_TURN, Moves, pick_place, slide, turn
from aapa.lacater.generator.simulation import Simulation, filmed_boxes
from aapa.lacater.generator.viewpoint import DEFAULT_PLACE, Viewpoint
from aapa.lacater.scene import Movement, Scene, SceneObject

_WAYS = {"_slide": slide, "_pick_place": pick_place, "_contain": pick_place}


def reconstructed(scene: Scene, frames: int) -> Simulation:
    """Give what was filmed.

    Args:
        scene: The scene file.
        frames: How many frames the video has.

    Raises:
        DatasetError: The scene is shorter, or holds something that CATER's scenes do not.
    """
    for thing in scene.objects:
        if len(thing.locations) < frames:
            raise DatasetError(
                f"{thing.instance} has {len(thing.locations)} locations for {frames} frames",
                path=scene.image_filename,
            )
    bodies = tuple(_body(thing, scene.image_filename) for thing in scene.objects)
    viewpoint = Viewpoint.at(*(scene.camera or DEFAULT_PLACE))
    records = tuple(scene.movements.get(thing.instance, ()) for thing in scene.objects)
    paths, tilts = [], []
    for thing, record in zip(scene.objects, records, strict=True):
        paths.append(_filmed(thing.locations, record)[:frames])
        tilts.append(_tilts(len(thing.locations), record)[:frames])
    filmed, tilted = np.stack(paths), np.stack(tilts)
    return Simulation(
        scene.image_index,
        bodies,
        viewpoint,
        np.stack([thing.locations for thing in scene.objects]),
        filmed,
        tilted,
        records,
        filmed_boxes(bodies, filmed, tilted, viewpoint),
    )


def _body(thing: SceneObject, path: str) -> Body:
    if class_number(thing.class_name) is None:
        raise DatasetError(
            f"there is no shape, size, colour and material {thing.class_name} in CATER",
            path=path,
            key=thing.instance,
        )
    radius = SNITCH_RADIUS if thing.shape == "spl" else RADII[thing.size]
    return Body(
        thing.shape,
        thing.size,
        thing.color,
        thing.material,
        thing.sized or radius,
        thing.instance,
        thing.rotation,
    )


def _filmed(locations: NDArray[np.float64], record: tuple[Movement, ...]) -> NDArray[np.float64]:
    filmed = locations.copy()
    for move in record:
        way = _WAYS.get(move.action)
        last = min(move.end, len(locations) - 1)
        if way is None or last <= move.start:
            continue
        moves: Moves = way(move.end - move.start + 1)
        path = moves.filmed.path(locations[move.start], locations[last])
        filmed[move.start : last + 1] = path[: last + 1 - move.start]
    return filmed


def _tilts(length: int, record: tuple[Movement, ...]) -> NDArray[np.float64]:
    tilts = np.zeros(length)
    for move in record:
        if move.action == "_rotate" and move.start < move.end:
            shares = turn(move.end - move.start + 1)[: length - move.start]
            tilts[move.start : move.start + len(shares)] += QUARTER_TURN * shares
            tilts[move.start + len(shares) :] += QUARTER_TURN
    return tilts
