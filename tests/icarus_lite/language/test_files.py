from __future__ import annotations

import pytest

from icarus_lite.language import DomainError, Severity, diagnose_file, load_domain, render
from icarus_lite.language.syntax import Source


@pytest.fixture
def write(tmp_path):
    def write_file(text: str | bytes):
        path = tmp_path / "d.icr"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return path

    return write_file


def test_a_file_becomes_a_domain_with_its_source(write):
    path = write("(percepts (lamp ^lit))\r\n(concepts ((dark ?l) :elements ((lamp ?l ^lit no))))")
    domain = load_domain(path)
    assert domain.name == "d"
    assert domain.source == Source(
        str(path), "(percepts (lamp ^lit))\n(concepts ((dark ?l) :elements ((lamp ?l ^lit no))))"
    )
    assert load_domain(str(path)) == domain


def test_warnings_and_notes_do_not_keep_a_domain_from_loading(write):
    path = write("(create-concepts ((p ?x) :elements ((q ?x ^y ?z))))")
    assert load_domain(path).concepts
    domain, source, diagnostics = diagnose_file(path)
    assert domain is not None
    assert [each.severity for each in diagnostics] == [
        Severity.NOTE,
        Severity.WARNING,
        Severity.WARNING,
    ]
    assert render(diagnostics[0], source).startswith(f"{path}:1:2: note[ICR028]")


def test_errors_of_syntax_and_of_meaning_raise(write):
    with pytest.raises(DomainError) as caught:
        load_domain(write("(concepts ((p ?x)"))
    assert [each.code for each in caught.value.diagnostics] == ["ICR002"]
    with pytest.raises(DomainError) as caught:
        load_domain(write("(create-concepts ((p ?x)))\n(task 1)"))
    assert [each.code for each in caught.value.diagnostics] == ["ICR028", "ICR012", "ICR021"]
    assert str(caught.value).endswith("d.icr: 2 errors")


def test_python_functions_reach_the_checker(write):
    path = write("(percepts (a ^x))(concepts ((p ?x) :elements ((a ?x ^x ?v)) :tests ((odd ?v))))")
    with pytest.raises(DomainError, match="there is no function `odd`"):
        load_domain(path)
    assert load_domain(path, functions={"odd": lambda v: v % 2 == 1}).concepts


def test_a_missing_file_is_an_error_of_the_domain(tmp_path):
    path = tmp_path / "none.icr"
    with pytest.raises(DomainError) as caught:
        load_domain(path)
    assert str(caught.value) == (
        f"{path}: error[ICR001]: the file cannot be read: no such file or directory\n"
        "   hint: check the name and the folder"
    )


def test_a_folder_is_not_a_domain(tmp_path):
    with pytest.raises(DomainError, match="the file cannot be read: is a directory"):
        load_domain(tmp_path)


def test_bytes_that_are_not_text_are_an_error_of_the_domain(write):
    domain, source, diagnostics = diagnose_file(write(b"(domain \xff)"))
    assert domain is None
    assert [each.code for each in diagnostics] == ["ICR001"]
    assert render(diagnostics[0], source).split("\n")[2] == "      |         ^"
