from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from runtime.controller import ControllerProcess
from runtime.controller.__main__ import main
from runtime.controller.ports import PORTS
from runtime.errors import ControllerError

pytestmark = pytest.mark.robot


@pytest.fixture(scope="module")
def controller():
    with ControllerProcess.start("ur5", clock=4) as process:
        yield process


def greeting(address, port):
    with socket.create_connection((address, port), timeout=5) as line:
        return line.recv(200).decode()


def test_it_says_what_it_is(controller):
    assert "not a robot, not URSim" in greeting(controller.address, 29999)
    assert controller.bench({"query": "state"})["controller"].endswith("(not a robot, not URSim)")


def test_two_controllers_find_two_addresses(controller):
    with ControllerProcess.start("ur16e") as other:
        assert other.address != controller.address
        assert other.bench({"query": "state"})["model"] == "ur16e"


def test_a_busy_port_is_one_clear_sentence(controller, capsys):
    assert main(["--model", "ur5", "--address", controller.address]) == 2
    words = capsys.readouterr().err
    assert words.count("\n") == 1
    assert f"{controller.address}:29950: the port is already in use; stop the program" in words
    with pytest.raises(ControllerError, match="is already in use"):
        ControllerProcess.start("ur5", address=controller.address)
    assert controller.alive


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--clock", "0"], "0 is not above 0 and up to 1000"),
        (["--clock", "fast"], "'fast' is not a number"),
        (["--joints", "1,2,3"], "six angles are expected, not 3"),
        (["--joints", "9,0,0,0,0,0"], "every angle must lie within"),
        (["--address", "192.0.2.1"], "'192.0.2.1' is not a loopback address"),
        (["--address", "0.0.0.0"], "'0.0.0.0' is not a loopback address"),
        (["--model", "ur99"], "invalid choice: 'ur99'"),
    ],
)
def test_a_wrong_option_is_explained(options, words, capsys):
    with pytest.raises(SystemExit) as ended:
        main(options)
    assert ended.value.code == 2
    assert words in capsys.readouterr().err


def test_a_log_that_cannot_be_written_is_refused(tmp_path, capsys):
    assert main(["--log", str(tmp_path / "none" / "log")]) == 2
    assert "cannot be written" in capsys.readouterr().err


def test_an_address_that_cannot_be_is_refused_with_the_child_s_own_words():
    with pytest.raises(ControllerError, match="'robot' is not a loopback address"):
        ControllerProcess.start("ur5", address="robot")


def test_an_unknown_model_is_refused_before_anything_starts():
    with pytest.raises(ControllerError, match="no arm model 'ur99'; choose one of ur16e, ur5"):
        ControllerProcess.start("ur99")


def test_it_starts_where_it_is_told_and_logs_what_it_is(tmp_path):
    log = tmp_path / "log"
    joints = (-0.5, -1.0, 1.0, -1.0, -1.0, 0.25)
    with ControllerProcess.start("ur5", joints=joints, log=log) as process:
        assert process.bench({"query": "state"})["joints"] == list(joints)
        process.bench({"fault": {"protective_stop": True}})
    assert "stand-in controller (not a robot, not URSim): protective stop" in log.read_text()


def test_the_fast_clock_is_fast():
    with ControllerProcess.start("ur5", clock=20) as process:
        first = process.bench({"query": "state"})["timestamp_s"]
        while process.bench({"query": "state"})["timestamp_s"] < first + 1.0:
            assert process.alive


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_it_ends_in_good_order_on_a_signal(number):
    process = ControllerProcess.start("ur5")
    os.kill(process.pid, number)
    assert process._child.wait(5) == 0
    with pytest.raises(ControllerError, match="has ended, with status 0"):
        process.bench({"query": "state"})
    process.close()
    process.close()


def test_it_does_not_outlive_its_parent(wait):
    program = textwrap.dedent(
        """
        import os, sys
        from runtime.controller import ControllerProcess
        process = ControllerProcess.start("ur5")
        print(process.pid, flush=True)
        os._exit(0)
        """
    )
    root = Path(__file__).resolve().parents[3]
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": str(root)},
    )
    child = int(done.stdout)

    def gone():
        try:
            return b"\0runtime.controller\0" not in Path(f"/proc/{child}/cmdline").read_bytes()
        except OSError:
            return True

    wait(gone)


def test_a_refused_bench_request_is_raised(controller):
    with pytest.raises(ControllerError, match="there is no fault 'earthquake'"):
        controller.bench({"fault": {"earthquake": True}})
    assert controller.bench({"query": "state"})["ok"]


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(st.sampled_from(PORTS), st.binary(max_size=300))
def test_garbage_on_any_port_never_kills_it(controller, port, garbage):
    with socket.create_connection((controller.address, port), timeout=5) as line:
        line.sendall(garbage + b"\n")
    assert controller.bench({"query": "state"})["ok"]
    assert controller.alive


@pytest.mark.parametrize("port", PORTS)
def test_a_flood_is_cut_off_or_swallowed(controller, port):
    with socket.create_connection((controller.address, port), timeout=5) as line:
        try:
            for _ in range(40):
                line.sendall(b"\xff" * 65536)
        except OSError:
            pass
    assert controller.bench({"query": "state"})["ok"]
