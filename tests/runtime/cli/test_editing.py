from __future__ import annotations

import subprocess
import sys

WITHOUT = """
import sys
sys.modules["pygls"] = None
from runtime.cli import main
main()
"""


def test_without_its_extra_the_command_names_it():
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT, "lsp"],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == ("the language server is not installed: pip install 'icarus-lite[lsp]'\n")


def test_it_ends_when_the_editor_is_gone():
    done = subprocess.run(
        [sys.executable, "-m", "runtime.cli", "lsp", "--stdio"],
        input="",
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "")
