"""The TextMate grammar of the language, for editors that colour by regular expressions.

It is made of the language's own tables, so that it cannot drift from them:
`python -m icarus_lite.language.textmate FILE` writes it, and a test checks what is written. The
language server colours more finely, by meaning; this is what is seen before it answers.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterable
from pathlib import Path

from icarus_lite.language.functions import FUNCTIONS
from icarus_lite.language.keywords import FIELDS, FORMS, MOMENTS, NOT

_NAME = r"[^\s()\"';?:^*|#]+"
_END = r"(?=[\s()\"';]|$)"
_NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"


def textmate_grammar() -> dict[str, object]:
    """Give the grammar as the object that its JSON file holds."""
    return {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": "ICARUS",
        "scopeName": "source.icarus",
        "fileTypes": ["icr"],
        "patterns": _patterns(),
    }


def _patterns() -> list[dict[str, object]]:
    older = [name for name, keyword in {**FORMS, **FIELDS}.items() if keyword.modern]
    fields = [name for name in FIELDS if name not in older]
    return [
        _between("comment.block.icarus", r"#\|", r"\|#"),
        _match("comment.line.semicolon.icarus", r";.*$"),
        _between(
            "string.quoted.double.icarus",
            '"',
            '"',
            [_match("constant.character.escape.icarus", r"\\.")],
        ),
        # A form's name is a keyword at the start of a form only; at the margin it begins one.
        _match(
            "keyword.declaration.form.icarus",
            rf"(?<=^\(){_one_of(n for n in FORMS if n not in older)}{_END}",
        ),
        _match(
            "keyword.declaration.form.icarus invalid.deprecated.icarus",
            rf"(?<=^\(){_one_of(n for n in FORMS if n in older)}{_END}",
        ),
        _match("keyword.other.field.icarus", rf"{_one_of(fields)}{_END}"),
        _match(
            "keyword.other.field.icarus invalid.deprecated.icarus",
            rf"{_one_of(n for n in older if n.startswith(':'))}{_END}",
        ),
        _match("invalid.illegal.field.icarus", rf":{_NAME}{_END}"),
        _match("keyword.operator.logical.icarus", rf"(?<=\(){NOT.name}{_END}"),
        _match(
            "support.function.icarus",
            rf"(?<=\(){_one_of(name for name in FUNCTIONS if name != NOT.name)}{_END}",
        ),
        _match("constant.language.moment.icarus", _moments()),
        _match("support.function.command.icarus", rf"(?<=\()\*{_NAME}{_END}"),
        _match("variable.other.icarus", rf"\?{_NAME}{_END}"),
        _match("variable.other.property.icarus", rf"[\^*]{_NAME}{_END}"),
        _match("constant.numeric.icarus", rf"(?<![^\s()\"';]){_NUMBER}{_END}"),
        _match("entity.name.function.head.icarus", rf"(?<=\(\(){_NAME}{_END}"),
        _match("entity.name.type.icarus", rf"(?<=\(){_NAME}{_END}"),
        _match("constant.other.symbol.icarus", rf"{_NAME}{_END}"),
        _match("punctuation.section.parens.icarus", r"[()]"),
    ]


def _moments() -> str:
    """Match what `:break` may say; behind a parenthesis, only where no pattern can be meant."""
    names = _one_of(name for moments in MOMENTS.values() for name in moments)
    return rf"(?:(?<!\(){names}{_END}|(?<=\(){names}(?=\s*\)|\s+{names}{_END}))"


def _match(scope: str, pattern: str) -> dict[str, object]:
    return {"name": scope, "match": pattern}


def _between(
    scope: str, begin: str, end: str, patterns: list[dict[str, object]] | None = None
) -> dict[str, object]:
    found: dict[str, object] = {"name": scope, "begin": begin, "end": end}
    return {**found, "patterns": patterns} if patterns else found


def _one_of(words: Iterable[str]) -> str:
    """Match any of some words, the longest first."""
    escaped = [re.escape(word).replace(r"\-", "-") for word in sorted(words, key=len)[::-1]]
    return f"(?:{'|'.join(escaped)})"


def written(grammar: dict[str, object]) -> str:
    """Give the text of the grammar's file."""
    return json.dumps(grammar, indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(written(textmate_grammar()), encoding="utf-8")
