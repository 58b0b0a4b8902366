"""Bytes that mean no good, on every port: nobody but their sender may notice."""

from __future__ import annotations

import contextlib
import json
import random
import re
import socket
import struct
import time

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from runtime.controller import ControllerProcess
from runtime.controller.arm import HOME
from runtime.controller.connections import ProtocolViolation
from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard import DashboardServer
from runtime.controller.ports import (
    BENCH_PORT,
    DASHBOARD_PORT,
    PORTS,
    RTDE_PORT,
    SCRIPT_PORTS,
)
from runtime.controller.rtde_server import RtdeServer
from runtime.controller.script_server import ScriptServer
from runtime.controller.tokens import ScriptError
from runtime.errors import ControllerError
from runtime.kinematics import UR5

PROGRAM = """def go():
  global q = [0, -1.5, 1.5, -1.5, -1.5, 0]
  thread watch():
    while (True):
      force_mode(p[0,0,0,0,0,0], [0,0,1,0,0,0], [0,0,-5,0,0,0], 2, [0.1,0.1,0.1,1,1,1])
      sync()
    end
  end
  handle = run watch()
  i = 0
  while i < 3:
    q[0] = q[0] + 0.1 * i
    movej(q, a=1.2, v=1)
    speedl([0,0,-0.01,0,0,0], 0.5, t=0.1)
    if tool_contact() > 0:
      stopl(1)
    elif i >= 2:
      textmsg("at ", i)
    else:
      write_output_float_register(i, norm([q[0], q[1]]))
    end
    i = i + 1
  end
  kill handle
  end_force_mode()
end
"""
PACKAGES = (
    b"\x00\x05V\x00\x02",
    b"\x00\x03v",
    struct.pack(">HBd", 3 + 8 + 9, ord("O"), 125.0) + b"timestamp",
    struct.pack(">HB", 3 + 20, ord("I")) + b"input_int_register_0",
    b"\x00\x03S",
    b"\x00\x08U\x01\x00\x00\x00\x07",
    b"\x00\x03P",
)


class Peer:
    """A connection that remembers what it was sent."""

    peer = "a test"
    backlog = 0

    def __init__(self) -> None:
        self.sent = b""

    def send(self, data: bytes) -> None:
        self.sent += data

    def close(self) -> None:
        self.sent += b"CLOSED"

    def finish(self) -> None:
        self.close()


def dialled(process, port) -> socket.socket:
    return socket.create_connection((process.address, port), 5)


def spoilt(text: bytes, chance: random.Random) -> bytes:
    """Give a text with some of it changed, doubled or left out."""
    data = bytearray(text)
    for _ in range(chance.randint(1, 8)):
        at = chance.randrange(len(data))
        match chance.randrange(4):
            case 0:
                data[at] = chance.randrange(256)
            case 1:
                del data[at : at + chance.randint(1, 20)]
            case 2:
                data[at:at] = data[at : at + chance.randint(1, 30)]
            case _:
                data[at:at] = chance.randbytes(chance.randint(1, 6))
        if not data:
            data = bytearray(b"\n")
    return bytes(data)


def reworded(text: str, chance: random.Random) -> str:
    """Give a program with some of its words in the place of others."""
    words = re.findall(r"\w+|\s+|.", text)
    solid = [at for at, word in enumerate(words) if word.strip()]
    for _ in range(chance.randint(1, 3)):
        at = chance.choice(solid)
        like = [words[i] for i in solid if words[i][0].isalnum() == words[at][0].isalnum()]
        words[at] = chance.choice([*like, "1e300", "-1", "True", "[]", "p[0,0,0,0,0,0]", '""'])
    return "".join(words)


@pytest.mark.parametrize("seed", range(200))
def test_a_spoilt_program_runs_or_is_refused_in_a_sentence(seed):
    chance = random.Random(seed)
    box = ControlBox(UR5, lambda: box.time_s, HOME)
    if seed % 4:
        text = reworded(PROGRAM, chance)
    else:
        text = spoilt(PROGRAM.encode(), chance).decode("utf-8", "replace")
    with contextlib.suppress(ScriptError):
        box.load(text)
    for _ in range(60):
        box.cycle()
    assert box.last_failure is None or "Traceback" not in box.last_failure


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2**32))
def test_a_spoilt_conversation_is_answered_or_cut_off(seed):
    chance = random.Random(seed)
    box = ControlBox(UR5, lambda: 0.0, HOME)
    server = RtdeServer(box)
    session = server.accept(Peer())
    spoken = b"".join(
        spoilt(package, chance) if chance.random() < 0.3 else package
        for package in chance.choices(PACKAGES, k=12)
    )
    cuts = sorted(chance.sample(range(len(spoken)), 3))
    with contextlib.suppress(ProtocolViolation):
        for begin, end in zip([0, *cuts], [*cuts, len(spoken)], strict=True):
            session.received(spoken[begin:end])
            server.publish()
            box.cycle()
    session.closed()
    assert server.claim(["input_int_register_0"], object()) == ("INT32",)


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=300))
def test_any_bytes_on_the_dashboard_and_script_ports_are_taken_or_refused(data):
    box = ControlBox(UR5, lambda: 0.0, HOME)
    for server in (DashboardServer(box), ScriptServer(box)):
        session = server.accept(Peer())
        with contextlib.suppress(ProtocolViolation):
            session.received(data)
            session.received(b"\n")
        session.closed()
    box.cycle()


@pytest.mark.robot
class TestOverTheNetwork:
    def test_garbage_on_every_port_stops_nobody(self, tmp_path, wait):
        chance = random.Random(20)
        log = tmp_path / "controller.log"
        with ControllerProcess.start("ur5", clock=8, log=log) as process:
            for port in PORTS * 12:
                with dialled(process, port) as line, contextlib.suppress(ConnectionError):
                    line.sendall(chance.randbytes(chance.choice((1, 7, 300, 5000))))
                    if chance.random() < 0.5:
                        line.shutdown(socket.SHUT_WR)
            for port in SCRIPT_PORTS:
                with dialled(process, port) as line, contextlib.suppress(ConnectionError):
                    line.sendall(b"def endless():\n" + b"# nothing\n" * 150_000)
            before = process.bench({"query": "state"})["timestamp_s"]
            wait(lambda: process.bench({"query": "state"})["timestamp_s"] > before + 1)
            wait(lambda: "was cut off: " in log.read_text())
            assert "Traceback" not in process.last_words()
            assert "Traceback" not in log.read_text()

    def test_who_breaks_the_protocol_is_cut_off_and_the_others_are_not(self, tmp_path):
        log = tmp_path / "controller.log"
        with ControllerProcess.start("ur5", log=log) as process:
            with (
                dialled(process, BENCH_PORT) as good,
                dialled(process, RTDE_PORT) as bad,
                dialled(process, DASHBOARD_PORT) as long,
            ):
                bad.sendall(b"\x00\x01V")
                assert bad.recv(100) == b""
                long.recv(1000)
                long.sendall(b"x" * 10_000)
                with contextlib.suppress(ConnectionError):
                    assert long.recv(100) == b""
                good.sendall(b'{"query": "state"}\n')
                assert json.loads(good.makefile().readline())["ok"] is True
            text = log.read_text()
            assert "a package of 1 bytes is shorter than its own header" in text
            assert "a dashboard command of more than 4096 bytes" in text

    def test_a_crowd_at_the_door_is_turned_away(self):
        with ControllerProcess.start("ur5") as process, contextlib.ExitStack() as crowd:
            lines = [crowd.enter_context(dialled(process, RTDE_PORT)) for _ in range(140)]
            for line in lines:
                line.settimeout(0)
            deadline = time.monotonic() + 5
            turned_away = 0
            while not turned_away:
                assert time.monotonic() < deadline
                for line in lines:
                    with contextlib.suppress(BlockingIOError, ConnectionError):
                        turned_away += line.recv(1) == b""
            crowd.close()
            # Once they have gone there is room again.
            while True:
                assert time.monotonic() < deadline + 5
                with contextlib.suppress(ControllerError):
                    process.bench({"query": "state"})
                    break
