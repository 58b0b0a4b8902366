"""One generated video as it really is: things, camera, paths, boxes, record.

Each video has a stream of chance of its own, so that video 7 of a seed is the same whatever else
is generated.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.outlines import boxes_of, rounded_boxes
from aapa.lacater.generator.placement import drawn_scene
from aapa.lacater.generator.schedule import play
from aapa.lacater.generator.stage import Stage
from aapa.lacater.generator.viewpoint import Viewpoint
from aapa.lacater.scene import Movement, Scene, SceneObject
from aapa.lacater.video import FRAMES, Labels


@dataclass(frozen=True, slots=True, eq=False)
class Simulation:
    """What happened in front of the camera.

    Args:
        number: The video's number.
        bodies: The things; the first is the snitch.
        viewpoint: The camera.
        planned: (n, 301, 3) the bodies' origins as the scene file has them.
        filmed: (n, 300, 3) the bodies' origins as the pictures show them.
        tilts: (n, 300) how far each is turned about its own y axis, rad.
        movements: The record of each body.
        boxes: (n, 300, 4) the boxes, not rounded: x1 y1 x2 y2, px, cut off at the border.
    """

    number: int
    bodies: tuple[Body, ...]
    viewpoint: Viewpoint
    planned: NDArray[np.float64]
    filmed: NDArray[np.float64]
    tilts: NDArray[np.float64]
    movements: tuple[tuple[Movement, ...], ...]
    boxes: NDArray[np.float64]

    @property
    def name(self) -> str:
        """The video's name, as the published ones are named."""
        return video_name(self.number)

    def labels(self) -> Labels:
        """Give the boxes as a label file has them."""
        keys = tuple(f"{body.class_name}_{body.instance}" for body in self.bodies)
        return Labels(keys, rounded_boxes(self.boxes))

    def scene(self) -> Scene:
        """Give the scene as its file has it."""
        x, y, z = (round(float(value), 6) for value in self.viewpoint.place)
        return Scene(
            self.number,
            f"{self.name}.avi",
            tuple(
                self._scene_object(body, path)
                for body, path in zip(self.bodies, self.planned, strict=True)
            ),
            {
                body.instance: record
                for body, record in zip(self.bodies, self.movements, strict=True)
            },
            camera=(x, y, z),
            directions=self.viewpoint.directions(),
            relationships=_relationships(self.planned[:, 0], self.viewpoint.directions()),
        )

    def _scene_object(self, body: Body, path: NDArray[np.float64]) -> SceneObject:
        x, y, z = (float(value) for value in path[0])
        u, v, depth = (float(value) for value in self.viewpoint.project(path[0]))
        return SceneObject(
            body.instance,
            body.shape,
            body.size,
            body.color,
            body.material,
            body.radius,
            round(body.yaw, 6),
            (x, y, z),
            (round(u), round(v), round(depth, 6)),
            path,
        )


def video_name(number: int) -> str:
    """Give the name of a video.

    Example:
        >>> video_name(18)
        'CLEVR_new_000018'
    """
    return f"CLEVR_new_{number:06d}"


def simulate(seed: int, number: int) -> Simulation:
    """Make up one video.

    Args:
        seed: The data set's.
        number: The video's; the same seed and number always give the same video.
    """
    chance = random.Random(f"scene {seed} {number}")  # noqa: S311 - a simulation, no secret
    while True:
        viewpoint = Viewpoint.drawn(chance)
        stage = Stage(*drawn_scene(viewpoint, chance))
        if play(stage, chance):
            return _filmed(number, stage, viewpoint)


def changes(*states: NDArray[np.float64] | NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Tell at which frames (f,) any of some states (f, …) differs from the frame before."""
    moved = np.zeros(len(states[0]), dtype=np.bool_)
    for state in states:
        flat = state.reshape(len(state), -1)
        moved[1:] |= np.any(flat[1:] != flat[:-1], axis=1)
    return moved


def filmed_boxes(
    bodies: Sequence[Body],
    filmed: NDArray[np.float64],
    tilts: NDArray[np.float64],
    viewpoint: Viewpoint,
) -> NDArray[np.float64]:
    """Give the boxes (n, f, 4) of bodies, px, from their places (n, f, 3) and tilts (n, f)."""
    boxes = np.empty((*tilts.shape, 4))
    for index, body in enumerate(bodies):
        # Most things rest most of the time: a pose that lasts is projected once.
        new = changes(filmed[index], tilts[index])
        new[0] = True
        poses = boxes_of(body, filmed[index, new], tilts[index, new], viewpoint)
        boxes[index] = poses[np.cumsum(new) - 1]
    return boxes


def _filmed(number: int, stage: Stage, viewpoint: Viewpoint) -> Simulation:
    filmed, tilts = stage.filmed[:, :FRAMES], stage.tilts[:, :FRAMES]
    return Simulation(
        number,
        stage.bodies,
        viewpoint,
        # What is written is what the labels are made of: reading it back gives the same.
        np.round(stage.planned, 6),
        filmed,
        tilts,
        tuple(tuple(record) for record in stage.movements),
        filmed_boxes(stage.bodies, filmed, tilts, viewpoint),
    )


def _relationships(
    places: NDArray[np.float64], directions: Mapping[str, Sequence[float]]
) -> dict[str, tuple[tuple[int, ...], ...]]:
    """Give, for each direction on the floor, which objects lie that way of each object."""
    found = {}
    for name in ("behind", "front", "left", "right"):
        along = places @ np.array(directions[name])
        ahead = along[None, :] - along[:, None] > 0.2
        found[name] = tuple(tuple(int(i) for i in np.flatnonzero(row)) for row in ahead)
    return found
