"""What stands where while a motion is planned: objects as anchored, or where the plan puts them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

from aapa import Anchor
from runtime.drivers.limits import MotionError
from runtime.parts import PartModel

Place: TypeAlias = tuple[float, float, float]
"""x, y, z in m, base frame."""

_IN_HAND_SLACK: Final = 0.03  # m by which a held part may be anchored beside its place in the hand
_SEEN_IN_HAND_M: Final = 0.008  # by which the height of a part in the hand may be seen wrongly


@dataclass(frozen=True, slots=True)
class Held:
    """A part in the hand.

    Args:
        part: What is known of it.
        offset: The tool centre point relative to the part's centre, m.
    """

    part: PartModel
    offset: Place

    @property
    def hangs_m(self) -> float:
        """How far it reaches below the tool centre point."""
        return max(0.0, self.offset[2] + self.part.size[2] / 2)

    def turned(self, angle_rad: float) -> Place:
        """Give the offset when the hand has turned about the vertical since it was measured."""
        x, y, z = self.offset
        c, s = math.cos(angle_rad), math.sin(angle_rad)
        return c * x - s * y, s * x + c * y, z


class Places:
    """Objects by name: their models, and where they are after the steps planned so far.

    Args:
        anchors: The objects as anchored now.
        parts: What is known of the parts, by type.
    """

    def __init__(self, anchors: Mapping[str, Anchor], parts: Mapping[str, PartModel]) -> None:
        self.parts: Final = parts
        self._anchors = anchors
        self._moved: dict[str, Place] = {}

    def move(self, name: str, place: Place) -> None:
        """Note that an object is elsewhere by the time of later commands."""
        self._moved[name] = place

    def part(self, name: str) -> PartModel:
        """Give the model of an object.

        Raises:
            MotionError: It is not anchored, or its type is unknown.
        """
        anchor = self._anchor(name)
        part = self.parts.get(anchor.type)
        if part is None:
            raise MotionError(f"{name} is a {anchor.type}, of which nothing is known")
        return part

    def position(self, name: str) -> Place:
        """Give where an object is.

        Raises:
            MotionError: It is not anchored, or known in the image only.
        """
        if name in self._moved:
            return self._moved[name]
        position = self._anchor(name).position
        if position is None:
            raise MotionError(f"{name} is anchored in the image only, its place is not known")
        return position

    def held(self, hand: str, obj: str, *, gripped: bool) -> Held:
        """Give the part in the hand.

        Raises:
            MotionError: The hand feels nothing, or the object is anchored somewhere else.
        """
        part = self.part(obj)
        if not gripped:
            raise MotionError(f"{hand} does not hold {obj}: the gripper feels no part")
        x, y, z = (
            tool - centre
            for tool, centre in zip(self.position(hand), self.position(obj), strict=True)
        )
        off = max(math.hypot(x, y), abs(z - part.grasp_height_m))
        if off > _IN_HAND_SLACK:
            raise MotionError(f"{obj} is anchored {off:.3f} m away from its place in {hand}")
        # Its own hand hides much of it: how high it is held is known better from the grasp.
        known = abs(z - part.grasp_height_m) <= _SEEN_IN_HAND_M
        return Held(part, (x, y, part.grasp_height_m if known else z))

    def others(self, *names: str) -> Iterator[Anchor]:
        """Give the anchors of all other objects."""
        return (anchor for name, anchor in self._anchors.items() if name not in names)

    def _anchor(self, name: str) -> Anchor:
        anchor = self._anchors.get(name)
        if anchor is None:
            raise MotionError(f"{name} is not anchored")
        return anchor


def add(a: Place, b: Place) -> Place:
    """Give the sum of two places."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def is_round(part: PartModel) -> bool:
    """Tell whether a part is the same however it is turned about the vertical."""
    return all(
        solid.shape == "cylinder" and solid.offset[:2] == (0.0, 0.0) for solid in part.primitives
    )
