from __future__ import annotations

import socket

import pytest

from runtime.addresses import RTDE_PORT, answers, is_loopback


@pytest.mark.parametrize("address", ["127.0.0.1", "127.3.2.1", "localhost", "::1"])
def test_this_machines_own(address: str) -> None:
    assert is_loopback(address)


@pytest.mark.parametrize("address", ["192.0.2.1", "10.0.0.5", "robot.local", "", "127.0.0"])
def test_anything_else_may_be_a_real_arm(address: str) -> None:
    assert not is_loopback(address)


def test_somebody_answers_or_nobody() -> None:
    with socket.socket() as listening:
        listening.bind(("127.0.8.8", RTDE_PORT))
        listening.listen()
        assert answers("127.0.8.8")
    assert not answers("127.0.8.8")
