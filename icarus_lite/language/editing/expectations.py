"""Which words of the language may stand at a place, asked of the parser itself.

What was written before the place may be broken. Only what the answer depends on is shown to the
parser: the parentheses that are open there, the words that begin them, and the field in question.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from icarus_lite.language.editing.lexemes import Kind, Lexeme
from icarus_lite.language.editing.nesting import Group, Node
from icarus_lite.language.keywords import FORMS, Content
from icarus_lite.language.reading.parts import MalformedTermError

_KEYWORD = re.compile(r"(:?[a-z][a-z-]*)\(\?!")
_HEAD = "(x)"


def accepted(chain: Sequence[Group]) -> frozenset[str]:
    """Give the terminals of the grammar that may come next, or none if nothing sensible can.

    Args:
        chain: The groups open at the place, outermost first, each with what stands before it.
    """
    # Lark takes longer to import than everything else here, and highlighting has no use for it.
    from lark import UnexpectedInput  # noqa: PLC0415

    from icarus_lite.language.reading.parsing import parser  # noqa: PLC0415

    parse: Any = parser().parse_interactive(skeleton(chain), start="file")
    try:
        parse.exhaust_lexer()
    except (UnexpectedInput, MalformedTermError):
        return frozenset()
    return frozenset(parse.accepts())


@functools.cache
def keyword_terminals() -> Mapping[str, str]:
    """Give the keywords of the grammar, by the names of their terminals."""
    from icarus_lite.language.reading.parsing import parser  # noqa: PLC0415

    found = {}
    for terminal in parser().terminals:
        match = _KEYWORD.match(terminal.pattern.value)
        if match:
            found[terminal.name] = match[1]
    return MappingProxyType(found)


def skeleton(chain: Sequence[Group]) -> str:
    """Write the open groups with just enough of what is in them for the parser to know its way.

    Example:
        The text `(concepts ((near ?a ?b) :tests (…) :elements ((object ?a ` gives
        `(concepts ((x) :elements ((object ?a `.
    """
    words: list[str] = []
    for depth, group in enumerate(chain):
        is_last = depth == len(chain) - 1
        items = group.items if is_last else group.items[:-1]
        words += ["(", *_words(items, is_clause=depth == 1 and _has_clauses(chain[0]))]
    return " ".join([*words, ""])


def _has_clauses(form: Group) -> bool:
    keyword = FORMS.get(form.first.text) if form.first else None
    return keyword is not None and keyword.content is Content.CLAUSES


def _words(items: Sequence[Node], *, is_clause: bool) -> list[str]:
    words: list[str] = []
    if is_clause and items and isinstance(items[0], Group):
        words.append(_HEAD)
        items = items[1:]
    fields = [i for i, item in enumerate(items) if _is_field(item)]
    before = items[: fields[0]] if fields else items
    words += [item.text for item in before if isinstance(item, Lexeme)]
    if fields and fields[-1] == len(items) - 1:
        words += [item.text for item in items[-1:] if isinstance(item, Lexeme)]
    return words


def _is_field(item: Node) -> bool:
    return isinstance(item, Lexeme) and item.kind is Kind.FIELD
