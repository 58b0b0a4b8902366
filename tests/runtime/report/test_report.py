from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from pathlib import Path
from urllib.parse import urlencode

import pytest
from recorded_runs import Run, record
from typer.testing import CliRunner

from icarus_lite.trace import Recording
from runtime.cli import app
from runtime.errors import UsageError
from runtime.report import write_report
from runtime.report.contents import contents

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), ""
)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return record(tmp_path_factory.mktemp("run") / "run.jsonl", seed=3, cycles=120, explained=True)


@pytest.fixture(scope="module")
def page(run: Run) -> Path:
    return write_report(Recording(run.path), run.path.parent / "report")[0]


def test_a_row_says_when_and_why(run: Run) -> None:
    rows = contents(Recording(run.path))["rows"]
    assert isinstance(rows, list)
    for row in rows:
        for (first, last), why in zip(row["periods"], row["whys"], strict=True):
            assert row["belief"] in run.believed[first]
            assert "\n".join(why) == run.whys[first][row["belief"]]
            assert last is None or row["belief"] not in run.believed[last + 1]


def test_the_page_stands_alone(page: Path) -> None:
    text = page.read_text()
    outside = re.findall(r'(?:src|href)=|@import|url\(|https?://[^"]*', text)
    assert outside == ["http://www.w3.org/2000/svg"]
    assert "{{" not in text


def test_names_cannot_break_out_of_the_page(tmp_path: Path, run: Run) -> None:
    hostile = "</script><img src=x onerror=alert(1)>"
    path = tmp_path / "run.jsonl"
    path.write_text(run.path.read_text().replace('"left hand"', json.dumps(hostile)))
    text = write_report(Recording(path), tmp_path / "report")[0].read_text()
    assert hostile not in text
    assert "<img" not in text


def test_the_story_is_beside_it(page: Path, run: Run) -> None:
    story = (page.parent / "story.txt").read_text()
    assert story.startswith("The run of store: the agent was to achieve (stored a).")
    for heading in ("What it did, and why", "What went otherwise, and what it made of it"):
        assert f"\n{heading}\n" in story
    assert f"after {len(run.believed)} cycles" in story.splitlines()[-1]


def test_a_run_of_no_cycles(tmp_path: Path, run: Run) -> None:
    path = tmp_path / "empty.jsonl"
    path.write_bytes(run.path.read_bytes().splitlines(keepends=True)[0])
    page, story = write_report(Recording(path), tmp_path / "report")
    assert story.read_text().endswith("No cycle is on record.\n")
    assert page.exists()


def test_a_folder_that_cannot_be_written(tmp_path: Path, run: Run) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match="cannot be written"):
        write_report(Recording(run.path), tmp_path / "file" / "report")


def test_the_command(tmp_path: Path, run: Run) -> None:
    done = CliRunner().invoke(app, ["report", str(run.path), "--out", str(tmp_path / "r")])
    assert done.exit_code == 0
    assert done.stdout.splitlines() == [
        str(tmp_path / "r" / "index.html"),
        str(tmp_path / "r" / "story.txt"),
    ]


@pytest.mark.skipif(not CHROMIUM, reason="no Chromium is installed")
@pytest.mark.parametrize("cycle", [3, 80])
def test_a_browser_shows_what_was_believed_and_why(
    tmp_path: Path, page: Path, run: Run, cycle: int
) -> None:
    belief = min(run.believed[cycle])
    shown = in_browser(tmp_path, f"{page.as_uri()}#{urlencode({'cycle': cycle, 'belief': belief})}")
    bold = re.findall(r'class="row now(?: chosen)?"[^>]*data-belief="([^"]*)"', shown)
    assert {html.unescape(each) for each in bold} == set(run.believed[cycle])
    assert f">cycle {cycle}</output>" in shown
    why = re.search(r'<pre id="why"[^>]*>(.*?)</pre>', shown, re.DOTALL)
    assert why is not None
    assert html.unescape(why.group(1)).startswith("As it was when this began, in cycle ")
    assert belief in html.unescape(why.group(1))


@pytest.mark.skipif(not CHROMIUM, reason="no Chromium is installed")
def test_a_browser_shows_a_run_of_no_cycles(tmp_path: Path, run: Run) -> None:
    path = tmp_path / "empty.jsonl"
    path.write_bytes(run.path.read_bytes().splitlines(keepends=True)[0])
    page, _ = write_report(Recording(path), tmp_path / "report")
    assert "No cycle is on record." in in_browser(tmp_path, page.as_uri())


def in_browser(tmp_path: Path, address: str) -> str:
    """Open a page, let its script run, and give what has become of it."""
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
    profile = f"--user-data-dir={tmp_path / 'profile'}"
    done = subprocess.run(
        [CHROMIUM, *options, "--no-first-run", profile, "--dump-dom", address],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return done.stdout
