"""A run whose program is killed at some cycle, and which another one takes up from its trace.

The controller, and so the arm, lives on: it is another machine. What the killed program had begun
there it must not go on with for long.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Final

from gearbox.trials import Trial

_LOOK_EVERY_S: Final = 0.01


def run_and_kill(
    trial: Trial, domain: Path, trace: Path, address: str, cycles: int, within_s: float
) -> bool:
    """Run a trial as `icarus run` does, and kill the program once its trace has so many cycles.

    Args:
        trial: The run.
        domain: The domain file.
        trace: Where the trace goes.
        address: The controller's.
        cycles: After how many it is killed, at least 1.
        within_s: How long it may take to come so far, s.

    Returns:
        Whether it was killed; if not, it was over before.
    """
    words = [sys.executable, "-m", "runtime.cli", "run", str(domain)]
    words += ["--task", trial.task, "--seed", str(trial.seed), "--clock", f"{trial.clock:g}"]
    words += ["--address", address, "--trace", str(trace), "--json"]
    words += [] if trial.attachments else ["--no-attachments"]
    give_up, seen = time.monotonic() + within_s, LineCounter(trace)
    with subprocess.Popen(  # noqa: S603 - our own program
        words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as program:
        while program.poll() is None:
            if seen.count() > cycles or time.monotonic() > give_up:
                # This very process and none of its own: they have to notice by themselves.
                os.kill(program.pid, signal.SIGKILL)
                program.wait()
                return True
            time.sleep(_LOOK_EVERY_S)
    return False


class LineCounter:
    """Counts the whole lines of a file that grows, reading each byte once.

    Args:
        path: The file; it need not be there yet.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._read = 0
        self._lines = 0

    def count(self) -> int:
        """Give how many there are now."""
        try:
            with self._path.open("rb") as file:
                file.seek(self._read)
                found = file.read()
        except FileNotFoundError:
            return 0
        self._read += len(found)
        self._lines += found.count(b"\n")
        return self._lines
