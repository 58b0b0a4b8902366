"""The cell as MuJoCo's XML: table, arm, gripper, camera and parts, all from numbers.

The arm is drawn from its Denavit-Hartenberg rows with plain cylinders and capsules, so it is in
exactly the places `runtime.kinematics` computes, for every model, without mesh files.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Final

from runtime.cell.arrangement import PlacedPart
from runtime.cell.body import FORE_M, HAND, LIMBS, UPPER_M
from runtime.kinematics import ArmModel, Matrix
from runtime.parts import PartModel, Primitive

GROUPS: Final = {"room": 0, "arm": 1, "hand": 2, "camera": 3, "part": 4, "person": 5}
"""Geom groups. The camera's rays pass through its own housing and through the room."""

AWAY: Final = (0.0, 0.0, 50.0)
"""Where the person's bodies are while nobody is there: beyond every ray, m."""

FINGER_M: Final = (0.011, 0.005, 0.034)
"""Half sizes of a finger: across, along the closing direction, along the tool axis, m."""

_STEEL: Final = "0.80 0.82 0.84 1"
_CAP: Final = "0.33 0.58 0.80 1"
_DARK: Final = "0.13 0.14 0.16 1"
_SLEEVE: Final = "0.24 0.36 0.47 1"
_FACE: Final = "0.80 0.62 0.50 1"
_HAIR: Final = "0.23 0.17 0.13 1"


def cell_xml(
    model: ArmModel,
    parts: Iterable[PlacedPart],
    fixture: PlacedPart,
    *,
    tcp_m: float,
    mount: Matrix,
    view_rad: float,
) -> str:
    """Give the MJCF text of a cell.

    Args:
        model: The arm, with its base at the origin.
        parts: Each becomes a mocap body named after it.
        fixture: Becomes part of the room.
        tcp_m: Flange to tool centre point along the tool axis, m.
        mount: (4, 4), flange to camera (right, down, forward).
        view_rad: The camera's vertical field of view.
    """
    x, y, z = mount[:3, 3].tolist()
    eye = (
        f'<camera name="wrist" pos="{_numbers((x, y, z))}" fovy="{math.degrees(view_rad)}"'
        f' xyaxes="{_numbers([*mount[:3, 0], *-mount[:3, 1]])}"/>'
    )
    bodies = "\n".join(
        f'<body name="{part.name}" mocap="true">{_solids(part.model.primitives, "part")}'
        f"{_marks(part.model)}</body>"
        for part in parts
    )
    bodies += _person()
    return f"""<mujoco model="icarus-cell">
<compiler angle="radian"/>
<statistic center="0.3 0 0.2" extent="1"/>
<visual>
  <global offwidth="1280" offheight="960" fovy="40"/>
  <quality shadowsize="4096" offsamples="8" numslices="64" numstacks="32"/>
  <headlight ambient="0.34 0.34 0.36" diffuse="0.22 0.22 0.22" specular="0 0 0"/>
  <map znear="0.02" zfar="20" shadowclip="0.75"/>
  <rgba haze="0.86 0.89 0.92 1"/>
</visual>
<asset>
  <texture type="skybox" builtin="gradient" rgb1="0.93 0.95 0.97" rgb2="0.70 0.75 0.80"
    width="256" height="1536"/>
  <texture name="wood" type="2d" builtin="flat" mark="random" random="0.02"
    rgb1="0.83 0.80 0.74" markrgb="0.79 0.76 0.70" width="256" height="256"/>
  <texture name="tiles" type="2d" builtin="checker" rgb1="0.62 0.65 0.68" rgb2="0.66 0.69 0.72"
    mark="edge" markrgb="0.55 0.58 0.61" width="256" height="256"/>
  <material name="table" texture="wood" texrepeat="4 4" specular="0.1" shininess="0.2"/>
  <material name="floor" texture="tiles" texrepeat="1 1" texuniform="true" reflectance="0.04"/>
  <material name="metal" specular="0.5" shininess="0.55"/>
</asset>
<default><geom contype="0" conaffinity="0" material="metal"/></default>
<worldbody>
  <light pos="0.9 -0.9 1.9" dir="-0.35 0.5 -1" directional="true" diffuse="0.52 0.51 0.48"
    specular="0.25 0.25 0.25" castshadow="true"/>
  <light pos="-0.8 1.2 1.6" dir="0.5 -0.6 -1" directional="true" diffuse="0.16 0.17 0.20"
    specular="0 0 0" castshadow="false"/>
  <geom name="floor" type="plane" pos="0 0 -0.75" size="6 6 0.1" material="floor" group="0"/>
  <geom type="box" pos="0.29 0 -0.02" size="0.45 0.42 0.02" material="table" group="0"/>
  <geom type="box" pos="0.29 0 -0.39" size="0.40 0.37 0.35" rgba="0.30 0.33 0.37 1" group="0"/>
  <geom type="cylinder" pos="0 0 0.004" size="0.095 0.004" rgba="{_DARK}" group="0"/>
  <body pos="{_numbers(fixture.position)}">{_solids(fixture.model.primitives, "room")}</body>
  {_arm(model, _hand(tcp_m, (x, y, z)) + eye)}
  {bodies}
</worldbody>
</mujoco>"""


def _arm(model: ArmModel, tool: str) -> str:
    """Give the six links, nested; body i is turned by joint i about its own z axis."""
    thin = 0.040 if model.reach_m < 0.88 else 0.046
    # The real upper arm and forearm run beside the plane of the DH frames, one left, one right.
    upper, fore = 1.25 * model.d4, 0.15 * model.d4
    wrist = 0.045
    links = [
        _cylinder((0, 0, 0), (0, 0, model.d1 - 0.05), 1.65 * thin)
        + _cylinder((0, 0, model.d1 - 0.05), (0, 0, model.d1 + 0.055), 1.45 * thin)
        + _cylinder((0, 0.062, model.d1), (0, 0.5 * thin - upper, model.d1), 1.36 * thin)
        + _cap((0, 0.062, model.d1), (0, 0.071, model.d1), 1.30 * thin),
        _cylinder((0, 0, upper - 1.45 * thin), (0, 0, upper + 1.5 * thin), 1.4 * thin)
        + _cap((0, 0, upper + 1.5 * thin), (0, 0, upper + 1.72 * thin), 1.34 * thin)
        + _capsule((0, 0, upper), (model.a2, 0, upper), 1.1 * thin)
        + _cylinder((model.a2, 0, fore - thin), (model.a2, 0, upper + 1.3 * thin), 1.15 * thin)
        + _cap((model.a2, 0, upper + 1.3 * thin), (model.a2, 0, upper + 1.5 * thin), 1.09 * thin),
        _cap((0, 0, fore - 1.2 * thin), (0, 0, fore - thin), 1.09 * thin)
        + _capsule((0, 0, fore), (model.a3, 0, fore), 0.88 * thin)
        + _cylinder((model.a3, 0, fore - wrist), (model.a3, 0, fore + wrist), 0.9 * thin),
        _cylinder((0, 0, fore + 0.5 * wrist), (0, 0, model.d4 + wrist), 0.88 * thin)
        + _cap((0, 0, model.d4 + wrist), (0, 0, model.d4 + 1.2 * wrist), 0.82 * thin),
        _cylinder((0, 0, -wrist), (0, 0, model.d5 + wrist), 0.86 * thin)
        + _cap((0, 0, -1.2 * wrist), (0, 0, -wrist), 0.80 * thin),
        _cylinder((0, 0, 0), (0, 0, model.d6), 0.037),
    ]
    steps = (
        ((0.0, 0.0, model.d1), 1),
        ((model.a2, 0.0, 0.0), 0),
        ((model.a3, 0.0, 0.0), 0),
        ((0.0, 0.0, model.d4), 1),
        ((0.0, 0.0, model.d5), -1),
        ((0.0, 0.0, model.d6), 0),
    )
    text = f'<body name="flange" pos="0 0 {model.d6:.6f}">{tool}</body>'
    for index in reversed(range(6)):
        text = f'<joint name="joint{index + 1}" axis="0 0 1"/>{links[index]}{text}'
        if index:
            offset, twist = steps[index - 1]
            turn = f"{0.7071067811865476 if twist else 1} {0.7071067811865476 * twist} 0 0"
        else:
            offset, turn = (0.0, 0.0, 0.0), "1 0 0 0"
        text = f'<body pos="{_numbers(offset)}" quat="{turn}">{text}</body>'
    return text


def _hand(tcp_m: float, camera_xyz: Sequence[float]) -> str:
    """Give gripper and camera in the flange frame; the fingers close along y."""
    half_x, half_y, half_z = FINGER_M
    tip = tcp_m + 0.006
    palm_end = tip - 2 * half_z
    x, y, z = camera_xyz
    fingers = "".join(
        f'<body pos="0 0 {tip - half_z:.5f}"><joint name="finger{side:+d}" type="slide"'
        f' axis="0 {side} 0"/><geom type="box" pos="0 {side * half_y:.5f} 0" group="2"'
        f' size="{half_x} {half_y} {half_z}" rgba="{_DARK}"/><geom type="box" group="2"'
        f' pos="0 {side * 0.0005:.5f} {half_z - 0.012:.5f}" size="{half_x} 0.0015 0.012"'
        f' rgba="0.35 0.36 0.38 1"/></body>'
        for side in (1, -1)
    )
    return (
        _cylinder((0, 0, 0), (0, 0, 0.018), 0.037, "hand", _STEEL)
        + _box((0, 0, 0.018 + (palm_end - 0.030) / 2), (0.030, 0.038, (palm_end - 0.030) / 2))
        + _box((0, 0, palm_end - 0.007), (0.018, 0.058, 0.008), "hand", "0.30 0.32 0.35 1")
        + fingers
        + _box((x / 2 + 0.01, y, 0.006), (x / 2, 0.018, 0.004), "camera", _STEEL)
        + _box((x, y, z - 0.013), (0.0125, 0.045, 0.0125), "camera", "0.80 0.82 0.84 1")
        + "".join(
            _cylinder((x, lens, z - 0.002), (x, lens, z + 0.0005), 0.006, "camera", _DARK)
            for lens in (-0.028, 0.0, 0.028)
        )
    )


def _person() -> str:
    """Give the person's bodies, to be put in their places by whoever moves the scene."""
    torso = (
        _capsule((0, 0.15, -0.02), (0, -0.15, -0.02), 0.075, "person", _SLEEVE)
        + _capsule((0.02, 0.07, -0.10), (0.02, 0.07, -0.48), 0.115, "person", _SLEEVE)
        + _capsule((0.02, -0.07, -0.10), (0.02, -0.07, -0.48), 0.115, "person", _SLEEVE)
        + _capsule((-0.01, -0.23, -0.03), (-0.02, -0.26, -0.32), 0.047, "person", _SLEEVE)
        + _capsule((0, 0, 0.02), (-0.01, 0, 0.12), 0.052, "person", _FACE)
        + _capsule((-0.03, 0, 0.19), (-0.02, 0, 0.25), 0.085, "person", _FACE)
        + _capsule((0.005, 0, 0.225), (0.005, 0, 0.275), 0.088, "person", _HAIR)
    )
    texts = (
        torso,
        _capsule((0, 0, 0), (0, 0, UPPER_M), 0.050, "person", _SLEEVE),
        _capsule((0, 0, 0), (0, 0, FORE_M), 0.038, "person", _SLEEVE),
        _solids(HAND.primitives, "person"),
    )
    return "".join(
        f'\n<body name="{name}" mocap="true" pos="{_numbers(AWAY)}">{text}</body>'
        for name, text in zip(LIMBS, texts, strict=True)
    )


def _marks(model: PartModel) -> str:
    """Show on a screw how it is turned, for people only: rays and detectors see nothing of it."""
    if all(seat.thread is None for seat in model.seats):
        return ""
    top, shank = model.size[2] / 2, model.primitives[0]
    slot = _box((0, 0, top), (0.40 * model.size[0], 0.0022, 0.0006), "room", _DARK)
    dot = _box((0.36 * model.size[0], 0, top), (0.0022, 0.0022, 0.0009), "room", "0.85 0.15 0.1 1")
    low = shank.offset[2] - shank.size[2] / 2
    ridges = "".join(
        _cylinder(
            (0, 0, low + 0.0010 + turn * 0.0030),
            (0, 0, low + 0.0022 + turn * 0.0030),
            shank.size[0] / 2 + 0.0005,
            "room",
            _DARK,
        )
        for turn in range(int(shank.size[2] / 0.0030))
    )
    return slot + dot + ridges


def _solids(primitives: Iterable[Primitive], group: str) -> str:
    texts = []
    for solid in primitives:
        half = [value / 2 for value in solid.size]
        size = half if solid.shape == "box" else half[1:]
        texts.append(
            f'<geom type="{solid.shape}" pos="{_numbers(solid.offset)}" size="{_numbers(size)}"'
            f' rgba="{_numbers(solid.colour)} 1" group="{GROUPS[group]}"/>'
        )
    return "".join(texts)


def _cylinder(
    start: Sequence[float],
    end: Sequence[float],
    radius: float,
    group: str = "arm",
    rgba: str = _STEEL,
    shape: str = "cylinder",
) -> str:
    return (
        f'<geom type="{shape}" fromto="{_numbers((*start, *end))}" size="{radius:.5f}"'
        f' rgba="{rgba}" group="{GROUPS[group]}"/>'
    )


def _capsule(
    start: Sequence[float],
    end: Sequence[float],
    radius: float,
    group: str = "arm",
    rgba: str = _STEEL,
) -> str:
    return _cylinder(start, end, radius, group, rgba, shape="capsule")


def _cap(start: Sequence[float], end: Sequence[float], radius: float) -> str:
    return _cylinder(start, end, radius, rgba=_CAP)


def _box(
    centre: Sequence[float], half: Sequence[float], group: str = "hand", rgba: str = _DARK
) -> str:
    return (
        f'<geom type="box" pos="{_numbers(centre)}" size="{_numbers(half)}" rgba="{rgba}"'
        f' group="{GROUPS[group]}"/>'
    )


def _numbers(values: Iterable[float]) -> str:
    return " ".join(f"{value:.6f}" for value in values)
