"""The things in a generated scene: what there is, how large, and what shape it has.

A shape is the convex hull of equal balls, in units of the body's radius about its own origin:
one ball is a sphere, eight make a cube with round edges, rings of tiny ones a cylinder and a
cone, points a ball with spikes. The outline of such a hull is found ball by ball, whatever way
it is turned.

Source: measured on the meshes of CATER's Blender assets. The boxes of cube, cylinder, sphere and
cone overlap those of the meshes by 0.996 and more. The snitch's mesh reaches 1.095 to 1.22 from
its middle, and its box overlaps that of a ball of 1.16 by 0.96; so do those of the snitch here.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from functools import cache
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.classes import COLORS, MATERIALS, SHAPES, class_number

RADII: Final = {"large": 0.75, "medium": 0.5, "small": 0.25}
"""The radius of each size, in units of the scene."""

SNITCH_RADIUS: Final = 0.3
"""The snitch is a little larger than a small object."""

FEWEST, MOST = 5, 10
"""How many objects a scene has; the snitch, a medium and a large cone are always among them."""

_INSTANCES: Final = {
    "spl": "Spl",
    "cone": "Cone",
    "sphere": "Sphere",
    "cube": "SmoothCube_v2",
    "cylinder": "SmoothCylinder-Short",
}
# Where the origin of a mesh lies off the place it is put at; the files' own, not scaled.
_ORIGINS: Final = {"cone": (-0.0339, -0.0289, 0.1809), "spl": (-0.0142, 0.0029, 0.0421)}
_RING = 32


@dataclass(frozen=True, slots=True)
class Body:
    """One thing.

    Args:
        shape: "spl" (the snitch), "cone", "sphere", "cube" or "cylinder".
        size: "large", "medium" or "small".
        color: Such as "gold".
        material: "metal" or "rubber".
        radius: In units of the scene.
        instance: Its name in the scene, such as "Cone_0".
        yaw: How it is turned about the vertical at first, rad.
    """

    shape: str
    size: str
    color: str
    material: str
    radius: float
    instance: str
    yaw: float

    @property
    def class_name(self) -> str:
        """What the detector calls it."""
        return f"{self.size}_{self.color}_{self.shape}_{self.material}"

    @property
    def class_id(self) -> int:
        """The number of its class."""
        number = class_number(self.class_name)
        assert number is not None
        return number

    def origin_at(self, x: float, y: float) -> tuple[float, float, float]:
        """Give where its origin is once it is put at a place of the floor."""
        dx, dy, dz = _ORIGINS.get(self.shape, (0.0, 0.0, 0.0))
        return x + dx, y + dy, self.radius + dz


@dataclass(frozen=True, slots=True, eq=False)
class Hull:
    """A shape of radius 1: the convex hull of equal balls.

    Args:
        centres: (k, 3) the balls' centres.
        radius: That of every ball.
    """

    centres: NDArray[np.float64]
    radius: float


@cache
def hull_of(shape: str) -> Hull:
    """Give the hull of a shape; KeyError where there is no such shape."""
    return {
        "sphere": lambda: Hull(np.zeros((1, 3)), 0.9995),
        "spl": lambda: Hull(_spikes(1.22), 0.0),
        "cube": lambda: Hull(_corners(0.82), 0.18),
        "cylinder": lambda: Hull(np.concatenate([_ring(0.97, -0.62), _ring(0.97, 0.62)]), 0.03),
        "cone": lambda: Hull(np.concatenate([_ring(1.0, -1.0), [(0.0, 0.0, 1.0)]]), 0.0),
    }[shape]()


def drawn_bodies(count: int, chance: random.Random) -> tuple[Body, ...]:
    """Draw so many things: the snitch, a medium cone, a large cone, and any others."""
    given = [("spl", "small"), ("cone", "medium"), ("cone", "large")]
    numbers: dict[str, int] = {}
    bodies = []
    for index in range(count):
        if index < len(given):
            shape, size = given[index]
        else:
            shape, size = chance.choice(SHAPES), chance.choice(tuple(RADII))
        snitch = shape == "spl"
        number = numbers.get(shape, 0)
        numbers[shape] = number + 1
        bodies.append(
            Body(
                shape,
                size,
                "gold" if snitch else chance.choice(COLORS),
                "metal" if snitch else chance.choice(MATERIALS),
                SNITCH_RADIUS if snitch else RADII[size],
                f"{_INSTANCES[shape]}_{number}",
                chance.uniform(0.0, 2.0 * math.pi),
            )
        )
    return tuple(bodies)


def _spikes(radius: float) -> NDArray[np.float64]:
    """Give 32 points spread evenly over a ball: the corners of a dodecahedron over its faces."""
    golden = (1.0 + math.sqrt(5.0)) / 2.0
    faces = [(0.0, golden, 1.0), (golden, 1.0, 0.0), (1.0, 0.0, golden)]
    corners = [
        (1.0, 1.0, 1.0),
        (0.0, 1.0 / golden, golden),
        (1.0 / golden, golden, 0.0),
        (golden, 0.0, 1.0 / golden),
    ]
    signed = sorted(
        {
            (x * signs[0], y * signs[1], z * signs[2])
            for x, y, z in faces + corners
            for signs in product((1.0, -1.0), repeat=3)
        }
    )
    points = np.array(signed)
    spread: NDArray[np.float64] = radius * points / np.linalg.norm(points, axis=1, keepdims=True)
    return spread


def _ring(radius: float, z: float) -> NDArray[np.float64]:
    angles = np.arange(_RING) * (2.0 * math.pi / _RING)
    return np.stack([radius * np.cos(angles), radius * np.sin(angles), np.full(_RING, z)], axis=1)


def _corners(half: float) -> NDArray[np.float64]:
    signs = np.array([-half, half])
    return np.stack(np.meshgrid(signs, signs, signs, indexing="ij"), axis=-1).reshape(-1, 3)
