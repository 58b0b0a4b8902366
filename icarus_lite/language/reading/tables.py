"""The tables of the parser, made of the grammar beforehand: making them takes a tenth of a second.

They lie in `grammar.json`, beside `grammar.lark`. Whoever changes the grammar makes them anew:

    python -m icarus_lite.language.reading.tables

Tables that were made of another grammar, or by another version of Lark, are not used.
"""

from __future__ import annotations

import json
from importlib import resources
from typing import Any

import lark
from lark import Lark, Transformer
from lark.grammar import Rule
from lark.lexer import TerminalDef

_STARTS = ["file", "conditions", "pattern"]
_HERE = resources.files(__package__)


def build(grammar: str, transformer: Transformer[Any, Any] | None = None) -> Lark:
    """Build the parser from its grammar.

    Args:
        grammar: The text of `grammar.lark`.
        transformer: Turns each rule into what it stands for; left out, there will be trees.
    """
    return Lark(
        grammar,
        parser="lalr",
        lexer="contextual",
        start=_STARTS,
        transformer=transformer,
        maybe_placeholders=False,
        propagate_positions=False,
    )


def grammar_text() -> str:
    """Give the text of `grammar.lark`."""
    return _HERE.joinpath("grammar.lark").read_text(encoding="utf-8")


def load(grammar: str, transformer: Transformer[Any, Any]) -> Lark | None:
    """Give the parser from its tables; None if there are none that fit.

    Args:
        grammar: The text of `grammar.lark`.
        transformer: Turns each rule into what it stands for.
    """
    file = _HERE.joinpath("grammar.json")
    if not file.is_file():
        return None
    made = json.loads(file.read_text(encoding="utf-8"))
    if made["grammar"] != grammar or made["lark"] != lark.__version__:
        return None
    data, memo = made["data"], made["memo"]
    # JSON has no keys but strings.
    table = data["parser"]["parser"]
    table["states"] = {int(state): actions for state, actions in table["states"].items()}
    return Lark._load_from_dict(  # type: ignore[no-any-return,no-untyped-call] # noqa: SLF001 - as the stand-alone parsers of Lark do
        data, {int(key): value for key, value in memo.items()}, transformer=transformer
    )


def tables(grammar: str) -> str:
    """Give the text that `grammar.json` should hold."""
    data, memo = build(grammar).memo_serialize([TerminalDef, Rule])
    made = {"grammar": grammar, "lark": lark.__version__, "data": data, "memo": memo}
    return json.dumps(made, separators=(",", ":")) + "\n"


if __name__ == "__main__":
    from pathlib import Path

    Path(str(_HERE.joinpath("grammar.json"))).write_text(tables(grammar_text()), encoding="utf-8")
