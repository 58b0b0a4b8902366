"""The command line: `icarus`.

Exit status: 0 it holds or succeeded, 1 it does not, 2 bad input or usage with the reason on
standard error. With `--json`, standard output carries one JSON document and nothing else.
"""

from __future__ import annotations

import sys
from typing import NoReturn

import typer

from icarus_lite import IcarusError
from runtime.cli import (  # noqa: F401 - each adds its commands
    cater,
    cater_generate,
    checking,
    editing,
    explain,
    formatting,
    inferring,
    inspecting,
    pddl,
    planning,
    repl,
    running,
    testing,
    tracking,
)
from runtime.cli.app import BAD_INPUT, HOLDS, app
from runtime.errors import RuntimeFault


def main() -> NoReturn:
    """Run the command line; whatever goes wrong is told in words, with status 2."""
    from aapa import AnchoringError

    try:
        app()
    except (IcarusError, RuntimeFault, AnchoringError) as error:
        sys.stdout.flush()
        typer.echo(str(error), err=True)
        sys.exit(BAD_INPUT)
    except BrokenPipeError:
        # Whoever read our output has enough; there is nobody left to tell.
        sys.stderr.close()
        sys.exit(HOLDS)
    sys.exit(HOLDS)


__all__ = ["app", "main"]
