"""The bookkeeping of the long run: what is done stays done, what failed is tried with new code."""

from __future__ import annotations

from pathlib import Path

import fuzz
import pytest
from engine_trials.trial import flavour_of
from engine_trials.vocabulary import Flavour
from fuzz import Chunk, chunks, done_before, left, note, page


def chunk(first: int, code: str = "one", failed: tuple[int, ...] = ()) -> Chunk:
    return Chunk(first, 20, code, 1.5, 100, 18, 2, failed)


def kept(tmp_path: Path, *rows: Chunk) -> dict[int, Chunk]:
    state = tmp_path / "state" / "chunks.jsonl"
    for each in rows:
        note(each, {seed: f"report {seed}" for seed in each.failed}, state, tmp_path / "failures")
    return done_before(state, 20)


def test_enough_programs_are_judged_by_clingo() -> None:
    seeds = [seed for first in chunks(10_000) for seed in range(first, first + 20)]
    assert seeds == list(range(len(seeds)))
    judged = sum(flavour_of(seed) is not Flavour.DEEP for seed in seeds)
    assert 10_000 <= judged < 10_020


def test_a_run_that_asks_for_more_goes_on_where_the_last_one_ended(tmp_path: Path) -> None:
    done = kept(tmp_path, chunk(0), chunk(20))
    assert left(36, done, "one") == []
    assert left(90, done, "another") == [40, 60, 80]
    assert left(90, kept(tmp_path, chunk(60)), "another") == [40, 80]


def test_what_failed_is_tried_again_once_the_code_is_another(tmp_path: Path) -> None:
    done = kept(tmp_path, chunk(0), chunk(20, failed=(21, 38)))
    assert (tmp_path / "failures" / "38.txt").read_text("utf-8") == "report 38"
    assert left(54, done, "one") == [40]
    assert left(54, done, "two") == [20, 40]
    assert left(54, kept(tmp_path, chunk(20, "two")), "three") == [40]


def test_histories_of_another_length_are_another_run(tmp_path: Path) -> None:
    kept(tmp_path, chunk(0))
    assert done_before(tmp_path / "state" / "chunks.jsonl", 10) == {}
    assert done_before(tmp_path / "nothing.jsonl", 20) == {}


def test_the_page_says_what_was_tried_with_which_code() -> None:
    text = page([chunk(0), chunk(20), chunk(40, "two", failed=(41,))])
    assert "| domains | 60 (seeds 0 to 59), 20 cycles each |" in text
    assert "| judged by clingo | 54; the others" in text
    assert "6 deep, 6 plain, 6 scene, 40 usual" in text
    assert "| failures | seeds [41] |" in text
    assert text.rstrip().endswith("| `one` | 0 to 39 |\n| `two` | 40 to 59 |")


def test_another_code_has_another_digest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = fuzz.digest()
    assert before == fuzz.digest()
    module = tmp_path / "icarus_lite" / "inference" / "module.py"
    module.parent.mkdir(parents=True)
    monkeypatch.setattr(fuzz, "_ROOT", tmp_path)
    found = []
    for text in ("x = 1", "x = 2"):
        module.write_text(text, encoding="utf-8")
        found.append(fuzz.digest())
    assert len({before, *found}) == 3


def test_a_chunk_is_run_and_judged() -> None:
    done, reports = fuzz.run_chunk(0, cycles=2, code="now")
    assert (done.failed, reports) == ((), {})
    assert (done.judged, done.by_clips) == (18, 2)
    assert done.given > 100
