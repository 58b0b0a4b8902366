"""How processes end: all is printed, all who asked are told, the status is as set."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

BEGIN = "import atexit, sys, threading; from runtime.ending import Ending; ending = Ending();"


def run(code: str, stdout: int | None = subprocess.PIPE) -> tuple[int, str, str]:
    done = subprocess.run(
        [sys.executable, "-c", BEGIN + code],
        stdout=stdout,
        stderr=subprocess.PIPE,
        text=True,
        timeout=30,
        check=False,
        env={name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"},
    )
    return done.returncode, done.stdout, done.stderr


@pytest.mark.parametrize("status", [0, 1, 2, 77])
def test_the_status_is_as_set_and_all_is_printed(status: int) -> None:
    code = f"print('x' * 100_000); ending.status = {status}"
    assert run(code) == (status, "x" * 100_000 + "\n", "")


def test_nothing_is_taken_apart() -> None:
    code = "\nclass Kept:\n def __del__(self): print('gone')\nkept = Kept(); ending.status = 0"
    assert run(code) == (0, "", "")
    assert run(code.replace("; ending.status = 0", "")) == (0, "gone\n", "")


def test_others_are_told_and_threads_have_their_time() -> None:
    code = (
        "atexit.register(print, 'told'); ending.status = 3;"
        "threading.Thread(target=lambda: (threading.Event().wait(0.1), print('done'))).start()"
    )
    assert run(code) == (3, "done\ntold\n", "")


def test_who_has_closed_the_output_is_not_blamed() -> None:
    assert run("print('all'); sys.stdout.close(); ending.status = 0") == (0, "all\n", "")


def test_an_error_ends_as_usual() -> None:
    status, printed, told = run("print('before'); raise LookupError('nobody')")
    assert (status, printed) == (1, "before\n")
    assert told.endswith("LookupError: nobody\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a full device")
def test_what_cannot_be_printed_is_told() -> None:
    with open("/dev/full", "w") as full:  # noqa: PTH123 - its number is wanted
        status, _, told = run("print('lost'); ending.status = 0", full.fileno())
    assert (status, told) == (2, "standard output: No space left on device\n")
