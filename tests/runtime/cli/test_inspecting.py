"""`icarus why`, `why-not`, `when`, `diff` and `replay`, from the shell."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from recorded_runs import Run, record
from typer.testing import CliRunner, Result

from icarus_lite import DomainError, FrameError, TraceError
from runtime.cli import app

RUNNER = CliRunner()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return record(tmp_path_factory.mktemp("run") / "run.jsonl", seed=3, cycles=120, explained=True)


def icarus(*arguments: object) -> Result:
    done = RUNNER.invoke(app, [*map(str, arguments)])
    if done.exception is not None and not isinstance(done.exception, SystemExit):
        raise done.exception
    return done


def a_cycle_with(run: Run, start: str) -> tuple[int, str]:
    return next(
        (cycle, belief)
        for cycle, believed in enumerate(run.believed)
        for belief in believed
        if belief.startswith(start)
    )


def test_why_at_a_cycle(run: Run) -> None:
    cycle, belief = a_cycle_with(run, "(inside")
    done = icarus("why", run.path, belief, "--cycle", cycle)
    assert done.exit_code == 0
    assert done.stdout == run.whys[cycle][belief] + "\n"


def test_why_of_all_that_match(run: Run) -> None:
    done = icarus("why", run.path, "(small ?t)", "--cycle", 40, "--json")
    told = json.loads(done.stdout)
    small = [belief for belief in run.believed[40] if belief.startswith("(small")]
    assert [answer["nodes"][0]["belief"] for answer in told["answers"]] == small
    assert (told["cycle"], done.exit_code) == (40, 0 if small else 1)


def test_why_of_what_is_not_believed_says_why_not(run: Run) -> None:
    done = icarus("why", run.path, "(small h)")
    assert done.exit_code == 1
    assert "(small h) is not believed in cycle 119" in done.stdout


def test_why_not(run: Run) -> None:
    done = icarus("why-not", run.path, "(small h)", "--cycle", 3)
    assert (done.exit_code, done.stdout.splitlines()[0]) == (
        0,
        "(small h) is not believed in cycle 3",
    )
    cycle, belief = a_cycle_with(run, "(small")
    assert icarus("why-not", run.path, belief, "--cycle", cycle).exit_code == 1
    told = json.loads(icarus("why-not", run.path, "(take h ?t)", "--json").stdout)
    assert (told["kind"], told["cycle"]) == ("skill", 119)


def test_when(run: Run) -> None:
    told = json.loads(icarus("when", run.path, "(stored old)", "--json").stdout)
    assert told["answers"] == [{"fact": "(stored old)", "periods": [[0, None]], "ended": ""}]
    done = icarus("when", run.path, "(stored nothing)")
    assert (done.exit_code, done.stdout) == (
        1,
        "nothing that matches (stored nothing) was ever believed or perceived\n",
    )


def test_diff(run: Run) -> None:
    told = json.loads(icarus("diff", run.path, 4, 30, "--json").stdout)
    assert set(told["added"]) == run.believed[30].keys() - run.believed[4].keys()
    assert icarus("diff", run.path, 4, 4).stdout.endswith("nothing has changed\n")


def test_replay(run: Run, tmp_path: Path) -> None:
    assert icarus("replay", run.path).stdout.startswith("120 cycles replayed: all beliefs")
    path = tmp_path / "other.jsonl"
    path.write_text(run.path.read_text().replace("(< ?s 5)", "(< ?s 3)"))
    done = icarus("replay", path, "--json")
    assert done.exit_code == 1
    assert json.loads(done.stdout)["beliefs"]["key"] in ("added", "removed")


def test_a_trace_that_was_cut_off_is_used_with_a_warning(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "cut.jsonl"
    path.write_bytes(run.path.read_bytes()[:-30])
    done = icarus("when", path, "(stored old)")
    assert done.exit_code == 0
    assert "cut.jsonl:121: the last line was cut off and is left out" in done.stderr


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        (("why", "RUN", "(small"), DomainError, "never closed"),
        (("why", "RUN", "(small a)", "--cycle", "500"), TraceError, "has no cycle 500"),
        (("diff", "RUN", "0", "500"), TraceError, "has no cycle 500"),
        (("when", "RUN", "(not (small a))"), FrameError, "expected one pattern"),
        (("replay", "nowhere.jsonl"), TraceError, "cannot be read"),
    ],
)
def test_what_cannot_be_asked(
    run: Run, arguments: tuple[str, ...], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message):
        icarus(*(str(run.path) if each == "RUN" else each for each in arguments))
