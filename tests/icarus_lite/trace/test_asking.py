from __future__ import annotations

import ast

import pytest
from recorded_runs import Run, record

from icarus_lite import DomainError, FrameError
from icarus_lite.symbols import format_value
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


@pytest.mark.parametrize("asked", ["marked", "mark"])
def test_when_something_was_believed_with_an_attribute(
    run: Run, recording: Recording, asked: str
) -> None:
    told = when(pattern_of(f"({asked} ?t ^colour ?c)"), recording)
    assert len({times.fact.split("^")[0] for times in told}) < len(told), "colours change"
    for cycle, believed in enumerate(run.believed):
        coloured = {
            f"{text[:-1]} ^colour {format_value(ast.literal_eval(attributes)[0][1])})"
            for text, attributes in believed.items()
            if text.startswith(f"({asked} ")
        }
        assert coloured == {t.fact for t in told if in_some(t.periods, cycle)}


def test_when_with_the_value_of_an_attribute(recording: Recording) -> None:
    told = when(pattern_of("(marked ?t ^colour red)"), recording)
    assert told
    assert all(times.fact.endswith("^colour red)") for times in told)
    assert when(pattern_of("(marked ?t ^colour green)"), recording) == ()


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


def test_a_belief_that_is_still_held_but_otherwise(run: Run, recording: Recording) -> None:
    """What is asserted anew may come with other attributes."""
    differ = 0
    for cycle in range(20, len(run.believed), 3):
        before, after = run.believed[cycle - 20], run.believed[cycle]
        expected = {text for text in before if before[text] != after.get(text, before[text])}
        found = compare(recording.at(cycle - 20), recording.at(cycle), recording)
        assert {c.name for c in found.changed if c.name.startswith("(")} == expected
        differ += len(expected)
        for text in expected:
            assert f"\n  {text}: ^colour " in str(found)
    assert differ


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
