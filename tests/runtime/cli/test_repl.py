"""`icarus repl` from a pipe, and how it is started wrongly."""

from __future__ import annotations

from pathlib import Path

import pytest
from recorded_runs import record
from typer.testing import CliRunner, Result

from icarus_lite import TraceError
from runtime.cli import app
from runtime.errors import UsageError

GEARBOX = Path(__file__).parents[3] / "domains" / "gearbox.icr"


def repl(*arguments: object, typed: str = "") -> Result:
    done = CliRunner().invoke(app, ["repl", *map(str, arguments)], input=typed)
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done


def test_commands_from_a_pipe_read_like_a_session(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=4, cycles=12)
    done = repl(run.path, typed="goto 5\n\nwhen (stored old)\n")
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0] == "run.jsonl 11> goto 5"
    assert "run.jsonl 5> when (stored old)" in lines
    assert lines[-1] == "(stored old)  from cycle 0 on"


def test_a_line_that_cannot_be_answered_makes_the_status_2(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=4, cycles=12)
    done = repl(run.path, typed="goto 99\nwhere\n")
    assert done.exit_code == 2
    assert "has no cycle 99" in done.stdout
    assert "looking at cycle 11" in done.stdout


def test_a_cut_off_trace_opens_with_a_warning(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=4, cycles=12)
    run.path.write_bytes(run.path.read_bytes()[:-20])
    done = repl(run.path, typed="where\n")
    assert "the last line was cut off" in done.stderr
    assert "looking at cycle 10" in done.stdout


def test_a_domain_with_a_goal() -> None:
    done = repl(GEARBOX, "--goal", "((free hand1))", typed="percept (hand hand1)\nstep\ngoal\n")
    assert "achieved: all goals are believed" in done.stdout
    assert "achieved  (free hand1)" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (("nowhere.jsonl",), TraceError, "cannot be read"),
        ((GEARBOX, "--task", "9.9"), UsageError, "has no task 9.9"),
        ((GEARBOX, "--task", "1.1", "--goal", "((free hand1))"), UsageError, "say what to pursue"),
        ((GEARBOX, "--cell"), UsageError, "say which task"),
    ],
)
def test_a_wrong_start(arguments: tuple[object, ...], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        repl(*arguments)
