"""The command line called in this process, for the tests of its commands."""

from __future__ import annotations

import io
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from runtime.cli import main


def icarus(*args: str | Path | int) -> tuple[int, str, str]:
    """Run `icarus` with these arguments; give the status, standard output and standard error."""
    out, err = io.StringIO(), io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", *map(str, args)]
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv = argv
    return int(ended.value.code or 0), out.getvalue(), err.getvalue()
