from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from icarus_lite import Action, FrameError, Outcome, Percept, Status
from icarus_lite.trace import beliefs_line, read_frames

GOOD = {
    "cycle": 0,
    "percepts": [{"type": "object", "name": "o1", "attributes": {"type": "plug", "x": 0.31}}],
    "action": {"name": "pick-up", "args": ["hand1", "o1"], "status": "succeeded"},
    "weather": "kept, not an error",
}


def write(path: Path, *lines: object) -> Path:
    text = "\n".join(line if isinstance(line, str) else json.dumps(line) for line in lines)
    file = path / "frames.jsonl"
    file.write_text(text + "\n", encoding="utf-8")
    return file


def test_a_frame_as_the_contract_states_it(tmp_path: Path) -> None:
    (frame,) = read_frames(write(tmp_path, GOOD))
    assert frame.cycle == 0
    assert frame.percepts == (Percept("object", "o1", {"type": "plug", "x": 0.31}),)
    assert frame.outcomes == (Outcome(Action("pick-up", ("hand1", "o1")), Status.SUCCEEDED),)


def test_action_may_be_null_or_left_out_and_blank_lines_are_skipped(tmp_path: Path) -> None:
    file = write(
        tmp_path, {"cycle": 0, "percepts": [], "action": None}, "", {"cycle": 3, "percepts": []}
    )
    assert [(f.cycle, f.outcomes) for f in read_frames(file)] == [(0, ()), (3, ())]


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("{", "frames.jsonl:2: is not JSON"),
        ("[]", "frames.jsonl:2: a frame: expected a JSON object"),
        ({"percepts": []}, '"cycle": expected an integer from 0, got null'),
        ({"cycle": True, "percepts": []}, '"cycle": expected an integer'),
        ({"cycle": 0, "percepts": []}, '"cycle": 0 comes after 0; cycles must increase'),
        ({"cycle": 1}, '"percepts": expected a list, got null'),
        ({"cycle": 1, "percepts": [{"name": "o1"}]}, 'entry 1, key "type": expected text'),
        (
            {"cycle": 1, "percepts": [{"type": "object", "name": "o", "attributes": {"x": [1]}}]},
            'attribute "x": expected text or a number, got [1]',
        ),
        ('{"cycle": 1, "percepts": [{"type":"o","name":"a","attributes":{"x":NaN}}]}', "finite"),
        ({"cycle": 1, "percepts": [], "action": {"args": []}}, '"action.name": expected text'),
        (
            {"cycle": 1, "percepts": [], "action": {"name": "a", "status": "done"}},
            '"action.status": expected one of succeeded, failed, running, got "done"',
        ),
        ({"cycle": 1, "percepts": [], "action": {"name": "a", "args": "o"}}, '"action.args"'),
    ],
)
def test_a_malformed_line_is_an_error_with_file_line_and_key(
    tmp_path: Path, line: object, message: str
) -> None:
    frames = read_frames(write(tmp_path, GOOD, line))
    next(frames)
    with pytest.raises(FrameError) as raised:
        next(frames)
    assert message in str(raised.value)
    assert "frames.jsonl:2: " in str(raised.value)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(FrameError, match="cannot be read: No such file"):
        next(read_frames(tmp_path / "none.jsonl"))


def test_bytes_that_are_not_text(tmp_path: Path) -> None:
    file = tmp_path / "frames.jsonl"
    file.write_bytes(b'{"cycle": 0, "percepts": []}\n\xff\xfe\n')
    frames = read_frames(file)
    next(frames)
    with pytest.raises(FrameError, match="not UTF-8"):
        next(frames)


def test_a_number_of_a_million_digits_is_refused_in_words(tmp_path: Path) -> None:
    file = write(tmp_path, '{"cycle": ' + "9" * 100_000 + ', "percepts": []}')
    with pytest.raises(FrameError, match="is not usable JSON"):
        next(read_frames(file))


@given(st.binary(max_size=200))
def test_any_bytes_give_frames_or_a_frame_error(
    tmp_path_factory: pytest.TempPathFactory, content: bytes
) -> None:
    file = tmp_path_factory.mktemp("any") / "frames.jsonl"
    file.write_bytes(content)
    with suppress(FrameError):
        assert all(frame.line >= 1 for frame in read_frames(file))


def test_beliefs_are_sorted_one_line_a_cycle() -> None:
    assert beliefs_line(4, ["(on b c)", "(attached a b)"]) == (
        '{"cycle": 4, "beliefs": ["(attached a b)", "(on b c)"]}'
    )
