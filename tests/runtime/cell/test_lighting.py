from __future__ import annotations

import numpy as np
import pytest

from runtime.cell.lighting import brightness, persistent_chances


def test_chances_are_evenly_spread_over_time_and_change_slowly():
    chances = np.array([persistent_chances(4, frame, 3) for frame in range(6000)])
    shares, _ = np.histogram(chances, bins=5, range=(0, 1))
    assert shares / chances.size == pytest.approx([0.2] * 5, abs=0.03)
    assert np.abs(np.diff(chances, axis=0)).max() < 0.35
    assert np.abs(np.corrcoef(chances.T)[0, 1]) < 0.15


def test_each_part_has_luck_of_its_own_whatever_else_there_is():
    assert persistent_chances(1, 40, 5)[:3].tolist() == persistent_chances(1, 40, 3).tolist()


def test_the_light_drifts_between_its_extremes():
    light = np.array([brightness(0, frame, 100) for frame in range(5000)])
    assert light.min() < 0.1
    assert light.max() > 0.9
    assert np.abs(np.diff(light)).max() < 0.05
    assert [brightness(0, frame, 100) for frame in (7, 3)] == [light[7], light[3]]
