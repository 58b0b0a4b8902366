from __future__ import annotations

import numpy as np
import pytest

from runtime.cell.support import fall, underside
from runtime.parts import load_parts

PARTS = load_parts()


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


def test_the_underside_of_a_plug_is_its_thread_and_the_rim_of_its_head():
    heights = np.unique(np.round(underside(PARTS["plug"])[:, 2], 6))
    assert heights == pytest.approx([-0.013, 0.003])
