from __future__ import annotations

import time
from multiprocessing import get_context

import pytest

from runtime.drivers import ArmState
from runtime.drivers.ur_link import Lull, Silence, StateBoard


def state(number):
    value = float(number)
    return ArmState((value,) * 6, (value,) * 6, number % 2 == 0, number % 3 == 0, value)


def write_states(board, enough):
    number = 0
    while not enough.is_set():
        board.write(state(number), moving=number % 5 == 0)
        number += 1


def test_a_board_is_empty_at_first():
    assert StateBoard().read() is None


def test_the_newest_state_is_read():
    board = StateBoard()
    before = time.monotonic()
    board.write(state(1), moving=False)
    board.write(state(6), moving=True)
    published = board.read()
    assert published.arm == state(6)
    assert published.moving
    assert before <= published.at_s <= time.monotonic()
    assert board.read() == published


def test_a_reader_never_sees_half_a_state_of_another_process():
    board = StateBoard()
    context = get_context("spawn")
    enough = context.Event()
    writer = context.Process(target=write_states, args=(board, enough), daemon=True)
    writer.start()
    deadline = time.monotonic() + 60
    seen = set()
    while time.monotonic() < deadline and len(seen) < 200:
        published = board.read()
        if published is not None:
            number = int(published.arm.timestamp_s)
            assert published.arm == state(number)
            assert published.moving == (number % 5 == 0)
            seen.add(number)
    enough.set()
    writer.join(10)
    writer.close()
    assert len(seen) == 200


def test_silence_is_counted_from_the_last_news():
    silence = Silence(blink_s=0.02)
    assert silence.since(1.0, 100.0) == 0.0
    assert silence.since(1.0, 100.01) == pytest.approx(0.01)
    assert silence.since(1.0, 100.02) == pytest.approx(0.02)
    assert silence.since(1.1, 100.03) == 0.0


def test_own_absence_is_not_taken_for_silence():
    silence = Silence(blink_s=0.02)
    silence.since(1.0, 100.0)
    assert silence.since(1.0, 160.0) == 0.02


def test_a_lull_counts_own_absence_as_well_and_is_remembered_as_long_as_it_lasted():
    lull = Lull(least_s=0.8)
    lull.note(1.0, 100.0)
    assert lull.lately(100.0) == 0.0
    lull.note(1.1, 100.5)
    assert lull.lately(100.5) == 0.0
    lull.note(1.1, 101.0)
    lull.note(1.2, 101.7)
    assert lull.lately(101.7) == pytest.approx(1.2)
    lull.note(1.3, 101.8)
    assert lull.lately(102.8) == pytest.approx(1.2)
    assert lull.lately(103.0) == 0.0
