"""The command line: `icarus`.

Exit status: 0 it holds or succeeded, 1 it does not, 2 bad input or usage with the reason on
standard error. With `--json`, standard output carries one JSON document and nothing else.
"""

from __future__ import annotations

import gc
import sys
from contextlib import suppress
from typing import NoReturn

import typer

from icarus_lite import IcarusError
from runtime.cli.app import BAD_INPUT, HOLDS, app
from runtime.ending import Ending
from runtime.errors import RuntimeFault

_ALLOCATIONS = 50_000
"""After so many new objects Python looks for garbage. What is imported and read lasts as long as
the process, so that to look after each seven hundred, as is usual, is a tenth of a short run."""


def main() -> NoReturn:
    """Run the command line; whatever goes wrong is told in words, with status 2."""
    try:
        app()
    except (IcarusError, RuntimeFault) as error:
        _tell(error)
    except ValueError as error:
        if not _is_told_by_the_eyes(error):
            raise
        _tell(error)
    except BrokenPipeError:
        # Whoever read our output has enough; there is nobody left to tell.
        sys.stderr.close()
        sys.exit(HOLDS)
    except OSError as error:  # such as a disk that is full
        _tell(f"{error.filename or 'standard output'}: {error.strerror or error}")
    sys.exit(HOLDS)


def program() -> NoReturn:
    """Run the command line as a process of its own, which then ends at once."""
    ending = Ending()
    gc.set_threshold(_ALLOCATIONS)
    try:
        main()
    except SystemExit as ended:
        if ended.code is None or isinstance(ended.code, int):
            ending.status = ended.code or HOLDS
        raise


def _is_told_by_the_eyes(error: ValueError) -> bool:
    """Tell whether an error is one of perception's, without importing it for the question."""
    if "aapa" not in sys.modules:
        return False
    from aapa import AnchoringError

    return isinstance(error, AnchoringError)


def _tell(error: Exception | str) -> NoReturn:
    with suppress(OSError):
        sys.stdout.flush()
    typer.echo(str(error), err=True)
    sys.exit(BAD_INPUT)


__all__ = ["app", "main", "program"]
