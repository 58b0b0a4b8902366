"""`icarus explain-rule`: plans, profiles, generated code, and what it is told wrongly."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from icarus_lite import Agent, Percept, load_domain
from icarus_lite.trace import TraceWriter, cycle_record, header
from runtime.cli import app
from runtime.errors import UsageError

GEARBOX = Path(__file__).parents[3] / "domains" / "gearbox.icr"
RUNNER = CliRunner()


def percepts(x: float) -> list[Percept]:
    return [
        Percept("hand", "h", {"reach": 0.8}),
        Percept("object", "plug", {"type": "plug", "x": x, "y": 0.0, "z": 0.0, "seen": "yes"}),
        Percept("object", "case", {"type": "case", "x": 0.3, "y": 0.0, "z": 0.0, "seen": "yes"}),
    ]


@pytest.fixture
def frames(tmp_path: Path) -> Path:
    path = tmp_path / "frames.jsonl"
    with path.open("w") as lines:
        for cycle, x in enumerate((0.31, 0.4, 0.32)):
            rows = [
                {"type": p.type, "name": p.name, "attributes": dict(p.attributes)}
                for p in percepts(x)
            ]
            lines.write(json.dumps({"cycle": cycle, "percepts": rows, "action": None}) + "\n")
    return path


@pytest.fixture
def trace(tmp_path: Path) -> Path:
    domain = load_domain(GEARBOX)
    agent = Agent(domain)
    path = tmp_path / "trace.jsonl"
    with TraceWriter(path, header(domain, ())) as writer:
        for x in (0.31, 0.4, 0.32):
            seen = percepts(x)
            writer.write(cycle_record(agent.cycle(seen), seen, ()))
    return path


def explain(*arguments: object) -> str:
    done = RUNNER.invoke(app, ["explain-rule", *map(str, arguments)])
    if done.exception is not None:
        raise done.exception
    return done.stdout


def test_every_clause_of_the_concept_and_no_other() -> None:
    out = explain(GEARBOX, "graspable")
    assert out.count("gearbox.icr:") == 5
    assert out.count("all rows at once") == 5
    assert "near" not in out


def test_the_text_of_the_clause_stands_above_its_plan() -> None:
    out = explain(GEARBOX, "free")
    assert "  ((free ?hand) :elements ((hand ?hand) (not (holding ?hand ?any))))" in out
    assert "kept: " in out
    assert "on a change of (hand ?hand): (not (holding ?hand ?any))" in out


@pytest.mark.parametrize("recording", ["frames", "trace"])
def test_rows_of_a_recording(recording: str, request: pytest.FixtureRequest) -> None:
    path = request.getfixturevalue(recording)
    document = json.loads(explain(GEARBOX, "near", "--frames", path, "--json"))
    (clause,) = document["clauses"]
    (step,) = clause["steps"]
    assert (document["cycles"], document["engine"]["cycles"]) == (3, 2)
    assert (step["rows_in"], step["rows_out"]) == (3, 4)  # near in two cycles of three, both ways
    assert clause["rows"] == 4
    assert 0 <= clause["engine_seconds"] <= document["engine"]["seconds"]
    assert document["slowest"]["place"].startswith(str(GEARBOX))
    text = explain(GEARBOX, "near", "--frames", path)
    assert "3 cycles: the first took the engine" in text
    assert "slowest clause of the domain: (" in text
    assert "its widest step is number 1: " in text


def test_without_frames_there_are_no_figures() -> None:
    document = json.loads(explain(GEARBOX, "carried", "--json"))
    assert "cycles" not in document
    assert "rows_in" not in document["clauses"][0]["steps"][0]
    assert [each["when"] for each in document["clauses"][1]["updates"]] == [
        "(attached ?obj ?parent)",
        "(carried ?parent ?hand)",
    ]


def test_the_generated_code_on_request() -> None:
    assert "def " not in explain(GEARBOX, "free")
    assert "  | def free_" in explain(GEARBOX, "free", "--source")
    (clause,) = json.loads(explain(GEARBOX, "free", "--source", "--json"))["clauses"]
    assert clause["source"].splitlines()[1] == f"# {GEARBOX}:20"


def test_an_unknown_concept_is_told_with_what_was_meant() -> None:
    with pytest.raises(UsageError, match="has no concept called nera; did you mean near"):
        explain(GEARBOX, "nera")
    with pytest.raises(UsageError, match="it has apart, at-rest-empty, by-hand, carried, empty"):
        explain(GEARBOX, "xyz")


def test_a_domain_without_concepts(tmp_path: Path) -> None:
    path = tmp_path / "empty.icr"
    path.write_text("(percepts (lamp))")
    with pytest.raises(UsageError, match="defines no concepts"):
        explain(path, "lit")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", r"frames.jsonl:1: is not JSON"),
        (
            (
                '{"cycle": 0, "percepts": [{"type": "hand", "name": "h"}, '
                '{"type": "hand", "name": "h"}]}'
            ),
            r"frames.jsonl:1: 2 percepts of type hand are named h",
        ),
        (
            (
                '{"cycle": 0, "percepts": [{"type": "hand", "name": "h", "attributes": '
                '{"reach": "far"}}, {"type": "object", "name": "o", "attributes": '
                '{"x": 1, "y": 1, "z": 1, "seen": "yes"}}]}'
            ),
            r"frames.jsonl:1: .*gearbox.icr:\d+:\d+: \?reach is the symbol far",
        ),
    ],
)
def test_what_is_wrong_with_the_frames_is_told_with_its_line(
    tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "frames.jsonl"
    path.write_text(text + "\n")
    with pytest.raises(ValueError, match=message):
        explain(GEARBOX, "near", "--frames", path)


def test_no_frames_at_all(tmp_path: Path) -> None:
    path = tmp_path / "frames.jsonl"
    path.write_text("")
    assert "0 cycles: there is nothing to measure" in explain(GEARBOX, "near", "--frames", path)
    with pytest.raises(ValueError, match="cannot be read"):
        explain(GEARBOX, "near", "--frames", tmp_path / "nowhere.jsonl")
