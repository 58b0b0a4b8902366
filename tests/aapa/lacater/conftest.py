"""Small videos made by hand: few frames, boxes and places that can be checked on paper."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

from aapa.lacater import FrameMasks, Labels, Movement, Perception, Scene, SceneObject

Box = tuple[int, int, int, int]
KINDS = {
    "Spl": ("small", "gold", "spl", "metal"),
    "Cone": ("large", "green", "cone", "rubber"),
    "Sphere": ("small", "red", "sphere", "metal"),
    "SmoothCube_v2": ("medium", "blue", "cube", "metal"),
}


def thing(
    instance: str,
    place: Sequence[float],
    frames: int,
    *,
    pixel: tuple[float, float] = (0.0, 0.0),
    **kind: str,
) -> SceneObject:
    size, color, shape, material = KINDS[instance.rpartition("_")[0]]
    kind = {"size": size, "color": color, "shape": shape, "material": material} | kind
    x, y, z = place
    return SceneObject(
        instance,
        sized=0.3,
        rotation=0.0,
        coords_3d=(x, y, z),
        pixel_coords=(*pixel, 10.0),
        locations=np.tile(np.array([x, y, z], dtype=np.float64), (frames + 1, 1)),
        **kind,
    )


@pytest.fixture
def scene_with() -> Callable[..., Scene]:
    """A scene of things at places, with records; the camera of the rules is far off at +x, -y."""

    def make(
        places: dict[str, Sequence[float]],
        movements: dict[str, list[tuple[str, str | None, int, int]]] | None = None,
        frames: int = 10,
        pixels: dict[str, tuple[float, float]] | None = None,
        kinds: dict[str, dict[str, str]] | None = None,
    ) -> Scene:
        records = movements or {}
        return Scene(
            7,
            "CLEVR_new_000007.avi",
            tuple(
                thing(
                    name,
                    place,
                    frames,
                    pixel=(pixels or {}).get(name, (0.0, 0.0)),
                    **(kinds or {}).get(name, {}),
                )
                for name, place in places.items()
            ),
            {name: tuple(Movement(*entry) for entry in records.get(name, ())) for name in places},
            camera=(7.0, -6.0, 5.0),
            directions={"left": (-1.0, 0.0, 0.0)},
            relationships={"left": tuple(() for _ in places)},
        )

    return make


@pytest.fixture
def labels_for() -> Callable[..., Labels]:
    """Labels for a scene: one box a thing for all frames, or a list of one a frame."""

    def make(scene: Scene, boxes: dict[str, Box | list[Box]], frames: int = 10) -> Labels:
        rows = []
        for item in scene.objects:
            given = boxes[item.instance]
            rows.append(given if isinstance(given, list) else [given] * frames)
        return Labels(tuple(o.key for o in scene.objects), np.array(rows, dtype=np.int32))

    return make


@pytest.fixture
def perception_of() -> Callable[..., Perception]:
    """Detections, from a list of (class, box) for each frame."""

    def make(frames: Sequence[Sequence[tuple[int, Box]]]) -> Perception:
        return Perception(
            tuple(
                np.array([box for _, box in frame], dtype=np.int64).reshape(-1, 4)
                for frame in frames
            ),
            tuple(np.array([number for number, _ in frame], dtype=np.int64) for frame in frames),
        )

    return make


@pytest.fixture
def masks_of() -> Callable[..., FrameMasks]:
    """Masks from one letter a frame: V visible, O occluded, C contained, M carried."""

    def make(letters: str) -> FrameMasks:
        letter = np.array(list(letters))
        contained, carried, visible = letter == "C", letter == "M", letter == "V"
        masks: list[Any] = [contained | carried, contained, carried, visible, visible, visible]
        return FrameMasks(*masks)

    return make
