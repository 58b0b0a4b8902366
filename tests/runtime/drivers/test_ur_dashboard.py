"""Asking a controller what it is, before anything is started on it."""

from __future__ import annotations

import socket
import threading

import pytest

from runtime.config import load_robot
from runtime.drivers.ur_dashboard import check_controller
from runtime.errors import ControllerError

pytestmark = pytest.mark.robot

ADDRESS = "127.0.9.7"


def test_a_controller_that_is_busy_at_first_gets_another_chance():
    """The first connection is accepted and hears nothing; the second is answered."""
    asked = []

    def answer(listener):
        silent, _ = listener.accept()
        line, _ = listener.accept()
        line.sendall(b"Connected: Universal Robots Dashboard Server\n")
        with silent, line:
            for word in line.makefile("r"):
                asked.append(word.strip())
                line.sendall(b"3.2.0.1\n")

    with socket.create_server((ADDRESS, 29999)) as listener:
        thread = threading.Thread(target=answer, args=(listener,), daemon=True)
        thread.start()
        with pytest.raises(ControllerError, match=r"PolyScope 3\.2 is not supported"):
            check_controller(ADDRESS, load_robot("ur5"))
        thread.join(5)
    assert asked[0] == "PolyscopeVersion"


def test_where_nobody_listens_it_says_so_at_once():
    with pytest.raises(ControllerError, match=r"no answer from a UR controller's dashboard"):
        check_controller(ADDRESS, load_robot("ur5"))
