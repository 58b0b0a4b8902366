"""The page on the simulated cell: its program and what that prints, and the names it mentions."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

from runtime.cell import DetectorParameters, Mishaps
from runtime.cell.errands import SKILLS
from runtime.parts import Seat

PAGE = (Path(__file__).parents[1] / "docs" / "how-to" / "cell.md").read_text(encoding="utf-8")


def test_the_program_of_the_page_prints_what_it_says():
    (program,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    (printed,) = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == printed


def test_the_page_names_every_setting_and_every_skill():
    told = set(re.findall(r"`([a-z_]+)`", PAGE))
    settings = {field.name for kind in (DetectorParameters, Mishaps) for field in fields(kind)}
    ranges = {"slip_after_m", "jam_share", "cross_thread_turns", "min_pixels", "min_share"}
    assert settings - ranges <= told
    assert {field.name for field in fields(Seat)} - {"offset"} <= told
    skills = set(re.findall(r"^\| `([a-z-]+)[^`]*` \|", PAGE, re.MULTILINE))
    assert set(SKILLS) <= skills
