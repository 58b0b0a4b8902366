from __future__ import annotations

import pytest

from icarus_lite.language import check_domain, diagnose_text, parse_domain

TWO = "(percepts (box ^x ^y))\n(concepts ((p ?b) :elements ((box ?b ^x ?x ^y ?y)))){}"


def codes(text, **options):
    domain, found = parse_domain(text, "d.icr")
    return [each.code for each in (*found, *check_domain(domain, **options))]


def test_nothing_is_silenced_without_a_comment():
    assert codes(TWO.format("")) == ["ICR029", "ICR029"]


@pytest.mark.parametrize(
    "comment",
    [
        " ; noqa",
        " ; noqa: ICR029",
        ";noqa:ICR029",
        " ;; noqa: ICR001, ICR029",
        " ; noqa: ICR029 ICR030 since both are read elsewhere",
        "\n; icarus: noqa: ICR029",
    ],
)
def test_a_comment_silences_its_line_or_the_file(comment):
    assert codes(TWO.format(comment)) == []


@pytest.mark.parametrize(
    "comment",
    [
        " ; noqa: ICR030",
        " ; noqa:",
        " ; noqa: all",
        "\n; noqa",
        " ; no noqa",
        ' (goals (box "; noqa"))',
        "\n; icarus: noqa",
        " #| ; noqa |#",
        " ; noqa-please",
    ],
)
def test_anything_else_silences_nothing(comment):
    assert codes(TWO.format(comment)) == ["ICR029", "ICR029"]


def test_the_line_is_found_behind_strings_and_comments_of_several_lines():
    text = '#| a\n; noqa\n|# (goals (box "\n")) (create-goals (box b)) ; noqa: ICR028\n'
    text += "(percepts (box))"
    assert codes(text) == []


def test_errors_cannot_be_silenced():
    domain, _, found = diagnose_text("(task 1) ; noqa", "d.icr")
    assert domain is None
    assert [each.code for each in found] == ["ICR021"]


def test_names_nobody_uses_are_told_on_request_and_silenced_like_the_rest():
    text = "(percepts (box) (lid))\n(concepts ((p ?b) :elements ((box ?b)))){}"
    assert codes(text.format("")) == []
    assert codes(text.format(""), thorough=True) == ["ICR040", "ICR040"]
    assert codes(text.format(" ; noqa: ICR040"), thorough=True) == ["ICR040"]
    assert codes(text.format("\n; icarus: noqa: ICR040"), thorough=True) == []
