"""Mistakes that people bring along from other languages, each with what is written here instead."""

from __future__ import annotations

import re
import unicodedata

from icarus_lite.language.reading.stumbles import (
    FIELD_TERMINALS,
    Context,
    Finding,
    quoted,
    shortened,
)

_COMPARISONS = frozenset({"<", ">", "<=", ">=", "=", "/=", "!=", "=="})
_WITH_CLAUSES = frozenset(
    {"concepts", "skills", "attachments", "contradictions", "create-concepts", "create-skills"}
)
_NAMED = frozenset({"task", "test", "long-term-goal"})
_NO_SENTENCE = frozenset({"", "(", ")"})
_QUOTATION_MARKS = tuple(
    "\N{LEFT DOUBLE QUOTATION MARK}\N{RIGHT DOUBLE QUOTATION MARK}"
    "\N{DOUBLE LOW-9 QUOTATION MARK}\N{LEFT SINGLE QUOTATION MARK}"
    "\N{RIGHT SINGLE QUOTATION MARK}\N{SINGLE LOW-9 QUOTATION MARK}"
    "\N{LEFT-POINTING DOUBLE ANGLE QUOTATION MARK}\N{RIGHT-POINTING DOUBLE ANGLE QUOTATION MARK}"
)
_MARKS = frozenset("^?*:")
_PLAIN = re.compile(r"[^ \t\n\r\f\v()\"';?:^*|#{}\[\]]+\Z")
_INFIX = re.compile(
    r"[ \t]*([^ \t\n()\"';]+)[ \t]+([^ \t\n()\"';]+)[ \t]+([^ \t\n()\"';]+)[ \t]*\)"
)
_LAST_FIELD = re.compile(r":[a-z-]+(?=[ \t\n(])")
_FAR = 400
"""How many characters around a place are looked at."""


def _comment(c: Context) -> Finding | None:
    """`#` of Python and `//` of C begin no comment."""
    is_comment = c.word.startswith("#") or (c.word.startswith(("//", "--")) and c.opening is None)
    if not is_comment:
        return None
    hint = "a comment begins with ; and goes to the end of the line"
    return "ICR009", f"{quoted(c.word)} begins no comment", hint


def _bracket(c: Context) -> Finding | None:
    if c.word[:1] not in ("{", "}", "[", "]"):
        return None
    return "ICR009", f"`{c.word[0]}` is no parenthesis of the language", "all are round: ( and )"


def _unseen(c: Context) -> Finding | None:
    """Characters that look like a blank, or like nothing, and are part of a word."""
    for character in c.word:
        if not character.isascii() and unicodedata.category(character) in ("Zs", "Cf"):
            message = f"a character that looks like a blank is none: U+{ord(character):04X}"
            return "ICR009", message, f"write an ordinary blank instead, in {quoted(c.word)}"
    return None


def _typographic(c: Context) -> Finding | None:
    if c.word[:1] not in _QUOTATION_MARKS:
        return None
    message = f"`{c.word[0]}` is a typographic quotation mark"
    hint = 'strings stand in straight ones: "…"; names need none'
    return "ICR009", message, hint


def _single_quotes(c: Context) -> Finding | None:
    if c.word != "'" or "STRING" not in c.accepts or "SYMBOL" in c.accepts:
        return None
    return "ICR009", "a string does not begin with '", 'strings stand in double quotes: "…"'


def _unquoted(c: Context) -> Finding | None:
    """A title or file name without quotes."""
    wants_string = "STRING" in c.accepts and not c.accepts & {"SYMBOL", "VARIABLE"}
    if not wants_string or not _PLAIN.match(c.word):
        return None
    end = c.text.find(")", c.offset, c.offset + _FAR)
    words = " ".join(re.split(r"[():\n]", c.text[c.offset : max(end, c.offset)])[0].split())
    hint = f'put it into double quotes: "{shortened(words or c.word)}"'
    return "ICR009", f"expected a string, found {quoted(c.word)}", hint


def _documentation(c: Context) -> Finding | None:
    if not c.word.startswith('"'):
        return None
    if c.previous == ":break":
        bare = shortened(c.word.strip('"'))
        return "ICR009", "a moment is a word, not a string", f"write :break {bare}"
    if not c.accepts & FIELD_TERMINALS.keys() or c.form not in _WITH_CLAUSES:
        return None
    hint = "say what the clause means in a comment above it, which begins with ;"
    return "ICR009", "a clause has no string of its own", hint


def _no_colon(c: Context) -> Finding | None:
    fields = [text for name, text in FIELD_TERMINALS.items() if name in c.accepts]
    field = f":{c.word.casefold()}"
    if field not in fields:
        return None
    return "ICR008", f"{quoted(c.word)} has no colon, as fields do", f"write {field}"


def _infix(c: Context) -> Finding | None:
    """`(?x < 3)` for `(< ?x 3)`, in tests and binds."""
    if c.word == "*" and c.head == c.previous and c.head[:1].isdigit():
        hint = f"write (* {shortened(c.head)} ?x)"
        return "ICR009", f"the function comes first, not {quoted(c.head)}", hint
    if not {"TIMES", "SYMBOL"} <= c.accepts or "VARIABLE" in c.accepts:
        return None
    if not c.word.startswith("?"):
        return None
    match = _INFIX.match(c.text, c.offset)
    example = f"({match[2]} {match[1]} {match[3]})" if match else f"(< {shortened(c.word)} 3)"
    message = f"the function comes first, not {quoted(c.word)}"
    return "ICR009", message, f"write {example}"


def _assignment(c: Context) -> Finding | None:
    """`(?y = ?x + 1)` for `(?y (+ ?x 1))`."""
    if not c.head.startswith("?") or c.accepts != {"RPAR"}:
        return None
    hint = f"such as ({shortened(c.head)} (+ ?x 1))"
    return "ICR009", "a bind is a variable and one expression", hint


def _equals_sign(c: Context) -> Finding | None:
    name, sign, value = c.previous.partition("=")
    if not sign or not name.startswith("^") or "VARIABLE" not in c.accepts:
        return None
    message = f"the attribute {quoted(c.previous)} needs a value, not {quoted(c.word)}"
    return "ICR009", message, f"its value stands behind a blank: {name} {value or '?x'}"


def _comparison(c: Context) -> Finding | None:
    """`^x (> 3)` or `^x < 3` inside a pattern."""
    wants_value = "VARIABLE" in c.accepts and "RPAR" not in c.accepts
    as_value = c.word == "(" and wants_value and c.previous.startswith(("^", "*"))
    behind = c.previous in _COMPARISONS and {"HAT", "RPAR"} <= c.accepts and c.word != ")"
    if not as_value and not behind:
        return None
    name = f"{c.previous} ?x" if as_value else "^x ?x"
    sign = c.previous if behind else "<"
    hint = f"name the value and compare it in :tests: {name} … :tests (({sign} ?x 3))"
    return "ICR009", "a pattern compares nothing: it only names values", hint


def _nested(c: Context) -> Finding | None:
    """`(at ?o (+ ?x 1))`: a pattern inside a pattern."""
    inside_pattern = {"VARIABLE", "HAT", "RPAR"} <= c.accepts and "LPAR" not in c.accepts
    if c.word != "(" or not inside_pattern or c.head.casefold() in ("and", "or", "not"):
        return None
    message = "an argument is a variable or a value, nothing in parentheses"
    hint = (
        "a concept computes with :binds; other patterns stand beside this one; "
        'or is a ")" missing before it?'
    )
    return "ICR009", message, hint


def _colon_attribute(c: Context) -> Finding | None:
    is_unknown = c.word.startswith(":") and c.word not in FIELD_TERMINALS.values()
    if not is_unknown or "HAT" not in c.accepts or len(c.word) == 1:
        return None
    message = f"{quoted(c.word)} cannot stand in a pattern"
    return "ICR009", message, f"attributes are marked with a hat: ^{shortened(c.word[1:])}"


def _lone_mark(c: Context) -> Finding | None:
    if c.word not in _MARKS or (c.word == "*" and "TIMES" in c.accepts):
        return None
    what = {
        "?": "a variable has a name: ?obj, or ?_ for anything",
        "^": "its name follows without a blank: ^type",
        "*": "its name follows without a blank: *grasp",
        ":": "its name follows without a blank: :elements",
    }
    return "ICR009", f"`{c.word}` stands alone", what[c.word]


def _star_behind(c: Context) -> Finding | None:
    bare = c.word.rstrip("*")
    if "STAR" not in c.accepts or "HAT" in c.accepts or not c.word.endswith("*") or not bare:
        return None
    return "ICR009", "the star stands before a command, not behind it", f"write *{shortened(bare)}"


def _sign(c: Context) -> Finding | None:
    """`!(held ?h)`, `-(held ?h)` for `(not (held ?h))`."""
    behind = c.offset + len(c.word)
    if c.word not in ("!", "-", "~", "¬") or c.text[behind : behind + 1] != "(":
        return None
    return "ICR009", f"`{c.word}` is no negation", "write (not (holding ?hand ?obj))"


def _capitals(c: Context) -> Finding | None:
    if c.word != "(" or c.head != c.head.upper() or c.head.casefold() != "not":
        return None
    hint = "write (not (holding ?hand ?obj))"
    return "ICR009", f"{quoted(c.head)} stands in capitals, and case matters", hint


def _joined(c: Context) -> Finding | None:
    """`:elements (and (…) (…))` for `:elements ((…) (…))`."""
    field = c.before_opening
    if field not in FIELD_TERMINALS.values() or c.word.casefold() not in ("and", "or"):
        return None
    hint = f"all entries must hold anyway: {field} ((…) (…))"
    if c.word.casefold() == "or":
        hint = f"alternatives are clauses with the same head, one for each: {field} ((…) (…))"
        if field == ":tests":
            hint = f"put a parenthesis around the list as well: {field} ((or (…) (…)))"
    return "ICR009", f"{quoted(c.word)} does not join the entries of `{field}`", hint


def _head(c: Context) -> Finding | None:
    """`(concepts (plug ?o) …)` for `(concepts ((plug ?o) …))`."""
    is_in_form = c.form in _WITH_CLAUSES and not c.before_opening.startswith(":")
    if c.accepts != {"LPAR"} or not is_in_form or not _PLAIN.match(c.word) or c.head != c.word:
        return None
    hint = f"a clause and its head have one each: (({shortened(c.word)} …) :elements (…))"
    return "ICR009", f'a second "(" is missing before {quoted(c.word)}', hint


def _no_list(c: Context) -> Finding | None:
    """`:elements nil`, `:goal held o1`."""
    if c.accepts != {"LPAR"} or c.previous not in FIELD_TERMINALS.values() or c.word == ")":
        return None
    hint = f"write {c.previous} ((…) (…))"
    if c.word.casefold() in ("nil", "none", "null", "false", "t", "true"):
        hint = f"a field with nothing in it is left out; otherwise {hint}"
    return "ICR009", f"`{c.previous}` takes patterns, not {quoted(c.word)}", hint


def _several(c: Context) -> Finding | None:
    """`:goal (held o1) (held o2)` for `:goal ((held o1) (held o2))`."""
    if c.word != "(" or not c.accepts & FIELD_TERMINALS.keys() or c.previous not in _NO_SENTENCE:
        return None
    before = c.text[max((c.opening or 0), c.offset - _FAR) : c.offset]
    fields = _LAST_FIELD.findall(before)
    if not fields:
        return None
    field = fields[-1]
    message = f"a second list stands behind `{field}`"
    return "ICR009", message, f"its entries go into one list: {field} ((…) (…))"


def _nameless(c: Context) -> Finding | None:
    """`(task :goal …)` for `(task fetch :goal …)`."""
    is_at_name = c.is_at_form and c.form in _NAMED and c.previous == c.form
    if not is_at_name or not c.word.startswith((":", "(")):
        return None
    example = '"what it shows"' if c.form == "test" else "NAME"
    return "ICR009", f"the {c.form} has no name", f"write ({c.form} {example} :goal ((…)))"


def _number(c: Context) -> Finding | None:
    if c.accepts != {"NUMBER"}:
        return None
    message = f"`{c.previous}` takes a number, not {quoted(c.word)}"
    return "ICR009", message, f"such as {c.previous} 5, without a unit or parentheses"


HABITS = (
    _comment,
    _bracket,
    _unseen,
    _typographic,
    _single_quotes,
    _unquoted,
    _documentation,
    _no_colon,
    _infix,
    _assignment,
    _equals_sign,
    _comparison,
    _colon_attribute,
    _lone_mark,
    _star_behind,
    _sign,
    _capitals,
    _joined,
    _head,
    _no_list,
    _several,
    _nameless,
    _number,
    _nested,
)
"""What recognises them, the surest first."""
