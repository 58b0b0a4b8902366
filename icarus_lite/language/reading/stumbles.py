"""Where the parser stopped, with what stands around it, and how to speak of it."""

from __future__ import annotations

import re

from icarus_lite.language.reading.brackets import FORM_NAMES
from icarus_lite.language.reading.lines import Lines
from icarus_lite.language.wording import LONGEST_WORD
from icarus_lite.records import dataclass

_ALSO_FIELDS = {"agents": "AGENTS_FORM"}
FORM_TERMINALS = {
    _ALSO_FIELDS.get(name, name.upper().replace("-", "_")): name for name in FORM_NAMES
}
MODERN_FIELD_TERMINALS = {
    "ELEMENTS": ":elements",
    "TESTS": ":tests",
    "BINDS": ":binds",
    "WHILE": ":while",
    "ACTIONS": ":actions",
    "SUBSKILLS": ":subskills",
    "EFFECTS": ":effects",
    "TIMEOUT": ":timeout",
    "AGENT": ":agent",
    "REQUEST": ":request",
    "COST": ":cost",
    "BREAK_FIELD": ":break",
    "UNTIL": ":until",
    "CHILD": ":child",
    "PARENT": ":parent",
    "CYCLES": ":cycles",
    "IS": ":is",
    "ROBOT": ":robot",
    "AGENTS": ":agents",
    "GOAL": ":goal",
    "INIT": ":init",
    "RELEVANCE": ":relevance",
    "PRIORITY": ":priority",
    "MAINTAIN": ":maintain",
    "ACTION": ":action",
    "EXPECT": ":expect",
    "EXPECT_NOT": ":expect-not",
    "THEN": ":then",
    "PLAN": ":plan",
}
_OLDER = {
    "CONDITIONS": ":conditions",
    "RELATIONS": ":relations",
    "START": ":start",
    "REQUIRES": ":requires",
    "SUBGOALS": ":subgoals",
    "ATTRIBUTES": ":attributes",
}
FIELD_TERMINALS = {**MODERN_FIELD_TERMINALS, **_OLDER, "PERCEPTS_FIELD": ":percepts"}
_BLANKS = " \t\n\r\f\v"
_WORD_ENDS = re.compile(r"[ \t\n\r\f\v()\"';]")


Finding = tuple[str, str, str]
"""A code, a message and a hint."""


@dataclass(frozen=True, slots=True)
class Stumble:
    """Where the parser stopped.

    Args:
        offset: The place in the text of the word it could not take.
        accepts: The terminals of the grammar it would have taken.
        start: The offset at which the form begins.
        rule: The rule of the grammar that the text must match.
        at_end: Whether it ran out of text.
    """

    offset: int
    accepts: frozenset[str]
    start: int
    rule: str = "file"
    at_end: bool = False


@dataclass(frozen=True, slots=True)
class Context:
    """The stumble, with what stands around it.

    Args:
        word: The word that the parser could not take.
        previous: The word before it.
        opening: The offset of the parenthesis that is open there, or None.
        head: The word behind that parenthesis.
        before_opening: The word before it.
        form: The first word of the form.
        is_at_form: Whether that parenthesis begins the form.
        rule: The rule of the grammar that the text must match.
        at_end: Whether the text has ended.
        accepts: The terminals of the grammar that the parser would have taken.
        lines: The lines of the text.
        text: The text.
        offset: The place of the word in it.
    """

    word: str
    previous: str
    opening: int | None
    head: str
    before_opening: str
    form: str
    is_at_form: bool
    rule: str
    at_end: bool
    accepts: frozenset[str]
    lines: Lines
    text: str
    offset: int


def shortened(word: str) -> str:
    """Give a word as it is shown in a message: nobody wants to read a thousand letters."""
    return word if len(word) <= LONGEST_WORD else f"{word[: LONGEST_WORD - 1]}…"


def quoted(word: str) -> str:
    """Write a word as a message has it: a parenthesis or string as it is, a name in ticks."""
    word = shortened(word)
    if word in ("(", ")"):
        return f'"{word}"'
    return word if word.startswith('"') else f"`{word}`"


def last_word(text: str) -> str:
    """Give the last word of a text, or an empty one if a parenthesis or quote ends it."""
    text = text.rstrip(_BLANKS)[-LONGEST_WORD:]
    return _WORD_ENDS.split(text)[-1]


def legal_fields(accepts: frozenset[str]) -> list[str]:
    """List the fields that may stand here, by their modern names, in the grammar's order."""
    if "ACTIONS" in accepts:
        accepts -= {"ACTION"}  # in a skill it is an older name
    fields = [text for terminal, text in MODERN_FIELD_TERMINALS.items() if terminal in accepts]
    is_test = "EXPECT" in accepts
    return [":percepts", *fields] if is_test else fields
