"""Every question about any text has an answer: none raises, whatever the text looks like."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from icarus_lite.language.editing import File, Index, RenameError
from runtime.lsp import answers
from runtime.lsp.colours import semantic_tokens
from runtime.lsp.documents import Project
from runtime.lsp.findings import findings

DOMAINS = Path(__file__).parents[3] / "domains"
MARKS = ["(", ")", "((", '"', "#|", "|#", "^", "?", "*", ":elements", " :is ", "not", ";", "'"]
PIECES = ["", *MARKS, "\0", "🦾", "\r", "\u2028", "(concepts\n", "\n(skills ", '(include "x']


def mutated(text, randomness):
    for _ in range(randomness.randint(1, 8)):
        start = randomness.randint(0, len(text))
        stop = min(len(text), start + randomness.choice([0, 1, 3, 20, 200]))
        text = text[:start] + randomness.choice(PIECES) + text[stop:]
    return text


def project_of(text, path):
    return Project(path, Index([File.read(path, text)]), {path: f"file://{path}"}, "utf-16")


@pytest.mark.parametrize("seed", range(20))
def test_no_question_about_a_broken_text_raises(seed, tmp_path):
    randomness = random.Random(seed)
    path = str(tmp_path / "broken.icr")
    original = randomness.choice(sorted(DOMAINS.glob("*.icr"))).read_text(encoding="utf-8")
    text = mutated(original, randomness)
    project = project_of(text, path)
    assert len(semantic_tokens(project).data) % 5 == 0
    answers.symbols(project)
    answers.formatting(project)
    findings(project)
    for _ in range(10):
        position = project.positions().position(randomness.randint(0, len(text)))
        answers.hover(project, position, ())
        used = answers.references(project, position, with_definitions=True)
        assert all(each in used for each in answers.definition(project, position))
        assert len(answers.highlights(project, position)) == len(used)
        answers.completion(project, position, ("grasp",))
        try:
            edit = answers.renaming(project, position, "quite-new")
        except RenameError as refusal:
            assert str(refusal)  # noqa: PT017 - most places hold no name
        else:
            assert len(edit.changes[f"file://{path}"]) == len(used)


@pytest.mark.parametrize("text", ["", "\n", "; nothing\n", "(", '"', "\0", "(" * 3000])
def test_the_smallest_and_the_oddest_texts(text):
    project = project_of(text, "/nowhere/odd.icr")
    end = project.positions().position(len(text))
    answers.hover(project, end, ())
    answers.symbols(project)
    answers.completion(project, end, ())
    assert any(each.severity == 1 for each in findings(project))
