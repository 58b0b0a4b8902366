"""The driver of a Universal Robots arm.

This side never waits for the robot: it sends orders to the process that holds the connection
(`runtime.drivers.ur_worker`), and reads what that process reports. When the process falls silent
it is ended, and the driver is dead, until somebody who has looked at the robot says otherwise.

A software stop is not an emergency stop. Keep the button within reach.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Final, Self

from runtime.addresses import is_loopback
from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.stepping import StepEnd, SteppingDriver
from runtime.drivers.steps import ArmStep
from runtime.drivers.ur_process import WorkerProcess
from runtime.errors import DriverError
from runtime.parts import PartModel

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
        super().__init__(_patient(config) if is_loopback(address) else config, parts)
        self._address: Final = address
        self._log = log or _discard
        self._closed = False
        self._worker, _ = self._start_worker(recover=False)

    def state(self) -> ArmState:
        """Give the newest measured state; see `Driver.state`."""
        lost = self._notice()
        if lost:
            raise DriverError(lost)
        return replace(self._worker.newest().arm, regrips=self._regrips)

    def recover(self) -> str:
        """Make the arm fit to be driven again; see `Recoverable`.

        A protective stop is unlocked, once the controller allows it; the interrupted program is
        ended before that, and nothing is ever played. All that was checked before the first move
        is checked anew.
        """
        if self._closed:
            raise DriverError("the driver was closed")
        self._run = None
        self._log("recovery, at the operator's word")
        self._worker.close()
        self._worker, done = self._start_worker(recover=True)
        return f"{done}; the arm can be driven again" if done else "the arm can be driven again"

    def close(self) -> None:
        """Stop the arm, end the program on the controller, and let go. Never raises or hangs."""
        self._run = None
        self._closed = True
        self._worker.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def _begin(self, step: ArmStep) -> None:
        self._worker.begin(step)

    def _advance(self) -> StepEnd | None:
        ended = self._worker.ended()
        return None if ended is None else StepEnd(ended.reason, ended.felt)

    def _halt(self) -> None:
        self._worker.stop()

    def _at_rest(self) -> bool:
        return self._worker.at_rest()

    def _notice(self) -> str:
        return self._worker.lost()

    def _start_worker(self, *, recover: bool) -> tuple[WorkerProcess, str]:
        """Give a process that holds the arm, and what was released for that."""
        worker = WorkerProcess(self._address, self._config, self._log, recover=recover)
        try:
            return worker, worker.await_ready()
        except BaseException:
            worker.close()
            raise


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
