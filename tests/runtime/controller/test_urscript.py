from __future__ import annotations

import contextlib
import string
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.program import Program, blocking_names
from runtime.controller.tokens import KEYWORDS, ScriptError, tokenise
from runtime.controller.urscript import translate


def run(text: str, cycles: int = 20) -> tuple[list[Any], Program]:
    """Run a program with three functions to reach: say, sync and sleep2."""
    said: list[Any] = []

    def sync():
        yield

    def sleep2(t=0):
        yield
        yield
        return t

    functions = {"say": said.append, "sync": sync, "sleep2": sleep2}
    program = Program(translate(text, blocking_names(functions)), functions)
    for _ in range(cycles):
        if not program.ended:
            program.step()
    return said, program


def said_by(body: str, cycles: int = 20) -> list[Any]:
    said, program = run(f"def prog():\n{body}\nend\n", cycles)
    assert program.failure is None
    return said


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("1 + 2 * 3", 7),
        ("(1 + 2) * 3", 9),
        ("2 - 3 - 4", -5),
        ("-2 ^ 2", -4),
        ("7 % 4", 3),
        ("-7 % 4", -3),
        ("1 / 4", 0.25),
        ("1e-3", 0.001),
        ("007", 7),
        ("not True or True", True),
        ("True xor True", False),
        ("1 < 2 and 2 < 1", False),
        ("[1, 2, 3][1]", 2),
        ("p[1, 2, 3, 4, 5, 6][5]", 6),
        ('"end # not a comment"', "end # not a comment"),
        ("[[1, 2], [3, 4]][1, 0]", 3),
        ("(1 +\n  2)", 3),
    ],
)
def test_an_expression_has_its_value(expression, value):
    assert said_by(f"say({expression})") == [value]


def test_a_value_may_stand_on_the_line_after_a_comment_and_the_next_statement_follow_it():
    # How the client injects its register offsets.
    text = "global a = # offset\n24    global b = # offset\n7    global c = 2\nsay(a + b + c)"
    assert said_by(text) == [33]


def test_words_python_reserves_and_words_of_its_library_are_ordinary_names():
    text = "async = 1\ntype = 2\ntime = 3\nlambda = 4\nclass = 5\nsay(async+type+time+lambda+class)"
    assert said_by(text) == [15]


def test_p_is_a_name_unless_six_numbers_follow_it():
    text = """
    def scale(p, factor):
        p[0] = p[0] * factor
        return p
    end
    q = p[1, 2, 3, 4, 5, 6]
    say(scale(q, 10)[0])
    say(q[0])
    """
    assert said_by(text) == [10, 1]


def test_a_global_is_shared_and_every_other_name_is_local():
    text = """
    global shared = 1
    own = 1
    def change():
        shared = 2
        own = 2
        return 0
    end
    change()
    say(shared)
    say(own)
    """
    assert said_by(text) == [2, 1]


def test_lists_are_copied_on_assignment():
    assert said_by("a = [1, 2]\nb = a\nb[0] = 9\nsay(a[0])") == [1]


def test_branches_and_loops():
    text = """
    n = 0
    while n < 10:
        n = n + 1
        if n == 2:
            continue
        elif n == 5:
            break
        else:
            say(n)
        end
    end
    """
    assert said_by(text) == [1, 3, 4]


def test_an_end_may_stand_directly_before_an_elif():
    assert said_by("if False: if True: say(1) end elif True: say(2) end") == [2]


def test_a_function_that_takes_time_gives_its_result_when_it_is_over():
    assert said_by("say(sleep2(t=5) + 1)", cycles=2) == []
    assert said_by("say(sleep2(t=5) + 1)", cycles=3) == [6]


def test_bare_statements_are_a_program():
    said, program = run("say(1)\nsay(2)\n")
    assert said == [1, 2]
    assert program.name == "unnamed"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("def f():\n x = \nend\n", "line 3: a value is expected, not 'end'"),
        ("def f():\n say(1)\n", "line 3: an `end` is missing, not the end of the program"),
        ("def f():\n x ? 1\nend\n", "line 2: '?' is not part of URScript"),
        ("def f():\n x.y()\nend\n", "line 2: '.' is not part of URScript"),
        ("def f():\nend\nsay(1)\n", "line 3: the program goes on after its end"),
        ("sec f():\nend\n", "secondary programs are not supported"),
        ("x = run nobody()\n", "line 1: there is no thread 'nobody' to run"),
        ("x = " + "(" * 100 + "1" + ")" * 100, "nested more than 40 deep"),
        ("x = 1e999\n", "too large"),
        ("say(a=1, 2)\n", "a positional argument cannot follow a named one"),
        ("break\n", "too large or too deeply nested"),
    ],
)
def test_what_is_no_program_is_refused_with_a_sentence(text, words):
    with pytest.raises(ScriptError) as caught:
        translate(text, frozenset())
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("open(1)", "open() is not supported by this stand-in controller"),
        ("eval(1)", "eval() is not supported by this stand-in controller"),
        ("say(missing)", "'missing' has no value yet"),
        ("def late():\n say(x)\n x = 1\nend", "'x' has no value yet"),
        ("if [1] < 2:\n say(1)\nend", "these two cannot be compared with <"),
        ("say(1 / 0)", "a division by zero"),
        ("say([1][3])", "index 3 is outside a list of 1"),
        ("say([1][0 - 1])", "index -1 is outside a list of 1"),
        ('say("a" * 1000000000)', "a number is expected here"),
        ("say(2000000000 * 2)", "does not fit a 32-bit integer"),
        ("say(2 ^ 1000000)", "line 1"),
        ("x = 1\nx[0] = 2", "1 has no elements"),
        ("while True:\nx = 1\nend", "an endless loop"),
        ("x = 1\ndef f():\nreturn f()\nend\nsay(f())", "functions call each other without end"),
        ("say(__builtins__)", "'__builtins__' has no value yet"),
        ("say(_call)", "'_call' has no value yet"),
        ("sync(1, t=3)", "line 1 of unnamed: sync() cannot be called as sync(…, t=…)"),
    ],
)
def test_a_mistake_ends_the_program_with_a_sentence_and_nothing_else(text, words):
    _, program = run(text)
    assert program.ended
    assert program.failure is not None
    assert words in program.failure


def test_the_line_of_a_mistake_is_named():
    _, program = run("def prog():\n\n # a comment\n say(1)\n say(1 / 0)\nend\n")
    assert program.failure is not None
    assert program.failure.startswith("line 5 of prog: ")


@given(st.text(alphabet=string.printable, max_size=200))
def test_any_text_is_translated_or_refused(text):
    with contextlib.suppress(ScriptError):
        assert translate(text, frozenset(("sync",))).name


_NAMES = st.sampled_from(
    [*sorted(KEYWORDS), "x", "p", "f", "[", "]", "(", ")", "=", ":", "\n", "1"]
)


@given(st.lists(_NAMES, max_size=40))
def test_any_words_of_the_language_are_translated_or_refused(words):
    with contextlib.suppress(ScriptError):
        assert translate(" ".join(words), frozenset()).name


@given(st.text(alphabet="ab1 \n#=", max_size=60))
def test_tokens_know_their_lines(text):
    for token in tokenise(text):
        if token.kind not in ("newline", "end of text"):
            assert token.text in text.split("\n")[token.line - 1]
