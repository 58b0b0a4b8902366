"""What is withdrawn, and what is in doubt, on record: told, asked about, and gone on from."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from recorded_runs import STORE, record

from icarus_lite import Action, Agent, Outcome, Percept, TraceError
from icarus_lite.inference import Doubt, Withdrawal
from icarus_lite.language import parse_domain
from icarus_lite.symbols import Belief
from icarus_lite.trace import (
    Recording,
    TraceWriter,
    compare,
    cycle_record,
    header,
    inputs_of,
    pattern_of,
    replay,
    resumed_agent,
    tell,
    when,
)

PLUG = Belief("attached", ("plug", "case"))
CELL, _ = parse_domain("""
(domain cell)
(percepts (object ^x))
(concepts
  ((apart ?a ?b) :elements ((object ?a ^x ?xa) (object ?b ^x ?xb)) :tests ((> (- ?xb ?xa) 1))))
(skills ((insert ?o ?into) :elements ((object ?o) (object ?into)) :actions ((*insert ?o ?into))))
(attachments ((insert ?o ?into) :child ?o :parent ?into))
(contradictions ((attached ?o ?into) :elements ((apart ?o ?into)) :cycles 3))
""")
assert CELL is not None


@pytest.fixture
def taken_away(tmp_path: Path) -> Recording:
    """Record a run in which a part is inserted, and taken away by somebody in cycle 3."""
    agent, path = Agent(CELL, ["(attached plug case)"]), tmp_path / "run.jsonl"
    with TraceWriter(path, header(CELL, agent.goals)) as writer:
        for cycle in range(8):
            away = 3 <= cycle <= 6
            places = {"plug": 0, "case": 2 if away else 0}
            percepts = [Percept("object", name, {"x": x}) for name, x in places.items()]
            outcomes = [Outcome(Action("insert", ("plug", "case")))] if cycle in (1, 7) else []
            writer.write(cycle_record(agent.cycle(percepts, outcomes), percepts, outcomes))
    return Recording(path)


def test_a_line_has_what_is_in_doubt_and_what_was_withdrawn(taken_away: Recording) -> None:
    rows = [taken_away.record(cycle) for cycle in taken_away.cycles]
    doubts = {"belief": "(attached plug case)", "rule": 0, "limit": 3}
    assert [row.get("doubts") for row in rows] == [
        None, None, None, [{**doubts, "cycles": 1}], [{**doubts, "cycles": 2}], None, None, None,
    ]  # fmt: skip
    assert [row["cycle"] for row in rows if "withdrawn" in row] == [5]
    assert rows[5]["withdrawn"] == [
        {"belief": "(attached plug case)", "because": ["(apart plug case)"], "cycles": 3}
    ]
    assert rows[5]["removed"] == ["(attached plug case)"]
    assert rows[5]["goals"] == [{"goal": "(attached plug case)", "satisfied": False}]
    assert rows[5]["decision"]["action"] == "(insert plug case)"


def test_it_is_read_back_as_it_was(taken_away: Recording) -> None:
    withdrawal = Withdrawal(PLUG, ("(apart plug case)",), 3)
    assert taken_away.withdrawn(5) == (withdrawal,)
    assert taken_away.withdrawn(4) == ()
    assert taken_away.at(5).state.withdrawn == (withdrawal,)
    assert taken_away.at(4).state.doubts == (Doubt(0, PLUG, 2, 3),)
    assert list(taken_away.at(5).state.hierarchy.pairs()) == []


def test_every_question_knows_the_reason(taken_away: Recording) -> None:
    why = "because (apart plug case) held for 3 cycles"
    assert str(taken_away.at(6).why_not(PLUG)).splitlines()[-1] == (
        f"  (attached plug case) was believed in cycles 1 to 4; withdrawn in cycle 5, {why}"
    )
    assert str(taken_away.at(6).why(PLUG)).splitlines() == [
        "(attached plug case)  is not believed in cycle 6",
        f"  it was withdrawn in cycle 5, {why}",
    ]
    assert str(taken_away.at(4).why(PLUG)).splitlines() == [
        "(attached plug case)  because (insert plug case) succeeded, reported in cycle 1",
        "  it is in doubt: what contradicts it has held for 2 of 3 cycles",
    ]
    assert str(taken_away.at(7).why(PLUG)).splitlines() == [
        "(attached plug case)  because (insert plug case) succeeded, reported in cycle 7",
        "  it has been believed in cycles 1 to 4, from cycle 7 on",
        f"  it was withdrawn in cycle 5, {why}",
    ]
    assert taken_away.at(4).why(PLUG).withdrawn == ()  # that was still to come
    assert [str(each) for each in when(pattern_of("(attached plug ?p)"), taken_away)] == [
        "(attached plug case)  in cycles 1 to 4, from cycle 7 on"
    ]


def test_when_knows_what_ended_it_last(taken_away: Recording, tmp_path: Path) -> None:
    lines = taken_away_lines(taken_away)
    path = tmp_path / "short.jsonl"
    path.write_text("".join(lines[:8]))
    (times,) = when(pattern_of("(attached plug ?p)"), Recording(path))
    assert str(times) == (
        "(attached plug case)  in cycles 1 to 4; "
        "withdrawn in cycle 5, because (apart plug case) held for 3 cycles"
    )


def taken_away_lines(recording: Recording) -> list[str]:
    return Path(recording.path).read_text(encoding="utf-8").splitlines(keepends=True)


def test_documents_have_it_as_data(taken_away: Recording) -> None:
    told = {"cycle": 5, "because": ["(apart plug case)"], "cycles": 3}
    assert taken_away.at(6).why(PLUG).as_document()["withdrawn"] == [told]
    assert taken_away.at(4).why(PLUG).as_document()["doubts"] == [{"cycles": 2, "limit": 3}]
    compared = compare(taken_away.at(2), taken_away.at(6), taken_away)
    assert compared.as_document()["withdrawn"] == [{**told, "belief": "(attached plug case)"}]
    assert "withdrawn" not in compare(taken_away.at(2), taken_away.at(4), taken_away).as_document()


def test_diff_and_story_tell_it(taken_away: Recording) -> None:
    sentence = "(attached plug case) was withdrawn: (apart plug case) held for 3 cycles"
    for first, second in ((2, 6), (6, 2)):
        lines = str(compare(taken_away.at(first), taken_away.at(second), taken_away)).splitlines()
        assert f"  cycle 5: {sentence}" in lines
    assert f"  Cycle 5: {sentence}." in str(tell(taken_away)).splitlines()
    assert sentence in taken_away.record(5)["notes"]


def test_a_replay_notices_what_is_missing_or_different(taken_away: Recording) -> None:
    assert (
        str(replay(taken_away))
        == "8 cycles replayed: all beliefs are as recorded, and all decisions"
    )
    path, lines = Path(taken_away.path), taken_away_lines(taken_away)
    for line, key, change in (
        (5, "doubts", lambda row: row.pop("doubts")),
        (6, "withdrawn", lambda row: row.pop("withdrawn")),
        (3, "doubts", lambda row: row.update(doubts=[])),
        (8, "withdrawn", lambda row: row.update(withdrawn=[])),
    ):
        row = json.loads(lines[line])
        change(row)
        path.write_text("".join([*lines[:line], json.dumps(row) + "\n", *lines[line + 1 :]]))
        found = replay(Recording(path))
        assert found.beliefs is not None
        assert (found.beliefs.cycle, found.beliefs.key) == (line - 1, key)


@pytest.mark.parametrize(
    ("key", "row", "message"),
    [
        ("doubts", {"belief": "(p)", "rule": 0, "cycles": 1}, "missing required field `limit`"),
        ("doubts", {"belief": "p", "rule": 0, "cycles": 1, "limit": 2}, "'p' is not the text of"),
        ("withdrawn", {"belief": "(p)"}, "missing required field `because`"),
        ("withdrawn", {"belief": "p", "because": []}, "'p' is not the text of a belief"),
    ],
)
def test_damage_is_told(taken_away: Recording, key: str, row: object, message: str) -> None:
    path, lines = Path(taken_away.path), taken_away_lines(taken_away)
    changed = {**json.loads(lines[4]), key: [row]}
    path.write_text("".join([*lines[:4], json.dumps(changed) + "\n", *lines[5:]]))
    with pytest.raises(TraceError, match=message):
        Recording(path).at(3)


@pytest.mark.parametrize("seed", range(3))
def test_a_run_that_is_taken_up_goes_on_counting(tmp_path: Path, seed: int) -> None:
    whole = Recording(record(tmp_path / "whole.jsonl", seed, 60).path)
    rows = {cycle: whole.record(cycle) for cycle in whole.cycles}
    counting = [cycle for cycle, row in rows.items() if "doubts" in row][:-1]
    assert len(counting) > 8
    assert sum(any(w["cycles"] > 1 for w in row.get("withdrawn", ())) for row in rows.values()) > 1
    for after in counting[::4]:
        agent = resumed_agent(whole, before=after + 1)
        for cycle in range(after + 1, min(after + 5, 60)):
            percepts, outcomes = inputs_of(rows[cycle])
            again = json.loads(json.dumps(cycle_record(agent.cycle(percepts, outcomes), (), ())))
            for key in ("withdrawn", "doubts", "added", "removed"):
                assert again.get(key) == rows[cycle].get(key), (after, cycle, key)


def test_the_runs_of_the_other_tests_have_contradictions() -> None:
    assert len(STORE.contradictions) == 3
