"""`icarus controller`, and the how-to about it."""

from __future__ import annotations

import json
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from command_line import icarus

from runtime.controller.faults import KINDS

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "how-to" / "controller.md").read_text(encoding="utf-8")
ADDRESS = "127.0.41.7"
"""In place of the page's: several of these tests may run at once."""

pytestmark = pytest.mark.robot


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)


@contextmanager
def controller(*arguments: str, cwd: Path) -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(
        [sys.executable, "-m", "runtime.cli", "controller", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline().startswith("ready ")
            yield process
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(10)


@pytest.fixture
def page_folder(tmp_path: Path) -> Path:
    """A folder with the page's files, on an address of the tests' own."""
    (tmp_path / "faults.yaml").write_text(blocks("yaml")[0])
    (tmp_path / "program.py").write_text(blocks("python")[0].replace("127.0.0.2", ADDRESS))
    return tmp_path


def test_the_page_s_program_prints_what_the_page_says(page_folder: Path) -> None:
    command = next(line for line in blocks("console")[0].splitlines() if line.startswith("$ "))
    words = shlex.split(command.removeprefix("$ icarus controller").replace("127.0.0.2", ADDRESS))
    assert "faults.yaml" in words
    with controller(*words, cwd=page_folder) as process:
        done = subprocess.run(
            [sys.executable, "program.py"],
            capture_output=True,
            text=True,
            timeout=60,
            cwd=page_folder,
            check=False,
        )
    assert done.stdout == blocks("text")[0], done.stderr
    assert process.returncode == 0
    lines = (page_folder / "journal.jsonl").read_text().splitlines()
    events = [json.loads(line) for line in lines]
    assert [event["event"] for event in events if "stop" in event["event"]] == ["protective_stop"]
    assert events[-1]["event"] == "summary"
    shown = json.loads(blocks("json")[0])
    (stop,) = [event for event in events if event["event"] == "protective_stop"]
    assert shown.keys() == stop.keys()


def test_the_page_s_program_is_short() -> None:
    assert len(blocks("python")[0].splitlines()) <= 45


def test_the_page_s_other_schedule_is_one(tmp_path: Path) -> None:
    path = tmp_path / "faults.yaml"
    path.write_text(blocks("yaml")[1])
    with controller("--faults", str(path), "--address", ADDRESS, cwd=tmp_path):
        pass


def test_the_page_names_every_fault_and_every_event() -> None:
    for kind in KINDS:
        assert f"| `{kind}` |" in PAGE
    sources = "".join(
        path.read_text(encoding="utf-8") for path in (ROOT / "runtime/controller").glob("*.py")
    )
    events = re.findall(r'journal\.note\(\s*"(\w+)"', sources)
    assert len(events) > 10
    for event in events:
        assert f"`{event}`" in PAGE


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--model", "ur7"), "invalid choice: 'ur7'"),
        (("--address", "10.0.0.1"), "'10.0.0.1' is not a loopback address"),
        (("--joints=1,2",), "six angles are expected, not 2"),
        (("--joints=9,0,0,0,0,0",), "every angle must lie within +-2 pi rad"),
        (("--version", "5.1"), "PolyScope 5.1 is not played for the ur5"),
        (("--version", "new"), "'new' is not a PolyScope version"),
        (("--faults", "none.yaml"), "none.yaml: cannot be read: No such file or directory"),
        (("--faults", "wrong.yaml"), "wrong.yaml: entry 1: fault: 'dye'; did you mean die?"),
        (("--clock", "0"), "0.1<=x<=20"),
        (("--seed", "-1"), "x>=0"),
    ],
)
def test_what_cannot_be_is_refused_in_words(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: tuple[str, ...],
    words: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wrong.yaml").write_text("- fault: dye\n")
    status, _, said = icarus("controller", *arguments)
    assert status == 2
    assert words in said


@pytest.mark.parametrize("option", ["--journal", "--log"])
def test_a_file_that_cannot_be_written_is_said_so(tmp_path: Path, option: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "runtime.cli", "controller", option, "nowhere/file"],
        capture_output=True,
        text=True,
        timeout=60,
        cwd=tmp_path,
        check=False,
    )
    assert done.returncode == 2
    name = option.removeprefix("--")
    assert done.stderr == (
        f"the {name} nowhere/file cannot be written: No such file or directory; choose another\n"
    )
