from __future__ import annotations

import json

import pytest

from aapa.anchors import Anchor, AnchorStatus
from aapa.detections import Detection
from aapa.errors import AnchoringError, RecordingError
from aapa.jsonl import RecordedAction, anchors_line, read_frames

FULL = {
    "frame": 0,
    "width": 320,
    "height": 240,
    "detections": [
        {"type": "cone", "box": [1, 2, 3, 4.5], "score": 0.97, "colour": "red"},
        {"type": "hand", "box": [0, 0, 0, 0], "position": [0, 0, 1], "size": [1, 2], "name": "h"},
    ],
    "actions": [
        {"name": "contain", "args": ["cone-1", "snitch-1"], "status": "failed"},
        {"name": "wait"},
    ],
    "note": {"any": ["thing"]},
}


@pytest.fixture
def recording(tmp_path):
    def write(*lines):
        path = tmp_path / "in.jsonl"
        texts = [line if isinstance(line, bytes) else json.dumps(line).encode() for line in lines]
        path.write_bytes(b"\n".join(texts) + b"\n")
        return path

    return write


def test_a_full_line(recording):
    [frame] = read_frames(recording(FULL))
    assert (frame.frame, frame.image_size) == (0, (320, 240))
    assert frame.detections == (
        Detection("cone", (1.0, 2.0, 3.0, 4.5), 0.97),
        Detection("hand", (0.0, 0.0, 0.0, 0.0), 1.0, (0.0, 0.0, 1.0), (1.0, 2.0), "h"),
    )
    assert frame.actions == (
        RecordedAction("contain", ("cone-1", "snitch-1"), "failed"),
        RecordedAction("wait", (), "succeeded"),
    )
    assert frame.extra == {"note": {"any": ["thing"]}}


def test_a_box_outside_of_the_picture_is_refused(recording):
    far = {"frame": 1, "width": 320, "height": 240, "detections": [{"type": "a", "box": [400] * 4}]}
    with pytest.raises(RecordingError, match=r":1: key 'detections': .* outside of the picture"):
        list(read_frames(recording(far)))
    unsized = {key: far[key] for key in ("frame", "detections")}
    assert len(list(read_frames(recording(unsized)))) == 1


def test_the_least_that_a_line_holds(recording):
    frames = list(
        read_frames(
            recording({"frame": 3, "detections": []}, b"  ", b'{"frame":4,"detections":[]}')
        )
    )
    assert [frame.frame for frame in frames] == [3, 4]
    assert (frames[0].actions, frames[0].image_size, frames[0].extra) == ((), None, {})


def test_an_empty_file_has_no_frames(recording):
    assert list(read_frames(recording())) == []


def test_lines_are_read_as_they_are_asked_for(recording):
    frames = read_frames(recording(FULL, b"{"))
    assert next(frames).frame == 0
    with pytest.raises(RecordingError, match=r"in.jsonl:2: the line is not JSON: .* at column"):
        next(frames)


def changed(**keys):
    return {**FULL, **keys}


def detected(**keys):
    return changed(detections=[{"type": "cone", "box": [1, 2, 3, 4], **keys}])


@pytest.mark.parametrize(
    ("line", "key", "text"),
    [
        (b"\xff{}", "", "the line is not UTF-8"),
        (b"[" * 100_000, "", "nested too deeply"),
        (b'{"frame": ' + b"1" * 5000 + b"}", "", "a number that is too long"),
        ([1, 2], "", "expected an object with the keys of a frame, found a list of 2"),
        ({"detections": []}, "frame", "it is missing"),
        (changed(frame=-1), "frame", "expected a whole number of at least 0, found -1"),
        (changed(frame="0"), "frame", "found '0'"),
        (changed(frame=True), "frame", "found True"),
        ({"frame": 0}, "detections", "it is missing"),
        (changed(detections={}), "detections", "expected a list, found an object"),
        (changed(detections=[3]), "detections", "with type and box, found a number"),
        (changed(detections=[{"box": [1, 2, 3, 4]}]), "type", "it is missing"),
        (changed(detections=[{"type": "cone"}]), "box", "it is missing; expected"),
        (detected(type=""), "type", "expected a name, found ''"),
        (detected(box=[1, 2, 3]), "box", "expected a list of 4 numbers, found a list of 3"),
        (detected(box="1234"), "box", "found text"),
        (detected(box=[1, 2, 3, None]), "box", "expected 4 numbers, found"),
        (detected(box=[3, 2, 1, 4]), "detections", "inverted box"),
        (detected(box=[1, 2, float("nan"), 4]), "detections", "has nan in its box"),
        (detected(score="high"), "score", "expected a number within 0…1, found text"),
        (detected(score=2), "detections", "has score 2.0"),
        (detected(position=[1, 2]), "position", "expected a list of 3 numbers"),
        (detected(size=[1]), "size", "expected a list of 2 numbers"),
        (detected(name=7), "name", "expected a name, found 7"),
        (changed(width=0), "width", "at least 1, found 0"),
        ({"frame": 0, "width": 320, "detections": []}, "height", "it is missing"),
        (changed(actions=None), "actions", "expected a list, found null"),
        (changed(actions=["contain"]), "actions", "with name and args, found text"),
        (changed(actions=[{"args": []}]), "name", "it is missing"),
        (changed(actions=[{"name": "a", "args": [1]}]), "args", "expected a list of names"),
        (changed(actions=[{"name": "a", "status": "done"}]), "status", "expected one of succeeded"),
    ],
)
def test_a_malformed_line_names_file_line_and_key(recording, line, key, text):
    path = recording(FULL, line)
    with pytest.raises(RecordingError) as caught:
        list(read_frames(path))
    assert (caught.value.path, caught.value.line, caught.value.key) == (str(path), 2, key)
    assert str(caught.value).startswith(f"{path}:2: " + (f"key '{key}': " if key else ""))
    assert text in str(caught.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(AnchoringError, match=r"cannot read .*none.jsonl: No such file"):
        next(read_frames(tmp_path / "none.jsonl"))


def test_anchors_are_written_as_the_contract_says():
    anchor = Anchor(
        "snitch-1", "snitch", (1.0, 2.0, 3.0, 4.5), AnchorStatus.ATTACHED, "cone-1", 0.9
    )
    seen = Anchor("größe-1", "größe", (0.0, 0.0, 1.0, 1.0), AnchorStatus.OUT_OF_VIEW)
    line = anchors_line(7, [anchor, seen])
    assert "\n" not in line
    assert "größe" in line
    assert json.loads(line) == {
        "frame": 7,
        "anchors": [
            {
                "name": "snitch-1",
                "type": "snitch",
                "box": [1.0, 2.0, 3.0, 4.5],
                "status": "attached",
                "parent": "cone-1",
                "confidence": 0.9,
            },
            {
                "name": "größe-1",
                "type": "größe",
                "box": [0.0, 0.0, 1.0, 1.0],
                "status": "out-of-view",
                "parent": None,
                "confidence": 0.0,
            },
        ],
    }
