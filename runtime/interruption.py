"""Ctrl-C, noticed for certain.

Python tells of it by an exception wherever the program happens to be. In a destructor or a callback
that exception is printed and dropped, and an arm would go on: so it is remembered as well.
"""

from __future__ import annotations

import signal
import threading
from types import FrameType
from typing import Self


class Interruption:
    """While entered, from the main thread, remembers that the person has pressed Ctrl-C."""

    def __init__(self) -> None:
        self.asked = False
        self._before: object = None

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, *_exception: object) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)  # type: ignore[arg-type]
            self._before = None

    def check(self) -> None:
        """Raise KeyboardInterrupt if it was pressed, and the exception of then was lost."""
        if self.asked:
            raise KeyboardInterrupt

    def _note(self, _number: int, _frame: FrameType | None) -> None:
        self.asked = True
        raise KeyboardInterrupt
