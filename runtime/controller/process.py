"""Starting the stand-in controller as a process of its own, and talking to its bench.

A process of its own because the client's constructors and destructors hold Python's global lock
while they wait for the controller: in one interpreter the two would wait for each other for ever.
"""

from __future__ import annotations

import json
import os
import select
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, Final, Self

from runtime.controller.bench_client import BenchClient
from runtime.controller.faults import parse_faults
from runtime.controller.ports import BUSY, NAME, PORTS
from runtime.errors import ControllerError
from runtime.kinematics import MODELS

_READY_WITHIN_S: Final = 20.0
_TERMINATE_WITHIN_S: Final = 3.0
_ADDRESSES: Final = 200
_TICKS_PER_S: Final = 4


class ControllerProcess:
    """A running stand-in controller, owned by this process and gone with it at the latest.

    Make one with `start`; it is a context manager. Thread-safe where it matters: `bench` may be
    called from several threads, `close` any number of times.
    """

    __slots__ = ("_bench", "_child", "_errors", "address", "model")

    def __init__(
        self, model: str, address: str, child: subprocess.Popen[str], errors: IO[str]
    ) -> None:
        self.model: Final = model
        self.address: Final = address
        self._child = child
        self._errors = errors
        self._bench = BenchClient(address)

    @classmethod
    def start(
        cls,
        model: str,
        *,
        address: str | None = None,
        clock: float = 1.0,
        joints: Sequence[float] | None = None,
        log: Path | str | None = None,
        version: str | None = None,
        faults: Sequence[Mapping[str, Any]] = (),
        seed: int = 0,
        journal: Path | str | None = None,
    ) -> ControllerProcess:
        """Start a controller and wait until all its ports listen.

        Args:
            model: "ur5" or "ur16e".
            address: Where to listen; None takes a free loopback address that no controller has had
                lately: a client of an earlier one may still be trying to connect again, or about
                to stop its program.
            clock: Control cycles of robot time per control period of wall time, > 0.
            joints: Six joint angles to start at, rad; None is the usual tool-down pose.
            log: A file for the controller's log; None writes none.
            version: The PolyScope version to play, such as "5.17.3"; None takes the usual one.
            faults: What is to go wrong and when, as `runtime.controller.faults` describes it.
            seed: Decides what the faults leave to chance.
            journal: A file for what the controller witnesses; it can be asked for it anyway.

        Raises:
            ControllerError: It did not start; the text is the controller's own sentence.
            ConfigError: The faults are no schedule; says where and what is allowed.
        """
        if model not in MODELS:
            raise ControllerError(
                f"there is no arm model '{model}'; choose one of {', '.join(sorted(MODELS))}"
            )
        options = ["--clock", repr(float(clock)), "--parent", str(os.getpid())]
        if joints is not None:
            # One word, so that a leading minus is not taken for an option.
            options.append("--joints=" + ",".join(repr(float(q)) for q in joints))
        for name, value in (("--log", log), ("--journal", journal), ("--version", version)):
            if value is not None:
                options += [name, str(value)]
        with _schedule_file(faults, seed) as schedule:
            return cls._start(model, address, [*options, *schedule])

    @classmethod
    def _start(cls, model: str, address: str | None, options: Sequence[str]) -> ControllerProcess:
        candidates = [address] if address is not None else _free_addresses()
        refusal = f"no loopback address is free for the {NAME}"
        for candidate in candidates:
            process, refusal = cls._spawn(model, candidate, options)
            if process is not None:
                return process
            if BUSY not in refusal:
                break
        raise ControllerError(refusal)

    @classmethod
    def _spawn(
        cls, model: str, address: str, options: Sequence[str]
    ) -> tuple[ControllerProcess | None, str]:
        """Start a child; give it once it is ready, or None and its own last words."""
        errors = tempfile.TemporaryFile("w+", encoding="utf-8")  # noqa: SIM115 - lives with the child
        child = subprocess.Popen(  # noqa: S603 - our own module, arguments checked by it
            [
                *(sys.executable, "-m", "runtime.controller"),
                *("--model", model, "--address", address),
                *options,
            ],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
            env=_environment(),
            # Ctrl-C belongs to the driver: it must still find a controller to stop the arm with.
            start_new_session=True,
        )
        process = cls(model, address, child, errors)
        if _says_ready(child, model, address):
            return process, ""
        slow = child.poll() is None
        process._end_child()
        words = process.last_words()
        process.close()
        if slow:
            words = f"the {NAME} at {address} was not ready within {_READY_WITHIN_S:g} s. {words}"
        return None, words.strip() or f"the {NAME} at {address} ended without a word"

    @property
    def pid(self) -> int:
        """The controller's process id."""
        return self._child.pid

    @property
    def alive(self) -> bool:
        """Whether the controller's process is still running."""
        return self._child.poll() is None

    def bench(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Send one request to the bench port and give its answer (see `runtime.controller.bench`).

        Raises:
            ControllerError: The controller refused, with its own sentence, or cannot be reached.
        """
        if not self.alive:
            # By now its address may be another controller's.
            raise ControllerError(
                f"the {NAME} at {self.address} has ended, with status {self._child.returncode}"
            )
        return self._bench.request(request)

    def set_tool_input(self, index: int, on: bool) -> None:  # noqa: FBT001 - a signal's level
        """Wire a level to a tool digital input (0 or 1), as a gripper's sensor would."""
        self.bench({"inputs": {f"tool_digital_in_{index}": on}})

    def close(self) -> None:
        """End the controller: ask, wait, and kill if it does not listen. Never raises."""
        self._bench.close()
        self._end_child()
        if self._child.stdout is not None:
            self._child.stdout.close()
        self._errors.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def _end_child(self) -> None:
        if self._child.poll() is None:
            self._child.terminate()
            try:
                self._child.wait(_TERMINATE_WITHIN_S)
            except subprocess.TimeoutExpired:
                self._child.kill()
                self._child.wait()

    def last_words(self) -> str:
        """Give the end of what the controller has said on its standard error."""
        self._errors.seek(0)
        return self._errors.read()[-4000:]


@contextmanager
def _schedule_file(faults: Sequence[Mapping[str, Any]], seed: int) -> Iterator[list[str]]:
    """Give the options for a schedule, which lies in a file while the child reads it."""
    content = [dict(fault) for fault in faults]
    parse_faults(content, seed)  # a mistake is the caller's: it should not look like the child's
    if not content:
        yield []
        return
    with tempfile.NamedTemporaryFile("w", suffix=".yaml", encoding="utf-8") as file:
        json.dump(content, file)  # which is YAML too
        file.flush()
        yield ["--faults", file.name, "--seed", str(seed)]


def _environment() -> dict[str, str]:
    """Let the child find this very package, installed or not."""
    root = str(Path(__file__).resolve().parents[2])
    known = os.environ.get("PYTHONPATH")
    return {**os.environ, "PYTHONPATH": f"{root}{os.pathsep}{known}" if known else root}


def _free_addresses() -> Iterator[str]:
    """Give loopback addresses none of whose controller ports is taken at this moment.

    A net for each process, and in it another address each tick of the clock.
    """
    net, tick = os.getpid(), int(time.monotonic() * _TICKS_PER_S)
    for number in range(tick, tick + _ADDRESSES):
        address = f"127.{1 + net % 200}.{net // 200 % 250}.{2 + number % 250}"
        if all(_is_free(address, port) for port in PORTS):
            yield address


def _is_free(address: str, port: int) -> bool:
    with socket.socket() as probe:
        # As the controller does: connections that linger after their end are no obstacle.
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((address, port))
        except OSError:
            return False
    return True


def _says_ready(child: subprocess.Popen[str], model: str, address: str) -> bool:
    assert child.stdout is not None
    deadline = time.monotonic() + _READY_WITHIN_S
    while (left := deadline - time.monotonic()) > 0:
        readable, _, _ = select.select([child.stdout], [], [], left)
        if readable:
            line = child.stdout.readline()
            return line.strip() == f"ready {model} {address}"
    return False
