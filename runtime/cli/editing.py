"""`icarus lsp`."""

from __future__ import annotations

from typing import Annotated

import typer

from runtime.cli.app import app
from runtime.errors import UsageError


@app.command(epilog="Example: icarus lsp")
def lsp(
    *,
    stdio: Annotated[
        bool, typer.Option("--stdio", help="What it does anyway; some editors say so.")
    ] = False,
) -> None:
    """Serve an editor: the Language Server Protocol over standard input and output."""
    del stdio
    try:
        from runtime.lsp import serve
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in ("lsprotocol", "pygls"):
            raise
        raise UsageError(
            "the language server is not installed: pip install 'icarus-lite[lsp]'"
        ) from None
    from runtime.drivers.motions import COMMANDS

    serve(COMMANDS)
