"""VS Code's own engine colours as the lexer does; where it is not installed, that is said."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOMAINS = sorted((ROOT / "domains").glob("*.icr"))
ODD = """\
#| a comment (of two
lines) |#
(concepts
  ((a\N{GREEK SMALL LETTER BETA} ?x^) :elements ((o ?x *t 1e-3 ^u "s \\" (t)")) :break (on-gain on-loss)))
(skills ((go ?h) :actions ((*go ?h)) :break on-start :tests ((not (< ?h -.5)))))
(task 1.1 "title" :goal (not (a 🦾))) ; (goals)
"""  # noqa: E501 - what is tested is a long line


def load():
    path = ROOT / "editors" / "engines.py"
    spec = importlib.util.spec_from_file_location("engines", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


ENGINES = load()


@pytest.mark.skipif(bool(ENGINES.missing()), reason=ENGINES.missing() or "it is there")
def test_every_word_of_the_shipped_domains_is_coloured_alike(tmp_path):
    odd = tmp_path / "odd.icr"
    odd.write_text(ODD, encoding="utf-8")
    files = [*DOMAINS, odd]
    for path, coloured in zip(files, ENGINES.engine_tokens(files), strict=True):
        found = list(ENGINES.differences(path.read_text(encoding="utf-8"), coloured))
        assert len(found) > 20
        assert [each for each in found if each is not None] == [], path


def test_a_difference_is_seen():
    text = "(goals (a ?x))\n; end"
    alike = [
        (0, 0, 1, "punctuation.section.parens.icarus"),
        (0, 1, 6, "keyword.declaration.form.icarus"),
        (0, 7, 8, "punctuation.section.parens.icarus"),
        (0, 8, 9, "entity.name.type.icarus"),
        (0, 10, 12, "variable.other.icarus"),
        (0, 12, 14, "punctuation.section.parens.icarus"),
        (1, 0, 5, "comment.line.semicolon.icarus"),
    ]
    assert list(ENGINES.differences(text, alike)) == [None] * 8
    other = [*alike[:4], (0, 10, 12, "constant.other.symbol.icarus"), *alike[5:]]
    (found,) = [each for each in ENGINES.differences(text, other) if each is not None]
    assert (found.line, found.word, found.scope) == (1, "?x", "constant.other.symbol.icarus")
    (found,) = [each for each in ENGINES.differences(text, alike[:-1]) if each is not None]
    assert (found.line, found.word, found.scope) == (2, "; end", "none")


def test_it_says_what_is_missing(monkeypatch, tmp_path):
    monkeypatch.setattr(ENGINES.shutil, "which", lambda _: None)
    assert ENGINES.missing().startswith("node is not installed")
    monkeypatch.setattr(ENGINES.shutil, "which", lambda _: "/usr/bin/node")
    monkeypatch.setattr(ENGINES, "EXTENSION", tmp_path)
    assert "make vscode" in ENGINES.missing()
