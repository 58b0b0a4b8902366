"""Real runs, short ones: the stand-in, the client, the cell, and the witnesses that judge them."""

from __future__ import annotations

import json

import pytest
from gearbox.rows import GOOD, Ending
from gearbox.running import Desk, carry_out, trace_of
from gearbox.trials import Trial

pytestmark = pytest.mark.robot


@pytest.fixture(scope="module")
def calm(tmp_path_factory):
    folder = tmp_path_factory.mktemp("calm")
    return folder, carry_out(Trial("1.1", 0), 90, Desk(folder, keep=True))


def test_a_run_in_which_nothing_goes_wrong(calm):
    _, row = calm
    assert row.ending in (Ending.ACHIEVED, Ending.RECOVERED), row
    assert row.achieved
    assert row.true
    assert row.struck == row.unsafe == row.false_at_end == ()
    assert row.trace.damage == ""
    assert row.trace.cycles == row.cycles > 0
    assert row.travel_rad > 1
    assert row.robot_s > 5
    assert row.cpu_s > 0
    assert row.places.looked > row.cycles
    assert row.places.median_mm < 10


def test_a_trace_that_is_not_what_happened_is_damaged(calm, tmp_path):
    folder, row = calm
    lines = (folder / f"{row.trial.key}.jsonl").read_text().splitlines(keepends=True)
    changed = tmp_path / "changed.jsonl"
    third = json.loads(lines[3])
    third["percepts"] = third["percepts"][1:]
    changed.write_text("".join([*lines[:3], json.dumps(third) + "\n", *lines[4:]]))
    assert trace_of(changed).damage
    changed.write_text("".join(lines)[:-40])
    assert "cut off" in trace_of(changed).damage
    changed.write_text("".join([*lines[:3], "gibberish\n", *lines[4:]]))
    assert trace_of(changed).damage
    assert trace_of(tmp_path / "nowhere.jsonl").damage == ""


def test_a_run_whose_link_is_cut_ends_with_the_true_reason(tmp_path):
    # The operator of this seed does not give the word.
    row = carry_out(Trial("1.1", 0, fault="drop_rtde"), 91, Desk(tmp_path))
    assert row.ending is Ending.FAILED, row
    assert row.struck == ("drop_rtde",)
    assert row.unsafe == ()
    assert {"link_lost", "noticed"} <= {name for name, _ in row.travels}
    assert row.trace.damage == ""
    assert list(tmp_path.iterdir()) == []  # it ended well: nothing is kept of it


def test_a_run_that_is_killed_is_taken_up(tmp_path):
    row = carry_out(Trial("1.1", 3, fault="killed"), 92, Desk(tmp_path))
    assert row.ending in GOOD, row
    assert row.struck == ("killed",)
    assert row.true
    assert row.trace.damage == ""
