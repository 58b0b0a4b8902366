from __future__ import annotations

import os
from pathlib import Path

import pytest

from icarus_lite.agent import Agent
from icarus_lite.errors import InferenceError
from icarus_lite.language import (
    DomainError,
    diagnose_file,
    diagnose_text,
    load_domain,
    parse_domain,
    render,
)
from icarus_lite.language.reading.includes import MAX_INCLUDES
from icarus_lite.symbols import Percept


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder of files, seen from inside, so that messages hold no path of this machine."""
    monkeypatch.chdir(tmp_path)

    def write(**files):
        for name, text in files.items():
            path = tmp_path / f"{name.replace('__', '/')}.icr"
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return tmp_path

    return write


def said(path):
    _, source, found = diagnose_file(path)
    return "\n".join(render(each, source) for each in found)


PERCEPTS = "(domain shapes) (percepts (box ^x))"
USES = '(include "shapes.icr")\n(concepts ((far ?b) :elements ((box ?b ^x ?x)) :tests ((> ?x 1))))'


def test_the_forms_of_an_included_file_stand_in_the_place_of_the_include(folder):
    folder(top=USES, shapes=PERCEPTS)
    domain = load_domain("top.icr")
    assert domain.percepts[0].name == "box"
    assert domain.name == "top"  # the name of an included file is its own
    assert domain.percepts[0].span.path == "shapes.icr"
    assert domain.concepts[0].span.path == ""
    assert [each.path for each in domain.source.included] == ["shapes.icr"]
    assert domain == parse_domain(USES.replace('(include "shapes.icr")', PERCEPTS[15:]), "top")[0]


def test_an_include_is_relative_to_the_file_in_which_it_stands(folder):
    folder(
        top='(include "parts/all.icr")',
        parts__all='(include "one.icr") (include "../two.icr")',
        parts__one="(goals (a x))",
        two="(percepts (a))",
    )
    domain = load_domain("top.icr")
    assert [each.path for each in domain.source.included] == [
        "parts/all.icr",
        "parts/one.icr",
        "two.icr",
    ]
    assert domain.goals[0].span.path == "parts/one.icr"


def test_findings_in_an_included_file_point_into_it(folder):
    folder(
        top='(include "more.icr")\n(percepts (box ^x))',
        more="; more\n(concepts ((p ?b) :elements ((bax ?b))))",
    )
    assert said("top.icr") == (
        "more.icr:2:31: error[ICR013]: nothing is ever known about `bax`\n"
        "    2 | (concepts ((p ?b) :elements ((bax ?b))))\n"
        "      |                               ^^^ neither perceived, derived nor asserted\n"
        "   hint: did you mean `box`?"
    )
    _, _, found = diagnose_file("top.icr")
    assert found[0].to_json()["file"] == "more.icr"
    with pytest.raises(DomainError, match=r"more\.icr:2:31: error\[ICR013\]"):
        load_domain("top.icr")


def test_errors_of_syntax_in_an_included_file_are_told_with_those_of_the_others(folder):
    folder(top='(include "a.icr") (include "b.icr")', a="(goals (x)", b="(gaols (x))")
    _, _, found = diagnose_file("top.icr")
    assert [(each.path, each.code) for each in found] == [("a.icr", "ICR002"), ("b.icr", "ICR007")]


def test_bytes_that_are_not_text_are_told_of_the_included_file(folder):
    (folder(top='(include "a.icr")') / "a.icr").write_bytes(b"(goals (\xe4))")
    assert said("top.icr").startswith("a.icr:1:9: error[ICR001]: the byte 0xe4 is not UTF-8\n")


def test_what_is_stated_twice_in_two_files_names_the_other_one(folder):
    folder(top='(include "a.icr")\n(percepts (box))', a="(percepts (box))")
    assert "declared in line 1 of a.icr already" in said("top.icr")


def test_a_file_included_twice_is_read_once(folder):
    folder(
        top='(include "a.icr") (include "b.icr") (goals (box x))',
        a='(include "shapes.icr")',
        b='(include "./shapes.icr")',
        shapes=PERCEPTS,
    )
    assert len(load_domain("top.icr").percepts) == 1


def test_a_circle_of_includes_is_an_error_that_shows_it(folder):
    folder(top='(include "a.icr")', a='(goals (x))\n(include "top.icr")')
    assert said("top.icr") == (
        "a.icr:2:10: error[ICR036]: `top.icr` includes itself: top.icr -> a.icr -> top.icr\n"
        '    2 | (include "top.icr")\n'
        "      |          ^^^^^^^^^\n"
        "   hint: remove one of these includes; move what both files need to a third"
    )
    folder(top='(include "top.icr")')
    assert "`top.icr` includes itself: top.icr -> top.icr" in said("top.icr")


def test_an_include_may_not_lead_out_of_the_folder_of_the_domain(folder):
    folder(sub__top='(include "../secret.icr")', secret="(goals (x))")
    assert said("sub/top.icr") == (
        "sub/top.icr:1:10: error[ICR036]: `../secret.icr` lies outside the folder of sub/top.icr\n"
        '    1 | (include "../secret.icr")\n'
        "      |          ^^^^^^^^^^^^^^^\n"
        "   hint: a domain includes files of its own folder and those in it, by a relative name"
    )
    Path("sub/link.icr").symlink_to("../secret.icr")
    folder(sub__top='(include "link.icr")')
    assert "`link.icr` lies outside the folder" in said("sub/top.icr")
    folder(sub__top='(include "/etc/passwd")')
    assert "`/etc/passwd` lies outside the folder" in said("sub/top.icr")


def test_a_missing_file_is_told_with_the_place_where_it_was_looked_for(folder):
    folder(sub__top='(include "shaeps.icr")')
    assert said("sub/top.icr") == (
        "sub/top.icr:1:10: error[ICR036]: the file `shaeps.icr` does not exist\n"
        '    1 | (include "shaeps.icr")\n'
        "      |          ^^^^^^^^^^^^\n"
        "   hint: it is looked for at sub/shaeps.icr"
    )


@pytest.mark.parametrize("name", ["sub", "pipe", "", ".", "x" * 5000])
def test_what_is_no_file_is_not_included(folder, name):
    (folder(top=f'(include "{name}")') / "sub").mkdir()
    os.mkfifo("pipe")  # reading it would wait for ever
    _, _, found = diagnose_file("top.icr")
    assert [each.code for each in found] == ["ICR036"]


def test_a_long_chain_of_includes_ends(folder):
    chain = {f"f{n}": f'(include "f{n + 1}.icr")' for n in range(MAX_INCLUDES + 2)}
    folder(**chain)
    _, _, found = diagnose_file("f0.icr")
    assert [(each.code, each.message) for each in found] == [
        ("ICR036", f"files are included more than {MAX_INCLUDES} deep")
    ]


def test_a_text_that_is_not_saved_yet_may_include_files(folder):
    folder(shapes=PERCEPTS)
    domain, source, found = diagnose_text(USES, "new.icr")
    assert (domain.name, found) == ("new", ())
    assert source.text == USES


def test_a_text_without_a_place_includes_nothing():
    _, found = parse_domain('(include "shapes.icr")')
    assert [each.code for each in found] == ["ICR036"]


def test_a_comment_in_the_included_file_silences_a_remark_there(folder):
    folder(top='(include "a.icr") (percepts (box ^x))', a="(create-goals (box b)) ; noqa: ICR028")
    assert said("top.icr") == ""


def test_a_belief_is_explained_by_the_line_of_the_included_file(folder):
    folder(top='(include "parts.icr")', parts=f"{PERCEPTS}\n\n{USES.splitlines()[1]}")
    agent = Agent(load_domain("top.icr"))
    agent.cycle([Percept("box", "b1", {"x": 2})])
    assert "(line 3 of parts.icr)" in str(agent.why("(far b1)"))


def test_a_test_that_cannot_be_evaluated_names_the_included_file(folder):
    folder(top='(include "parts.icr")', parts=f"{PERCEPTS}\n\n{USES.splitlines()[1]}")
    agent = Agent(load_domain("top.icr"))
    with pytest.raises(InferenceError, match=r"^parts\.icr:3:\d+: \?x is the symbol left"):
        agent.cycle([Percept("box", "b1", {"x": "left"})])
