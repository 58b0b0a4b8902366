"""The driver of a Universal Robots arm.

This side never waits for the robot: it sends orders to the process that holds the connection
(`runtime.drivers.ur_worker`), and reads what that process reports. When the process falls silent
it is ended, and the driver is dead: whoever starts it anew has looked at the robot first.

A software stop is not an emergency stop. Keep the button within reach.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import replace
from multiprocessing import get_context
from typing import Final, Self

from runtime.addresses import answers, is_loopback
from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.stepping import StepEnd, SteppingDriver
from runtime.drivers.steps import Look, Step
from runtime.drivers.ur_link import (
    Begin,
    Close,
    Ended,
    Lost,
    Order,
    Ready,
    Silence,
    StateBoard,
    Stop,
)
from runtime.drivers.ur_worker import work
from runtime.errors import ControllerError, DriverError
from runtime.parts import PartModel

_CLOSE_WITHIN_S: Final = 1.5
_KILL_WITHIN_S: Final = 0.5
_SETTLE_S: Final = 0.1  # after a stop was ordered, states older than this say nothing of it
_LONGEST_BLINK_S: Final = 0.25  # cycles are shorter, unless this process was kept waiting
_WORDS_KEPT: Final = 20
_STAND_IN_SILENCE_S: Final = 2.0
_STAND_IN_WATCHDOG_HZ: Final = 1.0


class UrDriver(SteppingDriver):
    """A `Driver` of one UR arm, through the ur-rtde client in a process of its own.

    Args:
        address: The controller's host name or address.
        config: The robot.
        parts: What is known of the parts, by type.
        log: Called with one line for each order, outcome and message of the client.

    Raises:
        ControllerError: The controller cannot be reached, is of an unsupported version, is not
            running, is another model, or is used by somebody else; the text says what to do.
    """

    def __init__(
        self,
        address: str,
        config: RobotConfig,
        parts: Mapping[str, PartModel],
        *,
        log: Callable[[str], None] | None = None,
    ) -> None:
        config = _patient(config) if is_loopback(address) else config
        super().__init__(config, parts)
        self._address: Final = address
        self._log = log or _discard
        self._words: deque[str] = deque(maxlen=_WORDS_KEPT)
        self._half_a_line = b""
        self._number = 0
        self._ended: Ended | None = None
        self._ready = False
        self._dead = ""
        self._closed = False
        self._stopped_at = 0.0
        self._silence = Silence(_LONGEST_BLINK_S)
        self._board = StateBoard()
        context = get_context("spawn")
        self._orders, theirs = context.Pipe()
        self._said, say = context.Pipe(duplex=False)
        os.set_blocking(self._said.fileno(), False)
        self._worker = context.Process(
            target=work,
            args=(theirs, say, self._board, address, config),
            name=f"ur-driver-{address}",
            daemon=True,
        )
        self._worker.start()
        theirs.close()
        say.close()
        try:
            self._await_ready(address)
        except BaseException:
            self.close()
            raise

    def state(self) -> ArmState:
        """Give the newest measured state; see `Driver.state`."""
        dead = self._notice()
        if dead:
            raise DriverError(dead)
        published = self._board.read()
        assert published is not None, "the worker publishes a state before it is ready"
        return published.arm

    def close(self) -> None:
        """Stop the arm, end the program on the controller, and let go. Never raises or hangs."""
        if self._closed:
            return
        self._run = None
        if not self._dead:
            self._send(Close())
            self._worker.join(_CLOSE_WITHIN_S)
            self._listen()
        self._end_worker()
        self._dead = self._dead or "the driver was closed"
        self._closed = True
        self._orders.close()
        self._said.close()
        with contextlib.suppress(ValueError):  # not even killing has ended it
            self._worker.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def _begin(self, step: Step) -> None:
        if isinstance(step, Look):
            return
        self._number += 1
        self._words.clear()
        self._log(f"order {self._number}: {step}")
        self._send(Begin(self._number, step))

    def _advance(self) -> StepEnd | None:
        ended = self._ended
        if ended is None or ended.number != self._number:
            return None
        self._log(f"order {ended.number}: {ended.reason or 'done'}")
        return StepEnd(self._quoting(ended.reason) if ended.reason else "")

    def _halt(self) -> None:
        if not self._dead:
            self._log("stop")
            self._number += 1
            self._stopped_at = time.monotonic()
            self._send(Stop())

    def _at_rest(self) -> bool:
        published = self._board.read()
        return (
            published is not None
            and not published.moving
            and published.at_s > self._stopped_at + _SETTLE_S
        )

    def _notice(self) -> str:
        if not self._dead:
            self._look_for_loss()
        return self._dead

    def _look_for_loss(self) -> None:
        self._listen()
        self._take_reports()
        if not self._worker.is_alive():
            reason = (
                f"the process that drives the arm ended by itself (status {self._worker.exitcode})"
            )
            if not answers(self._address):
                reason += f"; the controller at {self._address} no longer answers"
            self._die(reason)
        published = self._board.read()
        if not self._ready or published is None:
            return
        silent = self._silence.since(published.at_s, time.monotonic())
        if silent > self._config.watch.worker_silence_s:
            self._die(
                f"the connection to the controller has hung for {silent:.1f} s; the controller's "
                "watchdog stops the arm. See that the controller is on and reachable, then start "
                "this program again"
            )

    def _await_ready(self, address: str) -> None:
        wait_s = self._config.watch.connect_s
        deadline = time.monotonic() + wait_s
        while not (self._notice() or self._ready) and time.monotonic() < deadline:
            self._orders.poll(0.05)
        if self._ready and not self._dead:
            return
        self._die(f"{address}: the controller did not accept the connection within {wait_s:g} s")
        raise ControllerError(self._dead)

    def _take_reports(self) -> None:
        with contextlib.suppress(EOFError, ConnectionError):  # its end is noticed as such
            while self._orders.poll(0):
                match self._orders.recv():
                    case Ready(version):
                        self._ready = True
                        self._log(f"connected, PolyScope {version}")
                    case Ended() as ended:
                        self._ended = ended
                    case Lost(reason):
                        self._die(reason, at_once=False)

    def _send(self, order: Order) -> None:
        with contextlib.suppress(ConnectionError):  # a dead process is noticed as such
            self._orders.send(order)

    def _die(self, reason: str, *, at_once: bool = True) -> None:
        """Be dead from now on. A process that reported the loss itself may finish its farewell."""
        if self._dead:
            return
        self._listen()
        self._dead = self._quoting(reason)
        self._log(f"lost: {self._dead}")
        if at_once:
            self._end_worker()

    def _end_worker(self) -> None:
        if self._worker.is_alive():
            self._worker.kill()
            self._worker.join(_KILL_WITHIN_S)

    def _listen(self) -> None:
        """Take in what the client has written to its standard streams."""
        with contextlib.suppress(BlockingIOError, OSError):
            while chunk := os.read(self._said.fileno(), 65536):
                *lines, self._half_a_line = (self._half_a_line + chunk).split(b"\n")
                for line in lines:
                    words = line.decode(errors="replace").strip()
                    if words:
                        self._words.append(words)
                        self._log(f"client: {words}")

    def _quoting(self, reason: str) -> str:
        return f'{reason} (the client said: "{self._words[-1]}")' if self._words else reason


def _patient(config: RobotConfig) -> RobotConfig:
    """Wait longer for a stand-in: it shares the processors, and nobody stands beside its arm."""
    watch = config.watch
    return replace(
        config,
        watch=replace(
            watch,
            silence_s=max(watch.silence_s, _STAND_IN_SILENCE_S),
            worker_silence_s=max(watch.worker_silence_s, _STAND_IN_SILENCE_S),
            watchdog_hz=min(watch.watchdog_hz, _STAND_IN_WATCHDOG_HZ),
        ),
    )


def _discard(_line: str) -> None:
    """Write no log."""
