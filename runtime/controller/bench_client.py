"""Talking to the bench of a stand-in controller, whoever started it: asking, or just telling."""

from __future__ import annotations

import contextlib
import json
import socket
import threading
from collections.abc import Mapping
from typing import Any, Final

from runtime.controller.ports import BENCH_PORT, NAME
from runtime.errors import ControllerError

_ANSWER_WITHIN_S: Final = 10.0


class BenchClient:
    """A connection to a bench port, made when it is first needed. Thread-safe.

    Args:
        address: The controller's host.
    """

    __slots__ = ("_lock", "_socket", "address")

    def __init__(self, address: str) -> None:
        self.address: Final = address
        self._socket: socket.socket | None = None
        self._lock = threading.Lock()

    def request(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Send one request and give its answer (see `runtime.controller.bench`).

        Raises:
            ControllerError: The controller refused, with its own sentence, or cannot be reached.
        """
        with self._lock:
            try:
                if self._socket is None:
                    self._socket = socket.create_connection(
                        (self.address, BENCH_PORT), timeout=_ANSWER_WITHIN_S
                    )
                self._socket.sendall(json.dumps(dict(request)).encode() + b"\n")
                answer = json.loads(_read_line(self._socket))
            except (OSError, ValueError) as error:
                self._drop()
                raise ControllerError(
                    f"the bench of the {NAME} at {self.address}:{BENCH_PORT} does not answer "
                    f"({error}); is the controller still running?"
                ) from error
        if not isinstance(answer, dict) or answer.get("ok") is not True:
            reason = answer.get("error") if isinstance(answer, dict) else answer
            raise ControllerError(f"the {NAME} at {self.address} refused: {reason}")
        return answer

    def set_tool_input(self, index: int, on: bool) -> None:  # noqa: FBT001 - a signal's level
        """Wire a level to a tool digital input (0 or 1), as a gripper's sensor would.

        Raises:
            ControllerError: As for `request`.
        """
        self.request({"inputs": {f"tool_digital_in_{index}": on}})

    def close(self) -> None:
        """Close the connection; the next request would open it again."""
        with self._lock:
            self._drop()

    def _drop(self) -> None:
        if self._socket is not None:
            self._socket.close()
            self._socket = None


class BenchTeller:
    """Tells a bench one thing again and again, and never waits for it.

    Args:
        address: The controller's host.
        request: What it is told.
    """

    __slots__ = ("_line", "_socket", "address")

    def __init__(self, address: str, request: Mapping[str, Any]) -> None:
        self.address: Final = address
        self._line = json.dumps(dict(request)).encode() + b"\n"
        self._socket: socket.socket | None = None

    def tell(self) -> None:
        """Tell it. Never raises: that a controller is gone is for others to notice."""
        try:
            if self._socket is None:
                self._socket = socket.create_connection(
                    (self.address, BENCH_PORT), timeout=_ANSWER_WITHIN_S
                )
                self._socket.settimeout(0)
            with contextlib.suppress(BlockingIOError):
                while self._socket.recv(65536):
                    pass  # what it answered to earlier ones
            self._socket.sendall(self._line)
        except OSError:
            self.close()

    def close(self) -> None:
        """Close the connection; the next telling would open it again."""
        if self._socket is not None:
            self._socket.close()
            self._socket = None


def _read_line(connection: socket.socket) -> bytes:
    line = bytearray()
    while not line.endswith(b"\n"):
        chunk = connection.recv(65536)
        if not chunk:
            raise ConnectionError("the connection was closed")
        line += chunk
    return bytes(line)
