from __future__ import annotations

import json
import random
from pathlib import Path

import pytest
from recorded_runs import Run, attributes, record

from icarus_lite import TraceError
from icarus_lite.trace import Recording
from icarus_lite.trace.ground_text import parse_belief


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return record(tmp_path_factory.mktemp("run") / "run.jsonl", seed=3, cycles=200, explained=True)


@pytest.mark.parametrize("seed", range(6))
def test_each_cycle_is_believed_again_as_it_was(tmp_path: Path, seed: int) -> None:
    run = record(tmp_path / "run.jsonl", seed, cycles=80)
    recording = Recording(run.path)
    order = list(recording.cycles)
    random.Random(seed).shuffle(order)
    for cycle in order:
        instant = recording.at(cycle)
        facts = instant.state.facts()
        believed = {str(b): attributes(facts, b) for b in instant.state.beliefs}
        assert believed == run.believed[cycle], cycle


def test_why_says_the_same_as_the_agent_did(run: Run) -> None:
    recording = Recording(run.path)
    for cycle in (0, 17, 63, 64, 65, 128, 199, 100, 3):
        instant = recording.at(cycle)
        for belief, text in run.whys[cycle].items():
            assert str(instant.why(parse_belief(belief))) == text


def test_an_instant_stays_what_it_is_when_another_is_gone_to(run: Run) -> None:
    recording = Recording(run.path)
    early, late = recording.at(20), recording.at(150)
    assert [str(b) for b in early.state.beliefs] == sorted(run.believed[20])
    assert [str(b) for b in late.state.beliefs] == sorted(run.believed[150])
    for belief in early.state.beliefs:
        assert early.why(belief).holds


def test_changes_add_up_to_what_is_believed(run: Run) -> None:
    recording, held = Recording(run.path), set()
    for cycle in recording.cycles:
        added, removed = recording.changes(cycle)
        assert held.issuperset(removed)
        assert held.isdisjoint(added)
        held = (held - set(removed)) | set(added)
        assert {str(b) for b in held} == set(run.believed[cycle])


def test_a_cycle_that_is_not_there(run: Run) -> None:
    with pytest.raises(TraceError, match=r"run.jsonl: has no cycle 200: its cycles are 0 to 199"):
        Recording(run.path).at(200)
    with pytest.raises(TraceError, match="has no cycle -1"):
        Recording(run.path).record(-1)


def test_a_run_of_no_cycles(tmp_path: Path, run: Run) -> None:
    path = tmp_path / "empty.jsonl"
    path.write_bytes(run.path.read_bytes().splitlines(keepends=True)[0])
    recording = Recording(path)
    assert len(recording) == 0
    with pytest.raises(TraceError, match="has no cycles"):
        recording.at(0)


def test_at_any_place_that_a_trace_is_cut_off_what_stands_before_is_told(
    tmp_path: Path, run: Run
) -> None:
    whole = run.path.read_bytes()
    first = whole.index(b"\n") + 1
    path = tmp_path / "cut.jsonl"
    for end in random.Random(1).sample(range(first, len(whole)), 60):
        path.write_bytes(whole[:end])
        recording = Recording(path)
        count = whole[:end].count(b"\n") - 1
        assert len(recording) in (count, count + 1)  # the line's end alone may be missing
        assert bool(recording.warning) is (
            whole[:end].rpartition(b"\n")[2] != b"" and len(recording) == count
        )


DAMAGES = {
    "not an object": (lambda _row: [1], "is not a line of a trace: Expected `object`"),
    "no cycle": (lambda row: _without(row, "cycle"), "missing required field `cycle`"),
    "no asserted": (lambda row: _without(row, "asserted"), "missing required field `asserted`"),
    "a wrong name": (
        lambda row: row | {"percepts": [{"type": "thing", "name": 3}]},
        r"`\$.percepts\[0\].name`",
    ),
    "a belief that is none": (
        lambda row: row | {"removed": ["nonsense"]},
        "'nonsense' is not the text of a belief",
    ),
    "out of order": (lambda row: row | {"cycle": 1}, 'key "cycle": 1 comes after 3'),
    "a wrong status": (
        lambda row: row | {"outcomes": [{"name": "take", "args": [], "status": "odd"}]},
        "Invalid enum value 'odd'",
    ),
}


def _without(row: dict[str, object], key: str) -> dict[str, object]:
    return {name: value for name, value in row.items() if name != key}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damage_is_told_with_line_and_key(tmp_path: Path, run: Run, damage: str) -> None:
    change, message = DAMAGES[damage]
    lines = run.path.read_text().splitlines()
    lines[5] = json.dumps(change(json.loads(lines[5])))
    path = tmp_path / "run.jsonl"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(TraceError, match=f"run.jsonl:6: .*{message}"):
        Recording(path)


def test_bytes_that_are_no_text(tmp_path: Path, run: Run) -> None:
    lines = run.path.read_bytes().splitlines()
    lines[2] = b'{"cycle": "\xff"}'
    path = tmp_path / "run.jsonl"
    path.write_bytes(b"\n".join(lines) + b"\n")
    with pytest.raises(TraceError, match=r"run.jsonl:3: is not a line of a trace"):
        Recording(path)


@pytest.mark.parametrize(
    ("first", "message"),
    [
        (b"", "first line is no header"),
        (b"\x00\x01\n", "first line is no header"),
        (b'{"cycle": 0}\n', "first line is no header"),
        (b'{"format": "icarus-trace", "version": 99}\n', "of version 99; this icarus reads"),
    ],
)
def test_another_file(tmp_path: Path, first: bytes, message: str) -> None:
    path = tmp_path / "run.jsonl"
    path.write_bytes(first)
    with pytest.raises(TraceError, match=message):
        Recording(path)
    with pytest.raises(TraceError, match="cannot be read"):
        Recording(tmp_path / "nowhere.jsonl")


def test_a_domain_in_the_header_that_cannot_be_read(tmp_path: Path, run: Run) -> None:
    lines = run.path.read_text().splitlines()
    header = json.loads(lines[0])
    header["domain"]["text"] = "(concepts"
    path = tmp_path / "run.jsonl"
    path.write_text("\n".join([json.dumps(header), *lines[1:]]) + "\n")
    recording = Recording(path)  # what needs no domain can be asked all the same
    assert len(recording) == 200
    with pytest.raises(TraceError, match=r"(?s)a domain that this icarus cannot read.*ICR002"):
        recording.at(0)


def test_the_files_that_a_domain_includes_need_not_be_there_any_more(tmp_path: Path) -> None:
    from icarus_lite import Agent, Percept, load_domain  # noqa: PLC0415
    from icarus_lite.trace import TraceWriter, cycle_record, header  # noqa: PLC0415

    main, other = tmp_path / "main.icr", tmp_path / "lamps.icr"
    main.write_text('(include "lamps.icr")\n(goals (dark l1))\n')
    other.write_text(
        "(percepts (lamp ^lit))\n(concepts ((dark ?l) :elements ((lamp ?l ^lit no))))\n"
    )
    domain = load_domain(main)
    agent, path = Agent(domain), tmp_path / "run.jsonl"
    with TraceWriter(path, header(domain, ())) as writer:
        seen = [Percept("lamp", "l1", {"lit": "no"})]
        writer.write(cycle_record(agent.cycle(seen), seen, ()))
    main.unlink()
    other.unlink()
    assert [str(b) for b in Recording(path).at(0).state.beliefs] == ["(dark l1)"]


def test_nothing_later_is_known_at_a_cycle(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=11, cycles=60)
    whole = Recording(run.path)
    lines = run.path.read_bytes().splitlines(keepends=True)
    for cycle in (5, 20, 40):
        part = tmp_path / f"until-{cycle}.jsonl"
        part.write_bytes(b"".join(lines[: cycle + 2]))
        then, now = Recording(part).at(cycle), whole.at(cycle)
        asked = [
            "(attached ?a ?b)",
            "(taken ?x)",
            "(free h)",
            "(take h ?t)",
            "(mark b)",
            "(small c)",
        ]
        for each in asked:
            assert str(then.why_not(each)) == str(now.why_not(each))
        for belief in now.state.beliefs:
            assert str(then.why(belief)) == str(now.why(belief))
