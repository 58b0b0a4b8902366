"""The how-to on PDDL: its commands, executed in the order of the page."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
PAGE = (ROOT / "docs" / "how-to" / "pddl.md").read_text()
PROBLEMS = Path(__file__).parent / "icarus_lite" / "language" / "pddl" / "problems"


def test_the_commands_of_the_page_work(tmp_path: Path) -> None:
    (tmp_path / "domains").symlink_to(ROOT / "domains")
    shutil.copy(PROBLEMS / "lift.pddl", tmp_path / "domain.pddl")
    shutil.copy(PROBLEMS / "lift-2.pddl", tmp_path / "problem.pddl")
    blocks = re.findall(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    commands = [line for block in blocks for line in block.splitlines()]
    ours = [shlex.split(line)[1:] for line in commands if line.startswith("icarus ")]
    assert len(ours) == 3
    for arguments in ours:
        done = subprocess.run(
            [sys.executable, "-m", "runtime.cli", *arguments],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "gearbox-pddl" / "problem.pddl").exists()
    assert len(done.stdout.splitlines()) == 6
