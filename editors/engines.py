"""Are domains coloured alike by VS Code's own engine and by the lexer for Pygments?

    python editors/engines.py domains/*.icr

The engine, `vscode-textmate` with `vscode-oniguruma`, runs in Node; `make vscode` installs it. Each
word of each file is compared.
"""  # noqa: INP001 - a script, no package

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from pygments.token import (
    Comment,
    Error,
    Keyword,
    Literal,
    Name,
    Number,
    Operator,
    Punctuation,
    String,
    _TokenType,
)

from icarus_lite.language.highlighting import IcarusLexer

EXTENSION = Path(__file__).resolve().parent / "vscode"

SCOPES: Mapping[_TokenType, tuple[str, ...]] = {
    Comment.Single: ("comment.line.",),
    Comment.Multiline: ("comment.block.",),
    Keyword.Declaration: ("keyword.declaration.form.",),
    Keyword.Constant: ("constant.language.moment.",),
    Keyword: ("keyword.other.field.", "invalid.illegal.field."),
    Operator.Word: ("keyword.operator.logical.",),
    # Inside :tests `not` is a function; expressions know nothing of where they stand.
    Name.Builtin.Pseudo: ("support.function.icarus", "keyword.operator.logical."),
    Name.Builtin: ("support.function.command.",),
    Name.Attribute: ("variable.other.property.",),
    Name.Variable: ("variable.other.icarus",),
    # Only meaning tells a concept from a skill, and its definition from its use.
    Name.Class: ("entity.name.function.head.", "entity.name.type."),
    Name.Function: ("entity.name.function.head.", "entity.name.type."),
    Literal: ("constant.other.symbol.",),
    Number: ("constant.numeric.",),
    String: ("string.", "constant.character.escape."),
    # The name of a task may look like a number, that of a test is a string.
    Name.Namespace: ("constant.other.symbol.", "constant.numeric.", "string.", "constant.char"),
    Punctuation: ("punctuation.section.parens.",),
}
"""The scopes that words of a kind may have, by the beginnings of their names."""


@dataclass(frozen=True, slots=True)
class Difference:
    """A word that the two colour differently; lines count from 1."""

    line: int
    word: str
    kind: str
    scope: str


def missing() -> str:
    """Say in a sentence why the engine cannot run here; an empty text if it can."""
    if shutil.which("node") is None:
        return "node is not installed: the colours of VS Code's engine are not compared"
    if not (EXTENSION / "node_modules" / "vscode-textmate").is_dir():
        return "VS Code's engine is not installed: `make vscode` fetches it with npm"
    return ""


def engine_tokens(files: Sequence[Path]) -> list[list[tuple[int, int, int, str]]]:
    """Give what the engine says of each file: line, start, end and innermost scope.

    Raises:
        RuntimeError: The engine fails; the message is its own.
    """
    script = str(EXTENSION / "tests" / "tokens.js")
    node = shutil.which("node") or "node"
    command = [node, script, *map(str, files)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)  # noqa: S603
    if done.returncode:
        raise RuntimeError(done.stderr)
    found: list[list[tuple[int, int, int, str]]] = json.loads(done.stdout)
    return found


def differences(
    text: str, coloured: Sequence[tuple[int, int, int, str]]
) -> Iterator[Difference | None]:
    """Compare each word of a text; gives None for a word that both colour alike."""
    by_line: dict[int, list[tuple[int, int, str]]] = {}
    for line, start, end, scope in coloured:
        by_line.setdefault(line, []).append((start, end, scope))
    line = column = 0
    for _, kind, piece in IcarusLexer().get_tokens_unprocessed(text):
        for number, part in enumerate(piece.split("\n")):
            if number:
                line, column = line + 1, 0
            width = len(part.encode("utf-16-le")) // 2
            if part.strip() and kind is not Error:
                scopes = [
                    s for a, b, s in by_line.get(line, []) if a < column + width and column < b
                ]
                wrong = [scope for scope in scopes if not scope.startswith(SCOPES[kind])]
                if wrong or not scopes:
                    yield Difference(line + 1, part, str(kind), ", ".join(wrong) or "none")
                else:
                    yield None
            column += width


def main() -> int:
    """Compare some files; the exit status is 1 if there are differences."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("files", type=Path, nargs="+")
    files = parser.parse_args().files
    why = missing()
    if why:
        sys.stderr.write(f"{why}\n")
        return 0
    total = 0
    different: list[str] = []
    for path, coloured in zip(files, engine_tokens(files), strict=True):
        found = list(differences(path.read_text(encoding="utf-8"), coloured))
        total += len(found)
        different += [
            f"{path}:{each.line}: `{each.word}` is {each.kind}, the engine says {each.scope}"
            for each in found
            if each is not None
        ]
    different.append(f"{len(files)} files, {total} words, {len(different)} coloured differently")
    sys.stdout.write("\n".join(different) + "\n")
    return 1 if len(different) > 1 else 0


if __name__ == "__main__":
    sys.exit(main())
