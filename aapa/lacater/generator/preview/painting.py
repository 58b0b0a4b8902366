"""Draws a frame: simple light, soft shadows on the floor, every pixel the nearest body's.

These are no renderings of CATER's materials; they show what is where.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.outlines import rotations
from aapa.lacater.generator.rays import depths, local_rays
from aapa.lacater.generator.simulation import Simulation
from aapa.lacater.video import HEIGHT, WIDTH

COLOURS: Final = {
    "gray": (110, 110, 110),
    "red": (173, 35, 35),
    "blue": (42, 75, 215),
    "green": (29, 125, 30),
    "brown": (129, 74, 25),
    "purple": (129, 38, 192),
    "cyan": (41, 190, 190),
    "yellow": (235, 215, 51),
    "gold": (255, 196, 0),
}
"""CATER's colours, some lighter, so that they can be told apart without its lamps."""

_FLOOR = (178.0, 178.0, 174.0)
_LIGHT = np.array((0.35, -0.55, 0.76))
_AMBIENT, _DIFFUSE = 0.45, 0.6
_SHINE = {"metal": (0.55, 24.0), "rubber": (0.12, 6.0)}


class Painter:
    """Draws the frames of a video.

    Args:
        simulation: What was filmed.
        scale: Pixels drawn for each px of the video, on either axis.
    """

    def __init__(self, simulation: Simulation, scale: int = 2) -> None:
        self._simulation = simulation
        self._scale = scale
        centres = [(np.arange(side * scale) + 0.5) / scale for side in (HEIGHT, WIDTH)]
        v, u = np.meshgrid(*centres, indexing="ij")
        viewpoint = simulation.viewpoint
        self._rays = viewpoint.rays(np.stack([u, v], axis=-1))
        # Where each ray meets the floor; the few that look above the horizon never do.
        fall = np.minimum(self._rays[..., 2], -1e-3)
        reach = -viewpoint.place[2] / fall
        self._ground = viewpoint.place[:2] + reach[..., None] * self._rays[..., :2]
        fade = np.clip(1.12 - 0.012 * np.linalg.norm(self._ground, axis=-1), 0.75, 1.12)
        self._floor = np.array(_FLOOR) * fade[..., None]

    def paint(self, frame: int) -> NDArray[np.uint8]:
        """Draw one frame, (height, width, 3) red green blue."""
        places = self._simulation.filmed[:, frame]
        image = self._floor * self._shadows(places)[..., None]
        nearest = np.full(image.shape[:2], np.inf)
        for index, body in enumerate(self._simulation.bodies):
            self._draw(body, index, frame, image, nearest)
        painted: NDArray[np.uint8] = np.clip(image, 0, 255).astype(np.uint8)
        return painted

    def _shadows(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        light = np.ones(self._ground.shape[:2])
        for body, place in zip(self._simulation.bodies, places, strict=True):
            away = np.linalg.norm(self._ground - place[:2], axis=-1) / body.radius
            # The higher it is, the wider and fainter.
            height = max(place[2] - body.radius, 0.0)
            depth = 0.5 / (1.0 + height)
            light *= 1.0 - depth * np.clip((1.35 + 0.2 * height - away) / 0.6, 0.0, 1.0)
        return light

    def _draw(
        self,
        body: Body,
        index: int,
        frame: int,
        image: NDArray[np.float64],
        nearest: NDArray[np.float64],
    ) -> None:
        low = np.floor(self._simulation.boxes[index, frame, :2] * self._scale).astype(int) - 2
        high = np.ceil(self._simulation.boxes[index, frame, 2:] * self._scale).astype(int) + 2
        window = (slice(max(low[1], 0), high[1]), slice(max(low[0], 0), high[0]))
        rays = self._rays[window].reshape(1, -1, 3)
        place = self._simulation.filmed[index, frame][None]
        tilt = self._simulation.tilts[index, frame][None]
        eye = self._simulation.viewpoint.place
        depth = depths(body, place, tilt, eye, rays)[0]
        front = depth < nearest[window].reshape(-1)
        if not front.any():
            return
        start, along = local_rays(body, place, tilt, eye, rays[:, front])
        points = (start + depth[front][None, :, None] * along)[0]
        turn = rotations(body.yaw, tilt)[0]
        lit = _lit(body, _normals(body.shape, points) @ turn.T, rays[0, front])
        painted = image[window].reshape(-1, 3)
        painted[front] = lit
        image[window] = painted.reshape(image[window].shape)
        kept = nearest[window].reshape(-1)
        kept[front] = depth[front]
        nearest[window] = kept.reshape(nearest[window].shape)


def _lit(
    body: Body, normals: NDArray[np.float64], rays: NDArray[np.float64]
) -> NDArray[np.float64]:
    colour = np.array(COLOURS[body.color], dtype=np.float64)
    towards_light = _LIGHT / np.linalg.norm(_LIGHT)
    to_eye = -rays / np.linalg.norm(rays, axis=1, keepdims=True)
    diffuse = np.clip(normals @ towards_light, 0.0, 1.0)
    half = to_eye + towards_light
    half /= np.linalg.norm(half, axis=1, keepdims=True)
    strength, sharpness = _SHINE[body.material]
    shine = strength * np.clip(np.einsum("ij,ij->i", normals, half), 0.0, 1.0) ** sharpness
    lit: NDArray[np.float64] = (
        colour * (_AMBIENT + _DIFFUSE * diffuse)[:, None] + 255.0 * shine[:, None]
    )
    return lit


def _normals(shape: str, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Give the unit normals (k, 3) of a shape of radius 1 at points (k, 3) on it."""
    normals = points.copy()
    if shape == "cube":
        side = np.abs(points).argmax(axis=1)
        normals = np.zeros_like(points)
        rows = np.arange(len(points))
        normals[rows, side] = np.sign(points[rows, side])
    elif shape == "cylinder":
        flat = np.abs(points[:, 2]) > 0.6499
        normals[:, 2] = np.where(flat, np.sign(points[:, 2]), 0.0)
        normals[flat, :2] = 0.0
    elif shape == "cone":
        base = points[:, 2] < -0.9999
        normals[:, 2] = np.where(base, -1.0, (1.0 - points[:, 2]) / 4.0)
        normals[base, :2] = 0.0
    unit: NDArray[np.float64] = normals / np.maximum(
        np.linalg.norm(normals, axis=1, keepdims=True), 1e-9
    )
    return unit
