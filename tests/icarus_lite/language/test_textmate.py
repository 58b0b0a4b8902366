"""The TextMate grammar is up to date, and colours the shipped domains as the lexer does.

How VS Code itself reads it is tested where npm is: `make vscode`.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from pygments.token import Comment, Keyword, Name, Number, Operator, String

from icarus_lite.language.highlighting import IcarusLexer
from icarus_lite.language.textmate import textmate_grammar, written

ROOT = Path(__file__).parents[3]
DOMAINS = sorted((ROOT / "domains").glob("*.icr"))
EXTENSION = ROOT / "editors" / "vscode"

SCOPES = {
    "comment.": Comment,
    "string.": String,
    "keyword.declaration.form": Keyword.Declaration,
    "keyword.other.field": Keyword,
    "keyword.operator.logical": Operator.Word,
    "support.function.command": Name.Builtin,
    "support.function.icarus": Name.Builtin.Pseudo,
    "variable.other.property": Name.Attribute,
    "variable.other.icarus": Name.Variable,
    "constant.numeric": Number,
}


def scopes_of(text):
    """Colour a text line by line, as an editor does with a TextMate grammar."""
    patterns = textmate_grammar()["patterns"]
    open_pattern = None
    for line in text.split("\n"):
        column = 0
        found = []
        while column <= len(line):
            if open_pattern is not None:
                end = re.compile(r"\\.|" + open_pattern["end"]).search(line, column)
                while end and end[0].startswith("\\"):
                    end = re.compile(r"\\.|" + open_pattern["end"]).search(line, end.end())
                stop = end.end() if end else len(line)
                found.append((column, stop, open_pattern["name"]))
                if end is None:
                    break
                open_pattern, column = None, stop
                continue
            matches = [
                (match.start(), rank, match, pattern)
                for rank, pattern in enumerate(patterns)
                if (
                    match := re.compile(pattern.get("match") or pattern["begin"]).search(
                        line, column
                    )
                )
            ]
            if not matches:
                break
            _, _, match, pattern = min(matches, key=lambda each: each[:2])
            if "begin" in pattern:
                open_pattern = pattern
                found.append((match.start(), match.end(), pattern["name"]))
            else:
                found.append((match.start(), match.end(), pattern["name"]))
            column = match.end()
        yield found


def kind_of(scope):
    return next((kind for prefix, kind in SCOPES.items() if scope.startswith(prefix)), None)


@pytest.mark.parametrize("path", DOMAINS, ids=lambda path: path.stem)
def test_it_colours_as_the_lexer_does(path):
    text = path.read_text(encoding="utf-8")
    by_offset = {}
    start_of_line = 0
    for line, found in zip(text.split("\n"), scopes_of(text), strict=True):
        for start, stop, scope in found:
            for column in range(start, stop):
                by_offset[start_of_line + column] = scope
        start_of_line += len(line) + 1
    wrong = []
    for start, kind, piece in IcarusLexer().get_tokens_unprocessed(text):
        if kind is Name.Namespace or not piece.strip():
            continue  # a task may be called 1.1, which only meaning tells from a number
        scope = by_offset[start]
        seen = kind_of(scope)
        expected = Comment if kind in Comment else kind if kind in SCOPES.values() else None
        if kind is Name.Builtin.Pseudo and piece == "not":
            expected = Operator.Word  # inside :tests it is a function
        if seen is not expected:
            wrong.append((piece, scope, kind))
    assert not wrong


def test_the_shipped_grammar_is_up_to_date():
    shipped = (EXTENSION / "syntaxes" / "icarus.tmLanguage.json").read_text(encoding="utf-8")
    assert shipped == written(textmate_grammar()), (
        "write it anew: python -m icarus_lite.language.textmate "
        "editors/vscode/syntaxes/icarus.tmLanguage.json"
    )


def test_the_extension_names_files_that_exist():
    package = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    contributed = package["contributes"]
    paths = [package["main"], contributed["languages"][0]["configuration"]]
    paths += [grammar["path"] for grammar in contributed["grammars"]]
    for path in paths:
        assert (EXTENSION / path).is_file(), path
    command = contributed["configuration"]["properties"]["icarus.command"]["default"]
    assert command == ["icarus", "lsp"]
    for path in EXTENSION.glob("*.json"):
        json.loads(path.read_text(encoding="utf-8"))
