"""The end of a process: all that was printed is out, and nothing is taken apart first.

To take apart hundreds of modules and thousands of objects that the system takes back anyway is a
tenth of a short run.
"""

from __future__ import annotations

import atexit
import os
import sys

_STANDARD_ERROR = 2
_BAD_INPUT = 2


class Ending:
    """How this process is to end, once its threads have and all others were asked that asked to be.

    It has to be made before anything else asks to be told of the end (`atexit`), so that it comes
    last. As long as no status is set, the process ends as usual.

    Attributes:
        status: The exit status.
    """

    def __init__(self) -> None:
        self.status: int | None = None
        atexit.register(self._end)

    def _end(self) -> None:
        if self.status is None:
            return
        status = self.status
        try:
            if sys.stdout is not None and not sys.stdout.closed:  # a server may have closed it
                sys.stdout.flush()
        except BrokenPipeError:
            pass  # whoever read it has enough
        except OSError as error:
            if status != _BAD_INPUT:  # else it was told already why
                reason = error.strerror or error
                os.write(_STANDARD_ERROR, f"standard output: {reason}\n".encode())
            status = _BAD_INPUT
        os._exit(status)
