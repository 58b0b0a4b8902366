"""The how-to on slow clauses: its domain, its commands, and its advice, tried out."""

from __future__ import annotations

import json
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest

from icarus_lite import Percept
from icarus_lite.inference.network import compile_domain
from icarus_lite.inference.profiling import DomainProfile, DomainProfiler
from icarus_lite.language import diagnose_file, parse_domain

PAGE = (Path(__file__).parent.parent / "docs" / "how-to" / "find-a-slow-clause.md").read_text()
WHOLE, BETTER = re.findall(r"```lisp\n(.*?)```", PAGE, re.DOTALL)
READ, MEASURE = re.findall(r"```console\n(.*?)```", PAGE, re.DOTALL)
REWRITTEN = f"{WHOLE[: WHOLE.index('  ((row')]}{BETTER.rstrip()})\n"


def scenes() -> list[list[Percept]]:
    draw = random.Random(5)
    places = [(draw.randrange(100), draw.randrange(40)) for _ in range(26)]
    cycles = []
    for _ in range(4):
        moved = draw.randrange(0, len(places), 2)  # a red one
        places[moved] = (draw.randrange(100), draw.randrange(100))
        cycles.append(
            [
                Percept("thing", f"t{n}", {"x": x, "y": y, "color": ("red", "blue")[n % 2]})
                for n, (x, y) in enumerate(places)
            ]
        )
    return cycles


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "tidy.icr").write_text(WHOLE)
    with (tmp_path / "frames.jsonl").open("w") as lines:
        for number, percepts in enumerate(scenes()):
            rows = [
                {"type": p.type, "name": p.name, "attributes": dict(p.attributes)} for p in percepts
            ]
            frame = {"cycle": number, "percepts": rows, "action": None}
            lines.write(json.dumps(frame) + "\n")
    return tmp_path


def run(folder: Path, command: str) -> str:
    program, *arguments = command.removeprefix("$ ").split()
    assert program == "icarus"
    done = subprocess.run(
        [sys.executable, "-m", "runtime.cli", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def profiled(text: str) -> DomainProfile:
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    profiler = DomainProfiler(compile_domain(domain))
    for percepts in scenes():
        profiler.cycle(percepts)
    return profiler.result()


def widest(profile: DomainProfile, concept: str) -> int:
    clause = next(c for c in profile.clauses if c.plan.clause.head.predicate == concept)
    assert clause.widest is not None
    return clause.widest.rows_out


def test_both_domains_have_no_problems(folder: Path) -> None:
    for text in (WHOLE, REWRITTEN):
        (folder / "tidy.icr").write_text(text)
        _, _, found = diagnose_file(folder / "tidy.icr")
        assert [each for each in found if each.severity != "note"] == []


def test_the_plan_reads_as_shown(folder: Path) -> None:
    command, _, promised = READ.partition("\n")
    assert run(folder, command) == promised


def test_measuring_says_what_the_table_promises(folder: Path) -> None:
    out = run(folder, MEASURE.strip())
    for words in (
        "rows",
        "time",
        "a cycle, as the engine does it",
        "on a change of",
        "widest step",
    ):
        assert words in out
    assert "slowest clause of the domain: (row ?a ?b ?c) at tidy.icr:10" in out
    document = json.loads(run(folder, f"{MEASURE.strip()} --json"))
    assert document["slowest"]["place"] == "tidy.icr:10"


def test_the_advice_keeps_the_answer_and_narrows_the_join() -> None:
    before, after = profiled(WHOLE), profiled(REWRITTEN)
    rows = [
        next(c.rows for c in each.clauses if c.plan.clause.head.predicate == "row")
        for each in (before, after)
    ]
    assert rows[0] == rows[1] > 0
    assert widest(after, "row") < widest(before, "row") / 5
