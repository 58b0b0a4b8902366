from __future__ import annotations

from pathlib import Path

import pytest

from icarus_lite.language import DomainError, diagnose_file
from icarus_lite.language.reading.sources import MAX_BYTES, decode, read_source


@pytest.mark.parametrize("ending", [b"\n", b"\r\n", b"\r"])
def test_lines_end_alike_whatever_the_system(ending):
    data = b"\xef\xbb\xbf(goals" + ending + b" (a))"
    assert decode(data, "d.icr").text == "(goals\n (a))"


@pytest.mark.parametrize(
    ("encoding", "name"), [("utf-16", "UTF-16"), ("utf-32", "UTF-32"), ("utf-16-be", None)]
)
def test_other_encodings_are_named_where_they_name_themselves(encoding, name):
    data = "(goals (größe))".encode(encoding)
    if name is None:
        data = b"\xfe\xff" + data
    with pytest.raises(DomainError) as caught:
        decode(data, "d.icr")
    assert str(caught.value) == (
        f"d.icr: error[ICR001]: the file is {name or 'UTF-16'}, not UTF-8\n"
        "   hint: save the file as UTF-8"
    )


def test_a_bad_byte_after_a_byte_order_mark_is_found_where_it_stands():
    for mark in (b"", b"\xef\xbb\xbf"):
        with pytest.raises(DomainError) as caught:
            decode(mark + b"(goals\n (\xff))", "d.icr")
        assert "d.icr:2:3: error[ICR001]: the byte 0xff is not UTF-8" in str(caught.value)


def test_a_file_that_is_too_large_is_refused_unread(tmp_path):
    path = tmp_path / "d.icr"
    path.write_bytes(b";" * MAX_BYTES)
    assert len(read_source(path, "d.icr").text) == MAX_BYTES
    path.write_bytes(b";" * (MAX_BYTES + 1))
    with pytest.raises(DomainError, match="the file is larger than 10 MB"):
        read_source(path, "d.icr")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no endless file on this system")
def test_a_file_without_end_is_refused():
    _, _, found = diagnose_file("/dev/zero")
    assert [each.message for each in found] == ["the file is larger than 10 MB"]


@pytest.mark.parametrize("name", ["a\0b", "\ud800", "x" * 5000, ""])
def test_what_cannot_be_the_name_of_a_file_is_an_error_of_the_domain(name):
    _, _, found = diagnose_file(name)
    assert [each.code for each in found] == ["ICR001"]
    assert found[0].message.startswith("the file cannot be read: ")
