from __future__ import annotations

import json
from pathlib import Path

import pytest

from icarus_lite import Action, Agent, Outcome, Percept, TraceError, load_domain
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.trace import TraceWriter, cycle_record, header, inputs_of, read_trace, stream_trace

DOMAIN, _ = parse_domain(
    """(domain lamps) (percepts (lamp ^lit))
(concepts ((dark ?l) :elements ((lamp ?l ^lit no))) ((lit ?l) :elements ((lamp ?l ^lit yes))))
(skills ((switch ?l) :elements ((dark ?l)) :actions ((*press ?l)) :effects ((lit ?l))))""",
    "lamps.icr",
)
FRAMES: tuple[tuple[list[Percept], list[Outcome]], ...] = (
    ([Percept("lamp", "l1", {"lit": "no"})], []),
    ([Percept("lamp", "l1", {"lit": "yes"})], [Outcome(Action("switch", ("l1",)))]),
)


def record(path: Path) -> Path:
    agent = Agent(DOMAIN, ["(lit l1)"])
    with TraceWriter(path, header(DOMAIN, agent.goals, seed=7)) as writer:
        for percepts, outcomes in FRAMES:
            decision = agent.cycle(percepts, outcomes)
            writer.write(cycle_record(decision, percepts, outcomes, timings={"look_s": 0.1}))
    return path


def test_what_was_written_is_read(tmp_path: Path) -> None:
    trace = read_trace(record(tmp_path / "deep" / "run.jsonl"))
    assert trace.header["seed"] == 7
    assert trace.header["goals"] == ["(lit l1)"]
    assert trace.header["domain"]["text"] == DOMAIN.source.text
    assert [c["cycle"] for c in trace.cycles] == [0, 1]
    first, second = trace.cycles
    assert first["decision"] == {
        "kind": "act",
        "action": "(switch l1)",
        "commands": ["(press l1)"],
        "reason": "(lit l1) → (switch l1)",
    }
    assert first["added"] == [
        {
            "belief": "(dark l1)",
            "supports": [
                {
                    "concept": "(dark ?l)",
                    "line": 2,
                    "because": ["(lamp l1)"],
                    "absent": [],
                }
            ],
        }
    ]
    assert second["removed"] == ["(dark l1)"]
    assert second["goals"] == [{"goal": "(lit l1)", "satisfied": True}]
    assert trace.warning == ""


def test_the_header_holds_included_files_too(tmp_path: Path) -> None:
    (tmp_path / "main.icr").write_text('(include "lamps.icr")\n(goals (dark l1))\n')
    (tmp_path / "lamps.icr").write_text(
        "(percepts (lamp ^lit))\n(concepts ((dark ?l) :elements ((lamp ?l ^lit no))))\n"
    )
    told = header(load_domain(tmp_path / "main.icr"), [])["domain"]
    assert [Path(row["path"]).name for row in told["included"]] == ["lamps.icr"]
    assert "(dark ?l)" in told["included"][0]["text"]


def test_each_cycle_is_on_disk_before_the_next(tmp_path: Path) -> None:
    path = tmp_path / "run.jsonl"
    writer = TraceWriter(path, header(DOMAIN, []))
    writer.write({"cycle": 0})
    assert len(path.read_bytes().splitlines()) == 2
    writer.close()


def test_a_trace_whose_last_line_is_cut_off_still_opens(tmp_path: Path) -> None:
    path = record(tmp_path / "run.jsonl")
    path.write_bytes(path.read_bytes()[:-20])
    trace = read_trace(path)
    assert [c["cycle"] for c in trace.cycles] == [0]
    assert "run.jsonl:3: the last line was cut off" in trace.warning


def test_damage_in_the_middle_is_an_error_with_its_line(tmp_path: Path) -> None:
    path = record(tmp_path / "run.jsonl")
    lines = path.read_bytes().splitlines()
    path.write_bytes(b"\n".join([lines[0], b"{", lines[2]]))
    with pytest.raises(TraceError, match=r"run.jsonl:2: is not a line of a trace"):
        read_trace(path)


@pytest.mark.parametrize(
    ("first", "message"),
    [
        ("", "no header"),
        ('{"cycle": 0}\n', "no header"),
        ('{"format": "icarus-trace", "version": 99}\n', "version 99; this icarus reads version 2"),
    ],
)
def test_a_foreign_file_is_told_apart(tmp_path: Path, first: str, message: str) -> None:
    path = tmp_path / "run.jsonl"
    path.write_text(first)
    with pytest.raises(TraceError, match=message):
        read_trace(path)


def test_a_trace_is_read_line_by_line_while_it_is_written(tmp_path: Path) -> None:
    path = record(tmp_path / "run.jsonl")
    whole = read_trace(path)
    assert list(stream_trace(path)) == [whole.header, *whole.cycles]
    path.write_bytes(path.read_bytes()[:-20])
    assert list(stream_trace(path)) == [whole.header, whole.cycles[0]]
    path.write_text('{"cycle": 0}\n')
    with pytest.raises(TraceError, match="no header"):
        list(stream_trace(path))
    with pytest.raises(TraceError, match="cannot be read"):
        list(stream_trace(tmp_path / "nowhere.jsonl"))


def test_a_recorded_trace_replays_to_the_same_bytes(tmp_path: Path) -> None:
    trace = read_trace(record(tmp_path / "run.jsonl"))
    agent = Agent(DOMAIN, trace.header["goals"])
    for recorded in trace.cycles:
        percepts, outcomes = inputs_of(recorded)
        again = cycle_record(agent.cycle(percepts, outcomes), percepts, outcomes)
        kept = {key: value for key, value in recorded.items() if key != "timings"}
        assert json.dumps(again) == json.dumps(kept)


def test_a_folder_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(TraceError, match="cannot be written"):
        TraceWriter(tmp_path / "file" / "run.jsonl", {})
