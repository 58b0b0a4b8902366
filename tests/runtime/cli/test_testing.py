"""`icarus test` as a person calls it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_line import icarus

GOOD = '(percepts (o))\n(test "one" :percepts ((o a)) :expect ((o a)))\n'
BAD = GOOD + '(test "Two" :percepts ((o a)) :expect ((o b)))\n'


@pytest.fixture
def good(tmp_path: Path) -> Path:
    (tmp_path / "good.icr").write_text(GOOD)
    return tmp_path / "good.icr"


@pytest.fixture
def bad(tmp_path: Path) -> Path:
    (tmp_path / "bad.icr").write_text(BAD)
    return tmp_path / "bad.icr"


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    (tmp_path / "broken.icr").write_text(GOOD + "(concepts ((p ?x) :elements ((oh ?x))))")
    return tmp_path / "broken.icr"


def test_all_hold(good: Path) -> None:
    assert icarus("test", good) == (0, f"{good}: 1 test, it holds\n", "")


def test_one_fails(good: Path, bad: Path) -> None:
    status, out, err = icarus("test", good, bad)
    assert (status, err) == (1, "")
    assert out.split("\n") == [
        f"{good}: 1 test, it holds",
        "failed: Two",
        f"{bad}:3:40: :expect (o b)",
        "    it is not believed",
        "      nearest: (o a)",
        "",
        f"{bad}: 2 tests, 1 of them fails",
        "2 files: 3 tests, 1 of them fails",
        "",
    ]


def test_a_selection_by_name_ignores_case(bad: Path) -> None:
    assert icarus("test", bad, "-k", "ONE")[0] == 0
    assert icarus("test", bad, "-k", "two")[0] == 1


def test_a_selection_that_fits_nothing_is_bad_usage(good: Path) -> None:
    status, _, err = icarus("test", good, "-k", "three")
    assert (status, err) == (2, 'no test has "three" in its name\n')


def test_a_file_with_errors_is_bad_input_and_the_others_still_run(good: Path, broken: Path) -> None:
    status, out, err = icarus("test", broken, good)
    assert status == 2
    assert err.startswith(f"{broken}:3:31: error[ICR013]")
    assert "1 test, it holds" in out


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    status, _, err = icarus("test", tmp_path / "none.icr")
    assert status == 2
    assert "cannot be read" in err


def test_a_file_without_tests_says_so(tmp_path: Path) -> None:
    (tmp_path / "untested.icr").write_text("(percepts (o))")
    status, out, _ = icarus("test", tmp_path / "untested.icr")
    assert (status, out) == (0, f"{tmp_path / 'untested.icr'}: no tests\n")


def test_json_is_one_document(bad: Path, broken: Path) -> None:
    status, out, err = icarus("test", bad, "--json")
    document = json.loads(out)
    assert (status, err) == (1, "")
    assert (document["passed"], document["failed"], document["problems"]) == (1, 1, [])
    assert [test["name"] for test in document["tests"]] == ["one", "Two"]
    status, out, err = icarus("test", bad, broken, "--json")
    document = json.loads(out)
    assert status == 2
    assert document["problems"][0]["code"] == "ICR013"
    assert len(document["tests"]) == 2


def test_an_error_at_run_time_fails_the_test_in_words(tmp_path: Path) -> None:
    file = tmp_path / "wrong.icr"
    file.write_text(
        "(percepts (o ^x))\n(concepts ((big ?o) :elements ((o ?o ^x ?x)) :tests ((> ?x 1))))\n"
        '(test "it" :percepts ((o a ^x red)) :expect ((big a)))\n'
    )
    status, out, err = icarus("test", file)
    assert status == 1
    assert f"{file}:2:" in out
    assert "Traceback" not in out + err
