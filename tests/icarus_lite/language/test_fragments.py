from __future__ import annotations

import pytest

from icarus_lite.language import DomainError, parse_atom, parse_conditions
from icarus_lite.language.syntax import Atom, Constant, Variable


@pytest.mark.parametrize(
    "text",
    [
        "((on a b) (not (on b c)))",
        "(on a b) (not (on b c))",
        "  ( (on a b)\n(not (on b c)) ) ; both\n",
    ],
)
def test_conditions_with_and_without_a_list(text):
    assert [str(each) for each in parse_conditions(text)] == ["(on a b)", "(not (on b c))"]


def test_one_condition():
    assert [str(each) for each in parse_conditions("(attached ?x case)")] == ["(attached ?x case)"]


def test_one_pattern():
    assert parse_atom('(at ?o ^x 1.5 *type "a b")') == Atom(
        "at", (Variable("?o"),), (("x", Constant(1.5)), ("type", Constant("a b")))
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "<goal>:1:1: error[ICR006]: there is nothing to read"),
        ("()", "<goal>: error[ICR006]: there is nothing to read"),
        ("on a b", "<goal>:1:1: error[ICR009]: `on` cannot stand here"),
        ("((on a b)) x", "<goal>:1:12: error[ICR009]: `x` cannot stand here"),
        ("((on a b)", '<goal>:1:1: error[ICR002]: this "(" is never closed'),
        ("(on a b))", '<goal>:1:9: error[ICR003]: this ")" closes nothing'),
        ('(on a "b)', "<goal>:1:7: error[ICR004]: this string is never closed"),
        ("(on a \0)", "<goal>:1:7: error[ICR001]: the text holds a NUL character"),
        ("(on a 1e999)", "<goal>:1:7: error[ICR010]: the number is too large"),
        ("(not (a) (b))", "<goal>:1:10: error[ICR009]: `not` takes exactly one pattern"),
    ],
)
def test_what_is_no_goal_is_explained_at_its_place(text, message):
    with pytest.raises(DomainError) as caught:
        parse_conditions(text)
    assert str(caught.value).startswith(message)


def test_two_patterns_are_one_too_many():
    with pytest.raises(DomainError, match=r"<pattern>:1:5: .*cannot stand here"):
        parse_atom("(a) (b)")
