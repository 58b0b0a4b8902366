from __future__ import annotations

import pickle
from pathlib import Path

import pytest

from icarus_lite.errors import IcarusError
from icarus_lite.language import (
    CODES,
    Diagnostic,
    DomainError,
    Severity,
    check_domain,
    parse_domain,
    render,
    to_json,
)
from icarus_lite.language.syntax import NOWHERE, Source, Span

MESSAGES = Path(__file__).with_name("messages.txt").read_text(encoding="utf-8")
CASES = [
    (section[:6], *section[7:].rstrip("\n").split("\n-----\n"))
    for section in MESSAGES.replace("\\0", "\0").split("\n===== ")[1:]
]


def diagnose(text: str) -> tuple[Diagnostic, ...]:
    domain, diagnostics = parse_domain(text, "d.icr")
    return diagnostics if domain is None else (*diagnostics, *check_domain(domain))


@pytest.mark.parametrize(
    ("code", "text", "expected"), CASES, ids=[f"{c[0]}-{i}" for i, c in enumerate(CASES)]
)
def test_every_message_is_word_for_word_as_recorded(code, text, expected):
    found = diagnose(text)
    assert "\n".join(render(each, text) for each in found) == expected
    assert code in {each.code for each in found}


def test_every_code_has_a_recorded_message():
    # What a driver offers is no matter of the text alone: see test_commands. What nobody uses is
    # told on request: see test_usage.
    assert {code for code, _, _ in CASES} == set(CODES) - {"ICR035", "ICR040"}


def test_codes_are_explained_by_a_sentence_each():
    assert all(text.endswith(".") for text in CODES.values())
    assert len(set(CODES.values())) == len(CODES)


def diagnostic(span, **fields):
    return Diagnostic("a.icr", span, Severity.ERROR, "ICR012", "?any is never bound", **fields)


def test_the_form_of_a_message():
    text = "\n" * 13 + "  (not (holding ?hand ?any)))"
    found = diagnostic(
        Span(14, 23, 14, 27), label="only used inside `not`", hint="bind it in :elements"
    )
    assert render(found, Source("a.icr", text)) == (
        "a.icr:14:23: error[ICR012]: ?any is never bound\n"
        "   14 |   (not (holding ?hand ?any)))\n"
        "      |                       ^^^^ only used inside `not`\n"
        "   hint: bind it in :elements"
    )


def shown(text, span):
    _, line, carets = render(diagnostic(span), text).split("\n")
    return line[8:], carets[8:]


def test_a_tab_is_as_wide_as_it_is_shown():
    assert shown("\t?x", Span(1, 2, 1, 4)) == ("    ?x", "    ^^")
    assert shown("ab\t?x", Span(1, 4, 1, 6)) == ("ab  ?x", "    ^^")


def test_wide_and_combining_characters_keep_the_carets_in_place():
    assert shown("歯車 ?x", Span(1, 4, 1, 6)) == ("歯車 ?x", "     ^^")
    assert shown("歯車", Span(1, 1, 1, 3)) == ("歯車", "^^^^")
    assert shown("e\u0301 ?x", Span(1, 4, 1, 6)) == ("e\u0301 ?x", "  ^^")


def test_control_characters_do_not_reach_the_terminal():
    line, carets = shown("\x1b[31m ?x", Span(1, 7, 1, 9))
    assert "\x1b" not in line
    assert carets == "      ^^"


def test_a_span_over_several_lines_is_underlined_to_the_end_of_the_first():
    assert shown("(a\n b)", Span(1, 1, 2, 4)) == ("(a", "^^")


def test_a_span_behind_the_end_of_the_line_still_has_a_caret():
    assert shown("(a", Span(1, 9, 1, 12)) == ("(a", "  ^")


def test_a_long_line_is_cut_around_the_span():
    line, carets = shown("x" * 300 + "?y" + "z" * 300, Span(1, 301, 1, 303))
    assert len(line) <= 122
    assert line.startswith("…")
    assert line.endswith("…")
    assert line[carets.index("^") : carets.index("^") + 2] == "?y"


def test_a_diagnostic_without_a_place_is_a_line_and_a_hint():
    found = diagnostic(NOWHERE, hint="do this")
    assert render(found, "text") == "a.icr: error[ICR012]: ?any is never bound\n   hint: do this"


def test_the_json_row_has_the_fields_of_the_contract():
    row = to_json(diagnostic(Span(3, 4, 5, 6), hint="do this", label="here"))
    assert row == {
        "file": "a.icr",
        "line": 3,
        "column": 4,
        "end_line": 5,
        "end_column": 6,
        "severity": "error",
        "code": "ICR012",
        "message": "?any is never bound",
        "hint": "do this",
    }
    assert diagnostic(NOWHERE).to_json() == to_json(diagnostic(NOWHERE))


def test_a_domain_error_shows_its_errors_and_counts_them():
    text = "(goals (a)))\n(foo)\n"
    found = diagnose(text)
    error = DomainError(found, Source("d.icr", text))
    assert isinstance(error, IcarusError)
    assert isinstance(error, ValueError)
    assert str(error) == "\n".join([*(render(each, text) for each in found), "d.icr: 2 errors"])


def test_a_domain_error_does_not_show_warnings():
    warning = Diagnostic("d.icr", NOWHERE, Severity.WARNING, "ICR029", "?x occurs only once")
    error = DomainError([warning, diagnostic(NOWHERE)], Source("d.icr", ""))
    assert str(error) == "a.icr: error[ICR012]: ?any is never bound"
    assert len(error.diagnostics) == 2


def test_a_domain_error_survives_pickling():
    error = DomainError([diagnostic(NOWHERE)], Source("d.icr", "x"))
    copy = pickle.loads(pickle.dumps(error))
    assert (str(copy), copy.diagnostics, copy.source) == (
        str(error),
        error.diagnostics,
        error.source,
    )
