from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.cell.support import fall, resting_heights
from runtime.parts import PartModel, Primitive, load_parts

PARTS = load_parts()
GREY = (0.5, 0.5, 0.5)
SIZE = (0.006, 0.006, 0.02)


def standing(name, x=0.0, y=0.0, bottom=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, bottom + PARTS[name].size[2] / 2
    return pose


def test_alone_a_part_falls_to_the_table():
    assert fall(PARTS["plug"], standing("plug", bottom=0.3), []) == (pytest.approx(0.3), None)


@pytest.mark.parametrize(
    ("falling", "x", "under", "rests_at"),
    [
        ("bearing", 0.0, "hubcover", 0.024),  # on its boss
        ("bearing", 0.030, "hubcover", 0.024),  # still half on the boss
        ("bearing", 0.040, "hubcover", 0.010),  # on the disc
        ("bearing", 0.060, "hubcover", 0.0),  # beside it
        ("hubcover", 0.0, "case", 0.014),  # into the open box
        ("hubcover", 0.055, "case", 0.070),  # onto its wall
        ("plug", 0.0, "output", 0.085),
    ],
)
def test_a_part_lands_on_the_highest_surface_under_it(falling, x, under, rests_at):
    below = [("below", PARTS[under], standing(under))]
    distance, name = fall(PARTS[falling], standing(falling, x=x, bottom=0.5), below)
    assert 0.5 - distance == pytest.approx(rests_at, abs=1e-9)
    assert name == ("below" if rests_at else None)


def test_a_turned_box_is_met_where_it_is():
    turned = standing("casingtop")
    turned[:2, :2] = [[0, -1], [1, 0]]
    beside_unturned = standing("plug", x=0.083, bottom=0.5)
    straight = fall(
        PARTS["plug"], beside_unturned, [("t", PARTS["casingtop"], standing("casingtop"))]
    )
    across = fall(PARTS["plug"], beside_unturned, [("t", PARTS["casingtop"], turned)])
    assert straight == (pytest.approx(0.5), None)
    assert across == (pytest.approx(0.5 - 0.034), "t")


def test_what_hangs_above_does_not_hold_a_part_up():
    above = [("above", PARTS["case"], standing("case", bottom=0.4))]
    assert fall(PARTS["plug"], standing("plug", bottom=0.1), above) == (pytest.approx(0.1), None)


@pytest.mark.parametrize(("x", "height"), [(0.0105, 0.003), (0.0115, 0.013), (0.0215, -np.inf)])
def test_the_thread_of_a_plug_and_the_rim_of_its_head_meet_different_things(x, height):
    # A post of 6 mm radius: under the thread (8 mm), under the head (13 mm), or beside both.
    post = PartModel(
        "post", (Primitive("cylinder", (0.006, 0.006, 0.02), (0, 0, 0), GREY),), SIZE, 0, 0.01
    )
    below = np.eye(4)
    below[2, 3] = -0.01  # its top is at z = 0
    [found] = resting_heights(PARTS["plug"], 0.3, np.array([[x, 0.0]]), post, below)
    assert found == pytest.approx({0.003: 0.013, 0.013: -0.003, -np.inf: -np.inf}[height])


@given(
    st.sampled_from([name for name in PARTS if name != "case"]),
    st.sampled_from(list(PARTS)),
    st.floats(-3, 3),
    st.floats(-3, 3),
    st.tuples(st.floats(-0.09, 0.09), st.floats(-0.09, 0.09)),
)
@settings(max_examples=60, deadline=None, derandomize=True)
def test_the_exact_answer_is_that_of_many_columns(falling, under, yaw, other_yaw, away):
    """The reference looks at columns of the falling part, half a millimetre apart."""
    below = _turned(standing(under), other_yaw)
    here = _turned(standing(falling, *away, bottom=0.5), yaw)
    [exact] = resting_heights(PARTS[falling], yaw, here[None, :2, 3], PARTS[under], below)
    sampled = _by_columns(PARTS[falling], here, PARTS[under], below)
    if exact != pytest.approx(sampled):
        # They may differ only where an edge passes between two columns.
        near = [
            resting_heights(PARTS[falling], yaw, here[None, :2, 3] + step, PARTS[under], below)[0]
            for step in np.array(
                [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]]
            )
            * 0.0006
        ]
        assert any(other == pytest.approx(sampled) for other in near)


def _turned(pose, yaw):
    c, s = np.cos(yaw), np.sin(yaw)
    pose[:2, :2] = [[c, -s], [s, c]]
    return pose


def _covered(solid, points):
    dx, dy = np.abs(points[:, :2] - solid.offset[:2]).T
    if solid.shape == "cylinder":
        return dx**2 + dy**2 <= (solid.size[0] / 2) ** 2
    return (dx <= solid.size[0] / 2) & (dy <= solid.size[1] / 2)


def _by_columns(model, pose, other, other_pose):
    half = np.array(model.size[:2]) / 2
    flat = np.stack(np.meshgrid(*(np.arange(-h, h + 1e-9, 0.0005) for h in half)), -1).reshape(
        -1, 2
    )
    lowest = np.full(len(flat), np.inf)
    for solid in model.primitives:
        inside = _covered(solid, flat)
        lowest[inside] = np.minimum(lowest[inside], solid.offset[2] - solid.size[2] / 2)
    flat, lowest = flat[np.isfinite(lowest)], lowest[np.isfinite(lowest)]
    world = np.column_stack([flat, lowest]) @ pose[:3, :3].T + pose[:3, 3]
    local = (world - other_pose[:3, 3]) @ other_pose[:3, :3]
    tops = np.full(len(flat), -np.inf)
    for solid in other.primitives:
        inside = _covered(solid, local)
        tops[inside] = np.maximum(tops[inside], solid.offset[2] + solid.size[2] / 2)
    return float((other_pose[2, 3] + tops - lowest).max())
