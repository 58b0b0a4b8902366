"""Ctrl-C is not lost, wherever it comes."""

from __future__ import annotations

import signal
import sys

import pytest

from runtime.interruption import Interruption


class Careless:
    """Is interrupted while it is being destroyed."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


def test_an_interruption_is_raised_where_it_comes_and_remembered():
    with Interruption() as interruption:
        interruption.check()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            interruption.check()


def test_one_that_python_drops_is_noticed_at_the_next_check(monkeypatch):
    dropped = []
    monkeypatch.setattr(sys, "unraisablehook", dropped.append)
    with Interruption() as interruption:
        careless = Careless()
        del careless
        assert [type(each.exc_value) for each in dropped] == [KeyboardInterrupt]
        with pytest.raises(KeyboardInterrupt):
            interruption.check()


def test_afterwards_it_is_as_it_was():
    before = signal.getsignal(signal.SIGINT)
    with Interruption():
        assert signal.getsignal(signal.SIGINT) != before
    assert signal.getsignal(signal.SIGINT) is before
