"""Every example runs, and the README's Python does too."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_runs(example: Path, tmp_path: Path) -> None:
    command = [sys.executable, str(example)]
    if "picture" in example.stem:
        command.append(str(tmp_path / "cell.png"))
    done = subprocess.run(
        command, capture_output=True, text=True, cwd=ROOT, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout


def test_the_python_of_the_readme_runs() -> None:
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("(pick-up hand1 hubcover)\n(attached hubcover hand1)  because")


def test_the_message_in_the_readme_is_what_check_says(tmp_path: Path) -> None:
    text = "(percepts (hand))\n(concepts\n  ((free ?h) :elements ((hnd ?h))))\n"
    (tmp_path / "broken.icr").write_text(text)
    done = subprocess.run(
        [sys.executable, "-m", "runtime.cli", "check", "broken.icr"],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=60,
        check=False,
    )
    shown = (ROOT / "README.md").read_text()
    assert done.stderr.strip() in shown
