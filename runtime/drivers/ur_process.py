"""The process that holds the connection to a UR arm, as the driver sees it: orders, reports, signs.

Nothing here waits for the robot. When the process falls silent it is ended; what is lost stays
lost, and another process has to be started.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections import deque
from collections.abc import Callable
from multiprocessing import get_context
from typing import Final

from runtime.addresses import answers
from runtime.config import RobotConfig
from runtime.drivers.steps import ArmStep
from runtime.drivers.ur_link import (
    Begin,
    Close,
    Ended,
    Lost,
    Order,
    Published,
    Ready,
    Silence,
    StateBoard,
    Stop,
)
from runtime.drivers.ur_safety import ONLY_ON_YOUR_WORD
from runtime.drivers.ur_worker import work
from runtime.errors import ControllerError

_CLOSE_WITHIN_S: Final = 1.5
_KILL_WITHIN_S: Final = 0.5
_FAREWELL_WITHIN_S: Final = 1.0
_SETTLE_S: Final = 0.1  # after a stop was ordered, states older than this say nothing of it
_LONGEST_BLINK_S: Final = 0.25  # cycles are shorter, unless this process was kept waiting
_RELEASE_WITHIN_S: Final = 15.0  # a protective stop cannot be unlocked at once
_WORDS_KEPT: Final = 20


class WorkerProcess:
    """One process, from its start to its end.

    Args:
        address: The controller.
        config: The robot.
        log: Called with each line that the process or the client says.
        recover: The operator has given the word: a protective stop is released first.
    """

    def __init__(
        self, address: str, config: RobotConfig, log: Callable[[str], None], *, recover: bool
    ) -> None:
        self._address = address
        self._config = config
        self._log = log
        self._patience_s = config.watch.connect_s + (_RELEASE_WITHIN_S if recover else 0.0)
        self._words: deque[str] = deque(maxlen=_WORDS_KEPT)
        self._half_a_line = b""
        self._number = 0
        self._ended: Ended | None = None
        self._ready: Ready | None = None
        self._dead = ""
        self._closed = False
        self._stopped_at = 0.0
        self._silence = Silence(_LONGEST_BLINK_S)
        self._board = StateBoard()
        context = get_context("spawn")
        self._orders, theirs = context.Pipe()
        self._said, say = context.Pipe(duplex=False)
        os.set_blocking(self._said.fileno(), False)
        self._process = context.Process(
            target=work,
            args=(theirs, say, self._board, address, config, recover),
            name=f"ur-driver-{address}",
            daemon=True,
        )
        self._process.start()
        theirs.close()
        say.close()

    @property
    def pid(self) -> int | None:
        """The process's id."""
        return self._process.pid

    def await_ready(self) -> str:
        """Wait until the arm can be driven; give what was released for that, if anything.

        Raises:
            ControllerError: It cannot; the text says what to do.
        """
        deadline = time.monotonic() + self._patience_s
        while not (self.lost() or self._ready) and time.monotonic() < deadline:
            self._orders.poll(0.05)
        if self._ready is None or self._dead:
            self._die(
                f"{self._address}: the controller did not accept the connection within "
                f"{self._patience_s:g} s"
            )
            raise ControllerError(self._dead)
        return self._ready.done

    def newest(self) -> Published:
        """Give the newest state."""
        published = self._board.read()
        assert published is not None, "a state is published before the process is ready"
        return published

    def begin(self, step: ArmStep) -> None:
        """Order a step."""
        self._number += 1
        self._words.clear()
        self._log(f"order {self._number}: {step}")
        self._send(Begin(self._number, step))

    def ended(self) -> Ended | None:
        """Give how the step ordered last has ended; None while it goes on."""
        ended = self._ended
        if ended is None or ended.number != self._number:
            return None
        felt = f" ({ended.felt.words})" if ended.felt is not None else ""
        self._log(f"order {ended.number}: {ended.reason or 'done'}{felt}")
        if not ended.reason:
            return ended
        return Ended(ended.number, self._quoting(ended.reason), ended.felt)

    def stop(self) -> None:
        """Order a standstill."""
        if self._dead:
            return
        self._log("stop")
        self._number += 1
        self._stopped_at = time.monotonic()
        self._send(Stop())

    def at_rest(self) -> bool:
        """Tell whether the arm stands still, and no order says otherwise."""
        published = self._board.read()
        return (
            published is not None
            and not published.moving
            and published.at_s > self._stopped_at + _SETTLE_S
        )

    def lost(self) -> str:
        """Look at what has come in; say why the arm cannot be driven any more, empty if it can."""
        if not self._dead:
            self._look_for_loss()
        return self._dead

    def close(self) -> None:
        """Stop the arm, end the program on the controller, and let go. Never raises or hangs."""
        if self._closed:
            return
        self._closed = True
        if not self._dead:
            self._send(Close())
            self._process.join(_CLOSE_WITHIN_S)
            self._listen()
        elif self._process.is_alive():  # it reported the loss itself, and ends the program
            self._process.join(_FAREWELL_WITHIN_S)
        self._kill()
        self._dead = self._dead or "the driver was closed"
        self._orders.close()
        self._said.close()
        with contextlib.suppress(ValueError):  # not even killing has ended it
            self._process.close()

    def _look_for_loss(self) -> None:
        self._listen()
        self._take_reports()
        if not self._process.is_alive():
            reason = (
                f"the process that drives the arm ended by itself (status {self._process.exitcode})"
            )
            if self._ready is None and not self._words and self._process.exitcode == 1:
                reason += (
                    "; it imports the program that starts it, whose main part must stand under "
                    'if __name__ == "__main__":'
                )
            elif not answers(self._address):
                reason += f"; the controller at {self._address} no longer answers"
            self._die(reason)
        published = self._board.read()
        if self._ready is None or published is None:
            return
        silent = self._silence.since(published.at_s, time.monotonic())
        if silent > self._config.watch.worker_silence_s:
            self._die(
                f"the connection to the controller has hung for {silent:.1f} s; the controller's "
                "watchdog stops the arm. See that the controller is on and reachable"
                f"{ONLY_ON_YOUR_WORD}"
            )

    def _take_reports(self) -> None:
        with contextlib.suppress(EOFError, ConnectionError):  # its end is noticed as such
            while self._orders.poll(0):
                match self._orders.recv():
                    case Ready() as ready:
                        self._ready = ready
                        self._log(f"connected, PolyScope {ready.version}")
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
            self._kill()

    def _kill(self) -> None:
        if self._process.is_alive():
            self._process.kill()
            self._process.join(_KILL_WITHIN_S)

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
