"""The language reference: its tables are those of the code, its examples do what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from icarus_lite.language import CODES, diagnose_file, render
from icarus_lite.language.reference import tables, with_tables

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "language.md"
TEXT = PAGE.read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```lisp ?([^\n]*)\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
FILES = {info.removeprefix("file="): text for info, text in EXAMPLES if info.startswith("file=")}
CASES = [pytest.param(*each, id=f"{i}-{each[0]}") for i, each in enumerate(EXAMPLES)]


def test_the_tables_are_those_of_the_code():
    assert with_tables(TEXT) == TEXT, "run: make reference"
    assert set(re.findall(r"<!-- table: ([a-z-]+) -->", TEXT)) == set(tables())


@pytest.mark.parametrize(("info", "text"), CASES)
def test_every_example_does_what_the_page_says(info, text, tmp_path):
    for name, other in FILES.items():
        (tmp_path / name).write_text(other, encoding="utf-8")
    path = tmp_path / "example.icr"
    path.write_text(text, encoding="utf-8")
    _, source, found = diagnose_file(path)
    said = "\n".join(render(each, source) for each in found)
    if info.startswith("ICR"):
        assert {each.code for each in found} == {info}, said
    else:
        assert [each for each in found if each.severity != "note"] == [], said


def test_every_code_has_a_paragraph_that_begins_with_its_sentence():
    paragraphs = dict(
        re.findall(r"^### (ICR\d+)\n(.+?)\n\n", f"{TEXT}\n\n", re.MULTILINE | re.DOTALL)
    )
    assert list(paragraphs) == list(CODES)
    for code, paragraph in paragraphs.items():
        assert " ".join(paragraph.split()).startswith(CODES[code]), code


def test_most_codes_have_an_example():
    shown = {info for info, _ in EXAMPLES}
    silent = {"ICR001", "ICR005", "ICR006", "ICR020", "ICR035", "ICR040"}
    assert set(CODES) - silent <= shown
