from __future__ import annotations

import pytest
from recorded_runs import Run, record

from icarus_lite import DomainError, FrameError
from icarus_lite.trace import Recording, compare, matching, pattern_of, when


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return record(tmp_path_factory.mktemp("run") / "run.jsonl", seed=5, cycles=150)


@pytest.fixture
def recording(run: Run) -> Recording:
    return Recording(run.path)


def in_some(periods: object, cycle: int) -> bool:
    return any(p.first <= cycle and (p.last is None or cycle <= p.last) for p in periods)


@pytest.mark.parametrize("asked", ["(attached ?a ?b)", "(small ?t)", "(inside ?x a)", "(free h)"])
def test_when_is_true_in_every_cycle(recording: Recording, asked: str) -> None:
    pattern = pattern_of(asked)
    told = {times.fact: times.periods for times in when(pattern, recording)}
    assert told
    for cycle in recording.cycles:
        found = {str(fact) for fact, _ in matching(pattern, recording.at(cycle))}
        assert found == {fact for fact, periods in told.items() if in_some(periods, cycle)}


def test_when_an_object_was_perceived_with_an_attribute(recording: Recording) -> None:
    told = when(pattern_of("(thing c ^seen ?s)"), recording)
    assert {times.fact for times in told} == {"(thing c ^seen yes)", "(thing c ^seen no)"}
    for cycle, percepts in recording.percepts():
        seen = {str(p.attributes["seen"]) for p in percepts if p.name == "c"}
        assert seen == {t.fact[-4:-1].strip() for t in told if in_some(t.periods, cycle)}


def test_when_says_what_ended_it(recording: Recording) -> None:
    told = [t for t in when(pattern_of("(attached ?a ?b)"), recording) if t.ended]
    assert any("reported in cycle" in times.ended for times in told)
    assert any("was no longer perceived in cycle" in times.ended for times in told)


def test_never(recording: Recording) -> None:
    assert when(pattern_of("(attached h ?x)"), recording) == ()


def test_variables_are_bound(recording: Recording) -> None:
    found = matching(pattern_of("(thing ?t ^size ?s)"), recording.at(7))
    assert [dict(bound) for _, bound in found]
    for fact, bound in found:
        assert bound == {"?t": fact.args[0], "?s": fact.attributes["size"]}


def test_comparing_two_cycles(run: Run, recording: Recording) -> None:
    found = compare(recording.at(10), recording.at(60), recording)
    first, second = set(run.believed[10]), set(run.believed[60])
    assert {str(b) for b in found.added} == second - first
    assert {str(b) for b in found.removed} == first - second
    assert all(10 < cycle <= 60 for cycle, _ in found.actions)
    back = compare(recording.at(60), recording.at(10), recording)
    assert (back.added, back.removed) == (found.removed, found.added)
    assert [(c.after, c.before) for c in back.changed] == [
        (c.before, c.after) for c in found.changed
    ]


def test_a_cycle_beside_itself(recording: Recording) -> None:
    found = compare(recording.at(9), recording.at(9), recording)
    assert not found.is_different
    assert str(found) == "from cycle 9 to cycle 9\n  nothing has changed"


def test_what_is_no_pattern() -> None:
    with pytest.raises(DomainError, match="<question>:1:1"):
        pattern_of("(attached ?x")
    with pytest.raises(FrameError, match="expected one pattern"):
        pattern_of("((attached ?x a) (free h))")
    with pytest.raises(FrameError, match="expected one pattern"):
        pattern_of("(not (free h))")


def test_text_of_a_comparison(recording: Recording) -> None:
    text = str(compare(recording.at(0), recording.at(149), recording))
    assert text.startswith("from cycle 0 to cycle 149\n  cycle ")
    assert "\n  h: " not in text  # its reach never changes
    assert " ^size " in text
