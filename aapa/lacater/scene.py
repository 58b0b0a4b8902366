"""A video's scene file: the objects with their paths in space, and what was done with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Movement:
    """One entry of an object's record.

    Args:
        action: As the file writes it: "_slide", "_pick_place", "_rotate", "_contain", "_no_op".
        other: The object it was done to, where there is one: what a cone was set over.
        start: Its first frame.
        end: Its last frame.
    """

    action: str
    other: str | None
    start: int
    end: int


@dataclass(frozen=True, slots=True, eq=False)
class SceneObject:
    """One object of a scene.

    Args:
        instance: Its name in the scene, such as "Cone_0".
        shape: "spl" (the snitch), "cone", "sphere", "cube" or "cylinder".
        size: "large", "medium" or "small".
        color: Such as "gold".
        material: "metal" or "rubber".
        sized: Its radius, in units of the scene.
        rotation: About the vertical, as the file has it.
        coords_3d: Where it stood at first, in units of the scene.
        pixel_coords: The image of that place: x, y in px, and the depth.
        locations: (frames + 1, 3) its centre at each frame, interpolated linearly between the
            ends of its moves, where the pictures ease in and out.
    """

    instance: str
    shape: str
    size: str
    color: str
    material: str
    sized: float
    rotation: float
    coords_3d: tuple[float, float, float]
    pixel_coords: tuple[float, float, float]
    locations: NDArray[np.float64]

    @property
    def class_name(self) -> str:
        """What the detector would call it."""
        return f"{self.size}_{self.color}_{self.shape}_{self.material}"

    @property
    def key(self) -> str:
        """What the label file calls it."""
        return f"{self.class_name}_{self.instance}"

    @property
    def is_cone(self) -> bool:
        """Whether it can be set over other things."""
        return "Cone" in self.instance


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """What CATER writes down about a video.

    Args:
        image_index: The video's number.
        image_filename: The video's file name.
        objects: In the order of the file; the snitch is the first.
        movements: Each object's record, by instance, in the order of time.
        split: As the file has it; "new" in CATER.
        camera: The camera's place, in units of the scene; CATER's own files have none.
        directions: Unit vectors named behind, front, left, right, above, below.
        relationships: For each direction, which objects lie that way of each object.
    """

    image_index: int
    image_filename: str
    objects: tuple[SceneObject, ...]
    movements: Mapping[str, tuple[Movement, ...]]
    split: str = "new"
    camera: tuple[float, float, float] | None = None
    directions: Mapping[str, tuple[float, float, float]] = field(default_factory=dict)
    relationships: Mapping[str, tuple[tuple[int, ...], ...]] = field(default_factory=dict)
