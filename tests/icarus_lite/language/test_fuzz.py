"""A few hundred of the inputs of `make fuzz`, and files that once kept a parser busy for ever."""

from __future__ import annotations

import importlib.util
import sys
import time
from pathlib import Path

import pytest

from icarus_lite.language import check_domain, parse_domain, render
from icarus_lite.language.syntax import Source

SCRIPT = Path(__file__).parents[3] / "benchmarks" / "fuzz_language.py"


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("fuzz_language", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


def test_wrong_files_are_read_or_explained(script):
    result = script.fuzz(seed=2026, count=500)
    assert [why for _, why in result.failures] == []
    assert sum(result.verdicts.values()) == 500
    assert {name for name, _ in result.verdicts} >= {"mutated forms", "words", "bytes", "patterns"}
    assert any(verdict == "nothing" for _, verdict in result.verdicts)


def test_the_same_seed_gives_the_same_inputs(script):
    assert list(script.inputs(3, 50)) == list(script.inputs(3, 50))
    assert list(script.inputs(3, 50)) != list(script.inputs(4, 50))


def test_a_failure_would_be_noticed(script, monkeypatch):
    def decode(data, path):
        if data != b"(goals (a))":  # with which the script warms up
            raise RecursionError(path)
        return Source(path, "(goals (a))")

    monkeypatch.setattr(script, "decode", decode)
    failures = script.fuzz(seed=2026, count=3).failures
    assert ["RecursionError" in why for _, why in failures] == [True] * 3


def seconds(text):
    """Give the processor time that it takes to read, check and explain a text."""
    begin = time.process_time()
    domain, found = parse_domain(text, "d.icr")
    if domain is not None:
        found = check_domain(domain, thorough=True)
    for each in found:
        render(each, text)
    return time.process_time() - begin


SLOW = {
    "a row of semicolons before a broken form": lambda n: ";" * n + "\n(goals\n\n(gaols (a))\n",
    "a very long word": lambda n: f"(goals (a {'x' * n}(",
    "a very long number": lambda n: f"(goals (a {'7' * n}))",
    "quotes that are escaped, in a string left open": lambda n: '(goals (a "' + '\\"' * n,
    "one broken form among very many": lambda n: "(gaols (a))\n" + "(goals (a b))\n" * (n // 12),
    "very many broken forms": lambda n: "(gaols (a))\n" * (n // 12),
    "very many unknown words in one line": lambda n: (
        "(percepts (a)) (goals" + "".join(f" (word{i} x)" for i in range(n // 12)) + ")"
    ),
    "very many variables in one clause": lambda n: (
        "(percepts (o)) (concepts ((p ?q) :elements ("
        + "".join(f"(o ?v{i})(not (o ?w{i}))" for i in range(n // 24))
        + ")))"
    ),
    "very many unbound variables": lambda n: (
        "(percepts (o)) (concepts ((p ?q) :elements ((not (o ?x))) :tests ("
        + "".join(f"(< ?v{i} 1)" for i in range(n // 12))
        + ")))"
    ),
    "a very long chain of concepts": lambda n: (
        "(concepts "
        + "".join(f"((c{i}) :elements ((c{i + 1})))" for i in range(n // 28))
        + f"((c{n // 28})))"
    ),
    "very many concepts that negate one another": lambda n: (
        "(concepts "
        + "".join(f"((c{i}) :elements ((not (c{(i + 1) % (n // 32)}))))" for i in range(n // 32))
        + ")"
    ),
    "a very long chain of percept types": lambda n: (
        "(percepts" + "".join(f" (t{i} :is t{i + 1} ^a{i})" for i in range(n // 22)) + ")"
    ),
    "very many clauses of one skill, and attachments by it": lambda n: (
        "(skills"
        + "".join(f" ((s c{i}) :actions ((*s)))" for i in range(n // 50))
        + ") (attachments"
        + "".join(f" ((s d{i}) :child d :parent e)" for i in range(n // 50))
        + ")"
    ),
    "a percept type with very many attributes": lambda n: (
        "(percepts (o"
        + "".join(f" ^a{i}" for i in range(n // 20))
        + ")) (goals"
        + "".join(f" (o x ^b{i} 1)" for i in range(n // 20))
        + ")"
    ),
}


_MORE_TRIES = 4


@pytest.mark.parametrize("text", SLOW.values(), ids=SLOW.keys())
def test_ten_times_the_text_takes_about_ten_times_as_long(text):
    seconds("(goals (a))")  # the parser is built once
    small, large = seconds(text(6_000)), seconds(text(60_000))
    # Quadratic time would be a hundredfold; the constant absorbs what is too short to measure.
    for _ in range(_MORE_TRIES):  # a machine that others use as well is slow at times
        if large < 25 * small + 0.3:
            break
        large = min(large, seconds(text(60_000)))
    assert large < 25 * small + 0.3
