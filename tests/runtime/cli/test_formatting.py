"""`icarus fmt` as a person calls it."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest

from runtime.cli import main

UGLY = "(domain   d)\n(goals (on a b)\n   )\n"
TIDY = "(domain d)\n\n(goals (on a b))\n"
BROKEN = "(goals (on a b)\n"
PAGE = Path(__file__).parents[3] / "docs" / "how-to" / "format.md"


def icarus(*args: str | Path, given: bytes = b"") -> tuple[int, str, str]:
    """Call the command line in this process, with something on its standard input."""
    out, err = io.StringIO(), io.StringIO()
    argv, sys.argv = sys.argv, ["icarus", "fmt", *map(str, args)]
    stdin, sys.stdin = sys.stdin, io.TextIOWrapper(io.BytesIO(given))
    try:
        with redirect_stdout(out), redirect_stderr(err), pytest.raises(SystemExit) as ended:
            main()
    finally:
        sys.argv, sys.stdin = argv, stdin
    return int(ended.value.code or 0), out.getvalue(), err.getvalue()


@pytest.fixture
def ugly(tmp_path: Path) -> Path:
    path = tmp_path / "ugly.icr"
    path.write_text(UGLY)
    return path


@pytest.fixture
def tidy(tmp_path: Path) -> Path:
    path = tmp_path / "tidy.icr"
    path.write_text(TIDY)
    return path


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    path = tmp_path / "broken.icr"
    path.write_text(BROKEN)
    return path


def test_a_file_is_rewritten_in_place_and_then_left(ugly: Path) -> None:
    assert icarus(ugly) == (0, f"reformatted {ugly}\n1 file reformatted\n", "")
    assert ugly.read_text() == TIDY
    assert icarus(ugly) == (0, "1 file already formatted\n", "")


def test_a_file_that_is_formatted_is_not_written(tidy: Path) -> None:
    os.utime(tidy, (1, 1))
    assert icarus(tidy) == (0, "1 file already formatted\n", "")
    assert tidy.stat().st_mtime == 1


def test_check_writes_nothing_and_tells(ugly: Path, tidy: Path) -> None:
    said = f"would reformat {ugly}\n1 file would be reformatted, 1 file already formatted\n"
    assert icarus("--check", ugly, tidy) == (1, said, "")
    assert ugly.read_text() == UGLY
    assert icarus("--check", tidy)[0] == 0


def test_diff_shows_what_would_change(ugly: Path, tidy: Path) -> None:
    status, out, err = icarus(ugly, tidy, "--diff")
    assert (status, err) == (1, "1 file would be reformatted, 1 file already formatted\n")
    assert out == (
        f"--- {ugly}\n+++ {ugly} (formatted)\n@@ -1,3 +1,3 @@\n"
        "-(domain   d)\n-(goals (on a b)\n-   )\n+(domain d)\n+\n+(goals (on a b))\n"
    )
    assert ugly.read_text() == UGLY
    assert icarus(tidy, "--diff")[:2] == (0, "")


def test_diff_with_check_is_diff(ugly: Path) -> None:
    assert icarus(ugly, "--diff", "--check") == icarus(ugly, "--diff")


def test_a_missing_newline_at_the_end_shows_in_the_diff(tidy: Path) -> None:
    tidy.write_text(TIDY.rstrip())
    status, out, _ = icarus(tidy, "--diff")
    assert status == 1
    assert out.endswith("-(goals (on a b))\n\\ No newline at end of file\n+(goals (on a b))\n")


def test_windows_line_ends_and_a_byte_order_mark_are_a_change(tidy: Path) -> None:
    tidy.write_bytes(b"\xef\xbb\xbf" + TIDY.replace("\n", "\r\n").encode())
    status, out, _ = icarus(tidy, "--diff")
    assert status == 1
    assert "-(goals (on a b))\r\n+(domain d)\n" in out
    assert icarus(tidy)[0] == 0
    assert tidy.read_bytes() == TIDY.encode()


def test_a_file_with_errors_is_left_and_the_others_are_not(ugly: Path, broken: Path) -> None:
    status, out, err = icarus(broken, ugly)
    assert (status, out) == (2, f"reformatted {ugly}\n")
    assert err.startswith(f"{broken}:1:1: error[ICR002]: the form `goals` is never closed\n")
    assert broken.read_text() == BROKEN
    assert ugly.read_text() == TIDY


def test_what_only_the_checker_minds_is_formatted(ugly: Path) -> None:
    ugly.write_text('(include   "nowhere.icr")\n(concepts ((p ?x) :elements ((oh ?y))))')
    assert icarus(ugly)[0] == 0
    assert ugly.read_text() == (
        '(include "nowhere.icr")\n\n(concepts\n  ((p ?x) :elements ((oh ?y))))\n'
    )


def test_standard_input_is_formatted_to_standard_output() -> None:
    assert icarus("-", given=UGLY.encode()) == (0, TIDY, "1 file reformatted\n")
    assert icarus("-", given=TIDY.encode()) == (0, TIDY, "1 file already formatted\n")


def test_standard_input_can_be_checked() -> None:
    said = "would reformat <stdin>\n"
    assert icarus("-", "--check", given=UGLY.encode()) == (1, said, "1 file would be reformatted\n")


@pytest.mark.parametrize("given", [BROKEN.encode(), b"(goals \xff)", b"(goals \0)"])
def test_standard_input_with_errors_gives_no_text(given: bytes) -> None:
    status, out, err = icarus("-", given=given)
    assert (status, out) == (2, "")
    assert err.startswith("<stdin>:1:")
    assert "Traceback" not in err


def test_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    missing = tmp_path / "none.icr"
    assert icarus(missing) == (
        2,
        "",
        f"{missing}: the file cannot be read: no such file or directory\n",
    )
    assert icarus(tmp_path)[2] == f"{tmp_path}: the file cannot be read: is a directory\n"


def test_a_file_that_cannot_be_written(ugly: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "write_bytes", refuse)
    assert icarus(ugly) == (
        2,
        "",
        f"{ugly}: the file cannot be written: permission denied\n",
    )


def test_modernize_rewrites_older_names(ugly: Path) -> None:
    ugly.write_text("(create-concepts ((p ?x) :percepts ((o ?x))))\n")
    assert icarus(ugly, "--modernize")[0] == 0
    assert ugly.read_text() == "(concepts\n  ((p ?x) :elements ((o ?x))))\n"


def test_the_how_to_shows_what_happens(tmp_path: Path) -> None:
    page = PAGE.read_text(encoding="utf-8")
    example = re.findall(r"```lisp\n(.*?)```", page, re.DOTALL)[0]
    (tmp_path / "lamps.icr").write_text(example)
    for command, expected in re.findall(r"```console\n\$ icarus (.*?)\n(.*?)```", page, re.DOTALL):
        called = [sys.executable, "-m", "runtime.cli", *command.split()]
        done = subprocess.run(
            called, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
        )
        assert (done.returncode, done.stdout, done.stderr) == (0, expected, "")


def test_a_file_that_cannot_be_replaced_is_left_whole(
    ugly: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_self: Path, _target: Path) -> Path:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", fail)
    status, _, said = icarus(ugly)
    assert (status, ugly.read_text()) == (2, UGLY)
    assert "cannot be written: no space left on device" in said
    assert [path.name for path in ugly.parent.iterdir()] == [ugly.name]
