from __future__ import annotations

import sys

import pytest
from gearbox import killing
from gearbox.killing import LineCounter, run_and_kill
from gearbox.trials import Trial

# Stands in for `icarus run`: writes so many lines, one after the other, then goes on or ends.
WRITER = """
import sys, time
path = sys.argv[sys.argv.index("--trace") + 1]
with open(path, "w") as trace:
    for number in range({lines}):
        trace.write("{{}}\\n")
        trace.flush()
        time.sleep(0.01)
    time.sleep({lingers})
"""


def test_lines_are_counted_as_they_come(tmp_path):
    path = tmp_path / "trace.jsonl"
    counter = LineCounter(path)
    assert counter.count() == 0
    path.write_text("one\ntwo\nthr")
    assert counter.count() == 2
    with path.open("a") as file:
        file.write("ee\n")
    assert counter.count() == 3
    assert counter.count() == 3


@pytest.fixture
def program(monkeypatch, tmp_path):
    def program(lines, lingers):
        script = tmp_path / "writer.py"
        script.write_text(WRITER.format(lines=lines, lingers=lingers))
        real = killing.subprocess.Popen

        def popen(words, **options):
            assert words[1:4] == ["-m", "runtime.cli", "run"]
            return real([sys.executable, str(script), *words[5:]], **options)

        monkeypatch.setattr(killing.subprocess, "Popen", popen)
        return tmp_path / "trace.jsonl"

    return program


def kill(trace, cycles, within_s=30.0):
    return run_and_kill(Trial("1.1", 0), trace, trace, "127.77.8.2", cycles, within_s)


def test_it_is_killed_after_its_cycles(program):
    trace = program(lines=2000, lingers=0)
    assert kill(trace, 5)
    # The header and five cycles at least, and little more than what comes between two looks.
    assert 6 <= trace.read_text().count("\n") < 200


def test_a_run_that_is_over_before_was_not_killed(program):
    trace = program(lines=3, lingers=0)
    assert not kill(trace, 50)
    assert trace.read_text().count("\n") == 3


def test_a_run_that_does_not_come_so_far_is_killed_in_the_end(program):
    trace = program(lines=3, lingers=600)
    assert kill(trace, 50, within_s=1.0)
