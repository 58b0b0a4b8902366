from __future__ import annotations

import pytest

from runtime.cell import Mishaps
from runtime.cell.mishaps import Fate
from runtime.errors import UsageError


def test_by_default_nothing_goes_wrong():
    fate = Fate(1)
    for _ in range(200):
        assert fate.slip_after_m() is None
        assert fate.jam_share() is None
        assert fate.binds_after_turns() is None


def test_mishaps_come_at_their_rates_within_their_ranges():
    fate = Fate(3, Mishaps(slip_rate=0.3, jam_rate=0.5, cross_thread_rate=0.1))
    slips = [fate.slip_after_m() for _ in range(600)]
    jams = [fate.jam_share() for _ in range(600)]
    binds = [fate.binds_after_turns() for _ in range(600)]
    for drawn, rate, low, high in (
        (slips, 0.3, 0.05, 0.45),
        (jams, 0.5, 0.2, 0.8),
        (binds, 0.1, 0.3, 1.2),
    ):
        happened = [value for value in drawn if value is not None]
        assert len(happened) / len(drawn) == pytest.approx(rate, abs=0.06)
        assert min(happened) >= low
        assert max(happened) <= high
        assert max(happened) - min(happened) > 0.7 * (high - low)


def test_what_happens_to_one_thing_does_not_depend_on_how_often_another_was_tried():
    mishaps = Mishaps(slip_rate=0.5, jam_rate=0.5)
    one, other = Fate(9, mishaps), Fate(9, mishaps)
    for _ in range(5):
        other.jam_share()
    assert [one.slip_after_m() for _ in range(20)] == [other.slip_after_m() for _ in range(20)]
    later = Fate(9, mishaps)
    later.go_on_from(one.counts)
    assert later.slip_after_m() == one.slip_after_m()


@pytest.mark.parametrize("rate", [-0.1, 1.5])
def test_a_rate_that_is_no_probability_is_refused(rate):
    with pytest.raises(UsageError, match=r"jam_rate = .* is no probability; expected 0 to 1"):
        Mishaps(jam_rate=rate)
