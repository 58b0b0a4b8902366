from __future__ import annotations

from collections import Counter

import pytest
from gearbox import command
from gearbox.faults import KINDS
from gearbox.rows import Ending, Row, RowFile, read_rows
from gearbox.trials import NO_FAULT, TASKS, Trial


def ended(trial, ending=Ending.ACHIEVED, **more):
    good = ending is Ending.ACHIEVED
    return Row(trial, ending, achieved=good, true=good, reason="as it was", **more)


@pytest.fixture
def ran(monkeypatch):
    """What would be run, without running it."""
    found = []

    def run_all(wanted, _desk, _jobs, _limit_s):
        found.extend(wanted)
        for trial in wanted:
            yield ended(trial)

    monkeypatch.setattr(command, "run_all", run_all)
    monkeypatch.setattr(command, "code_digest", lambda: "now")
    return found


@pytest.fixture
def call(tmp_path):
    rows = tmp_path / "rows.jsonl"

    def call(*words):
        return command.main([*words, "--rows", str(rows), "--traces", str(tmp_path / "traces")])

    call.rows = rows
    return call


def test_the_whole_experiment_is_what_was_asked_for():
    wanted = command.whole()
    assert len({trial.key for trial in wanted}) == len(wanted)
    calm = Counter(
        (t.task, t.attachments) for t in wanted if t.fault == NO_FAULT and t.clock == 10.0
    )
    assert calm == {(task, side): 50 for task in TASKS for side in (True, False)}
    struck = Counter((t.task, t.fault) for t in wanted if t.fault != NO_FAULT and t.clock == 10.0)
    for name, kind in KINDS.items():
        for task in TASKS:
            due = name != NO_FAULT and (not kind.tasks or task in kind.tasks)
            assert struck[task, name] == (10 if due else 0)
    assert {t.task for t in wanted if t.clock == 1.0} == set(TASKS)


def test_what_has_a_row_is_not_run_again(ran, call):
    assert call("--tasks", "1.1", "--seeds", "2", "--attachments", "with") == 0
    assert [trial.seed for trial in ran] == [0, 1]
    ran.clear()
    assert call("--tasks", "1.1,1.2", "--seeds", "3", "--attachments", "with") == 0
    assert [(trial.task, trial.seed) for trial in ran] == [
        ("1.2", 0),
        ("1.2", 1),
        ("1.1", 2),
        ("1.2", 2),
    ]
    assert len(read_rows(call.rows)) == 6


def test_an_interrupted_experiment_goes_on(monkeypatch, ran, call, capsys):
    whole = command.run_all

    def interrupted(wanted, *others):
        yield next(whole(wanted, *others))
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "run_all", interrupted)
    asked = ("--tasks", "1.1", "--seeds", "3", "--attachments", "with")
    assert call(*asked) == 130
    assert "the same command goes on" in capsys.readouterr().err
    monkeypatch.setattr(command, "run_all", whole)
    ran.clear()
    assert call(*asked) == 0
    assert [trial.seed for trial in ran] == [1, 2]


def test_bad_and_stale_rows_are_run_again_if_asked(ran, call):
    kept = RowFile(call.rows)
    kept.add(ended(Trial("1.1", 0), code="now"))
    kept.add(ended(Trial("1.1", 1), code="before"))
    kept.add(ended(Trial("1.1", 2), Ending.BROKEN, code="now"))
    asked = ("--tasks", "1.1", "--seeds", "3", "--attachments", "with")
    assert call(*asked) == 1
    assert ran == []
    call(*asked, "--redo-stale")
    assert [trial.seed for trial in ran] == [1]
    ran.clear()
    assert call(*asked, "--redo-broken") == 0
    assert [trial.seed for trial in ran] == [2]


@pytest.mark.parametrize(
    ("row", "status"),
    [
        (ended(Trial("1.1", 0)), 0),
        (ended(Trial("1.1", 0), Ending.FAILED), 0),
        (ended(Trial("1.1", 0), Ending.MISNAMED), 1),
        (ended(Trial("1.1", 0, attachments=False), Ending.FALSE), 0),
        (ended(Trial("1.1", 0, attachments=False), Ending.BROKEN), 1),
        (ended(Trial("1.1", 0, attachments=False), unsafe=("moved",)), 1),
    ],
)
def test_the_status_says_whether_a_run_ended_as_none_must(ran, call, row, status):
    RowFile(call.rows).add(row)
    assert call("--page-only") == status
    assert ran == []


def test_the_page_is_made_of_what_there_is(ran, call, tmp_path):
    call("--tasks", "1.1", "--seeds", "1")
    page = tmp_path / "results" / "page.md"
    assert call("--page-only", "--out", str(page)) == 0
    assert "1.1 Attach hub cover to case" in page.read_text()
    assert (page.parent / "gearbox-tasks.svg").exists()
    assert len(ran) == 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--tasks", "1.7"], "there is no '1.7'; there are 1.1, 1.2"),
        (["--faults", "jam,gremlins"], "there is no 'gremlins'; there are none, protective_stop"),
        (["--jobs", "0"], "--jobs and --seeds take 1 or more"),
        (["--clock", "0"], "--clock more than 0 and up to 100"),
    ],
)
def test_what_there_is_not_is_told(capsys, words, said):
    with pytest.raises(SystemExit) as ended_with:
        command.main(words)
    assert ended_with.value.code == 2
    assert said in capsys.readouterr().err


def test_all_faults_are_all_but_none(ran, call):
    call("--tasks", "1.3", "--seeds", "1", "--faults", "all", "--attachments", "with")
    assert [trial.fault for trial in ran] == [name for name in KINDS if name != NO_FAULT]
