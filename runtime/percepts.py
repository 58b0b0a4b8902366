"""From anchors to percepts: what the mind is told of the world, in the words of the domain."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator

from aapa import Anchor, AnchorStatus, Camera, Detection
from icarus_lite import Percept, Value
from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState

HAND = "hand1"
"""The symbol of the robot's own hand."""

HAND_TYPE = "hand"

PERSON_TYPE = "person"
"""The class that a detector gives the hand of a person."""

_PERSON_STAYS = 20
"""For so many frames a hand that is hidden is taken to be where it was."""

_MM = 4
"""Positions are told to a tenth of a millimetre: digits below that are noise."""


def hand_detection(arm: ArmState, camera: Camera, config: RobotConfig) -> Detection:
    """Give the hand as a body that reports its own place, from the measured joints.

    Its box is the gripper's outline in the image, so that what the gripper hides is understood
    to be hidden.
    """
    x, y, z = arm.tcp_pose[:3]
    half = config.gripper.width_m / 2
    corners = [
        camera.project((x + dx, y + dy, z + dz))
        for dx in (-half, half)
        for dy in (-half, half)
        for dz in (0.0, config.gripper.length_m)
    ]
    seen = [(u, v) for u, v, depth in corners if depth > 0.01 and math.isfinite(u + v)]
    us, vs = [u for u, _ in seen] or [0.0], [v for _, v in seen] or [0.0]
    return Detection(
        HAND_TYPE,
        (min(us), min(vs), max(us), max(vs)),
        position=(x, y, z),
        size=(config.gripper.width_m, config.gripper.length_m),
        name=HAND,
    )


def percepts_of(
    anchors: Iterable[Anchor],
    arm: ArmState,
    config: RobotConfig,
    *,
    acting: bool = False,
    expected: Collection[str] = (),
) -> tuple[Percept, ...]:
    """Tell the anchors as percepts of `gearbox.icr`: `hand`, `person`, `object`; m, base frame.

    A person moves unasked: see `is_about`.

    Args:
        anchors: What is anchored.
        arm: What the arm measures of itself.
        config: The robot.
        acting: Whether an action of its own is under way.
        expected: The names of what should be seen here and is not: see `runtime.expecting`.
    """
    return tuple(_percepts(anchors, arm, config, "yes" if acting else "no", expected))


def is_in_company(anchors: Iterable[Anchor], detections: Iterable[Detection]) -> bool:
    """Tell whether a person's hand is in sight, be it for the first time."""
    return any(each.type == PERSON_TYPE for each in detections) or any(
        anchor.type == PERSON_TYPE and is_about(anchor) for anchor in anchors
    )


def is_about(person: Anchor) -> bool:
    """Tell whether a person's hand, anchored once, is still about.

    Out of view, missed where nothing hides it, or hidden for more than a moment, it is gone.
    """
    return person.status is AnchorStatus.VISIBLE or (
        person.status is AnchorStatus.OCCLUDED and person.streak > -_PERSON_STAYS
    )


def _percepts(
    anchors: Iterable[Anchor],
    arm: ArmState,
    config: RobotConfig,
    acting: Value,
    expected: Collection[str],
) -> Iterator[Percept]:
    for anchor in anchors:
        if anchor.type == HAND_TYPE:
            yield _hand(anchor, arm, config, acting)
        elif anchor.type != PERSON_TYPE:
            yield _object(anchor, expected=anchor.name in expected)
        elif is_about(anchor):
            yield Percept("person", anchor.name, {**_position(anchor), "seen": _seen(anchor)})


def _hand(anchor: Anchor, arm: ArmState, config: RobotConfig, acting: Value) -> Percept:
    attributes: dict[str, Value] = _position(anchor)
    attributes["reach"] = config.reach_m
    # Fingers that are open only to take hold again have not lost what they held.
    attributes["gripping"] = "yes" if arm.gripped else "again" if arm.regrips else "no"
    attributes["fingers"] = "closed" if arm.gripper_closed else "open"
    attributes["acting"] = acting
    return Percept("hand", anchor.name, attributes)


def _object(anchor: Anchor, *, expected: bool) -> Percept:
    attributes: dict[str, Value] = {"type": anchor.type, **_position(anchor)}
    if anchor.size is not None:
        attributes["width"] = round(anchor.size[0], _MM)
        attributes["height"] = round(anchor.size[1], _MM)
    attributes["seen"] = _seen(anchor)
    attributes["status"] = str(anchor.status)
    if expected:
        attributes["expected"] = "yes"
    return Percept("object", anchor.name, attributes)


def _seen(anchor: Anchor) -> Value:
    return "yes" if anchor.status is AnchorStatus.VISIBLE else "no"


def _position(anchor: Anchor) -> dict[str, Value]:
    if anchor.position is None:
        return {}
    return {axis: round(v, _MM) for axis, v in zip("xyz", anchor.position, strict=True)}
