"""MOT Challenge text, read and written."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aapa.anchors import Anchor, AnchorStatus
from aapa.detections import Detection
from aapa.errors import AnchoringError, RecordingError
from aapa.formats.mot import MotWriter, read_mot
from aapa.formats.refusals import Skipped

GOOD = "1,-1,11,21,30,40,0.9,-1,-1,-1"


def written(tmp_path, *lines):
    path = tmp_path / "det.txt"
    path.write_text("\n".join(lines) + "\n")
    return path


def test_frames_and_pixels_are_counted_from_zero(tmp_path):
    [frame] = read_mot(written(tmp_path, GOOD))
    assert frame.frame == 0
    assert frame.detections == (Detection("object", (10.0, 20.0, 40.0, 60.0), 0.9),)


def test_lines_in_any_order_make_frames_in_the_order_of_time_and_empty_ones_between(tmp_path):
    lines = ["4,-1,1,1,5,5,1,-1,-1,-1", "2,-1,1,1,5,5,1,-1,-1,-1", "4,-1,9,9,5,5,1,-1,-1,-1"]
    frames = list(read_mot(written(tmp_path, *lines), "person"))
    assert [(f.frame, len(f.detections)) for f in frames] == [(0, 0), (1, 1), (2, 0), (3, 2)]
    assert frames[1].detections[0].type == "person"


@pytest.mark.parametrize(
    "line",
    ["1,-1,11,21,30,40", "1 -1 11 21 30 40 0.9", "1.0, -1, 11, 21, 30, 40, 1", "\ufeff" + GOOD],
)
def test_fewer_columns_and_blanks_do_as_well(tmp_path, line):
    path = tmp_path / "det.txt"
    path.write_text(line + "\n\n", encoding="utf-8")
    [frame] = read_mot(path)
    assert frame.detections[0].box == (10.0, 20.0, 40.0, 60.0)


@pytest.mark.parametrize(("conf", "score"), [("54.3", 1.0), ("-1", 0.0), ("0.25", 0.25)])
def test_scores_are_kept_within_0_and_1(tmp_path, conf, score):
    [frame] = read_mot(written(tmp_path, f"1,-1,1,1,5,5,{conf},-1,-1,-1"))
    assert frame.detections[0].score == score


WRONG = [
    ("1,-1,1,1,nan,5,1", "bb_width", "expected a finite number, found 'nan'"),
    ("1,-1,inf,1,5,5,1", "bb_left", "expected a finite number, found 'inf'"),
    ("1,-1,1,1,-5,5,1", "bb_width", "it is -5; expected above 0 px"),
    ("1,-1,1,1,5,0,1", "bb_height", "it is 0; expected above 0 px"),
    ("0,-1,1,1,5,5,1", "frame", "expected a whole number of at least 1, found '0'"),
    ("1.5,-1,1,1,5,5,1", "frame", "expected a whole number of at least 1, found '1.5'"),
    ("frame,id,left,top,width,height,conf", "frame", "expected a number, found 'frame'"),
    ("1,-1,1_0,1,5,5,1", "bb_left", "expected a number, found '1_0'"),
    ("1,-1,1,1,5", "", "it has 5 columns; expected 6 to 10: frame, id, bb_left"),
    ("1,2,3,4,5,6,7,8,9,10,11", "", "it has 11 columns"),
    ("1,-1,1e12,1,5,5,1", "", "in its box"),
]


@pytest.mark.parametrize(("line", "key", "text"), WRONG)
def test_a_malformed_line_names_file_line_and_column(tmp_path, line, key, text):
    path = written(tmp_path, GOOD, line)
    with pytest.raises(RecordingError) as caught:
        list(read_mot(path))
    assert (caught.value.path, caught.value.line, caught.value.key) == (str(path), 2, key)
    assert text in str(caught.value)


def test_malformed_lines_can_be_passed_over_and_are_counted(tmp_path):
    skipped = Skipped()
    path = written(tmp_path, GOOD, *(line for line, _, _ in WRONG), "2,-1,1,1,5,5,1")
    frames = list(read_mot(path, refused=skipped))
    assert [len(frame.detections) for frame in frames] == [1, 1]
    assert skipped.count == len(WRONG)
    assert skipped.report("part").startswith(
        f"{len(WRONG)} malformed parts were passed over; the first: {path}:2: key 'bb_width'"
    )


def test_a_frame_number_out_of_all_proportion_is_refused_at_once(tmp_path):
    with pytest.raises(RecordingError, match=r"det.txt:2: key 'frame': .* expected gaps of at"):
        list(read_mot(written(tmp_path, GOOD, "1e300,-1,1,1,5,5,1")))


def test_what_is_no_file_and_what_is_no_text_is_refused(tmp_path):
    with pytest.raises(AnchoringError, match="cannot read"):
        list(read_mot(tmp_path / "none.txt"))
    path = tmp_path / "det.txt"
    path.write_bytes(b"1,\xff")
    with pytest.raises(AnchoringError, match="byte 2 is not UTF-8"):
        list(read_mot(path))


def test_each_name_keeps_its_number():
    writer = MotWriter()
    cone = Anchor("cone-1", "cone", (0.5, 0.0, 10.25, 20.0), AnchorStatus.VISIBLE, confidence=0.7)
    ball = Anchor("ball-1", "ball", (1e-9, 0.0, 1e6, 2.0), AnchorStatus.MISSING)
    assert writer.lines(0, [cone]) == ["1,1,1.5,1,9.75,20,0.7,-1,-1,-1"]
    assert writer.lines(1, [ball, cone]) == [
        "2,2,1,1,1000000,2,0,-1,-1,-1",
        "2,1,1.5,1,9.75,20,0.7,-1,-1,-1",
    ]


sides = st.integers(-4000, 4000).map(lambda n: n / 8)


@given(st.lists(st.tuples(sides, sides, st.integers(1, 999), st.integers(1, 999)), min_size=1))
def test_what_is_written_is_read_again(tmp_path_factory, boxes):
    boxes = [(x, y, x + width / 8, y + height / 8) for x, y, width, height in boxes]
    writer = MotWriter()
    lines = []
    for frame, box in enumerate(boxes):
        lines += writer.lines(frame, [Anchor("a", "object", box, AnchorStatus.VISIBLE)])
    path = written(tmp_path_factory.mktemp("mot"), *lines)
    assert [frame.detections[0].box for frame in read_mot(path)] == boxes
