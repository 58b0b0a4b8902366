"""What a syntax error means, said in the words of the language.

The parser knows which words it would have accepted at the place of the error; together with the
parenthesis that is open there, this is enough to say what was expected and what to write.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import islice

from icarus_lite.language.diagnostics import Diagnostic, Severity
from icarus_lite.language.reading.brackets import (
    FORM_NAMES,
    MODERN_FORMS,
    Lines,
    first_word,
    innermost_open,
)
from icarus_lite.language.reading.older import GONE_FIELDS, GONE_FORMS
from icarus_lite.language.syntax import Span

_FORMS = {name.upper().replace("-", "_"): name for name in FORM_NAMES}
_MODERN_FIELDS = {
    "ELEMENTS": ":elements",
    "TESTS": ":tests",
    "BINDS": ":binds",
    "WHILE": ":while",
    "ACTIONS": ":actions",
    "SUBSKILLS": ":subskills",
    "EFFECTS": ":effects",
    "TIMEOUT": ":timeout",
    "UNTIL": ":until",
    "CHILD": ":child",
    "PARENT": ":parent",
    "IS": ":is",
    "ROBOT": ":robot",
    "AGENTS": ":agents",
    "GOAL": ":goal",
    "RELEVANCE": ":relevance",
    "PRIORITY": ":priority",
    "ACTION": ":action",
    "EXPECT": ":expect",
    "EXPECT_NOT": ":expect-not",
    "THEN": ":then",
    "PLAN": ":plan",
}
_OLDER_FIELDS = {
    "CONDITIONS": ":conditions",
    "RELATIONS": ":relations",
    "START": ":start",
    "REQUIRES": ":requires",
    "SUBGOALS": ":subgoals",
    "ATTRIBUTES": ":attributes",
}
_FIELDS = {**_MODERN_FIELDS, **_OLDER_FIELDS, "PERCEPTS_FIELD": ":percepts"}
_PHRASES = {
    "LPAR": '"("',
    "RPAR": '")"',
    "VARIABLE": "a variable",
    "SYMBOL": "a name",
    "NUMBER": "a number",
    "STRING": "a string",
    "HAT": "an attribute",
    "TIMES": "`*`",
    "NOT": "`not`",
}
_LONGEST_WORD = 60
_LONGEST_LIST = 20
_VALUES = "a variable, a name, a number or a string"
_WORD = re.compile(r'"[^"\\]*(?:\\[\s\S][^"\\]*)*"|[()\']|[^ \t\n\r\f\v()"\';]+')
_LEGAL_WORD = re.compile(r'[()"\']|[?^:*]?[^ \t\n\r\f\v()"\';?:^*|#]+\Z|\*\Z')
_BLANKS = " \t\n\r\f\v"
_WORD_ENDS = re.compile(r"[ \t\n\r\f\v()\"';]")


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
class _Context:
    """The stumble, with what stands around it."""

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


_Finding = tuple[str, str, str]  # code, message, hint


def explain(stumble: Stumble, text: str, path: str, lines: Lines) -> Diagnostic:
    """Say what is wrong at the place where the parser stopped."""
    match = None if stumble.at_end else _WORD.match(text, stumble.offset)
    word = match[0] if match else ""
    opening = innermost_open(text, stumble.start, stumble.offset)
    context = _Context(
        word=word,
        previous=_last_word(text[stumble.start : stumble.offset]),
        opening=opening,
        head="" if opening is None else first_word(text, opening),
        before_opening="" if opening is None else _last_word(text[stumble.start : opening]),
        form=first_word(text, max(text.find("(", stumble.start), 0)),
        is_at_form=opening is not None and not text[stumble.start : opening].strip(),
        rule=stumble.rule,
        at_end=stumble.at_end,
        accepts=stumble.accepts,
        lines=lines,
    )
    for finder in _FINDERS:
        finding = finder(context)
        if finding is not None:
            code, message, hint = finding
            span = _place(lines, stumble.offset, word)
            return Diagnostic(path, span, Severity.ERROR, code, message, hint)
    raise AssertionError("the last finder always finds something")


def stands_inside(stumble: Stumble, text: str) -> int | None:
    """Give the parenthesis that a misplaced field shows to be unclosed, if that is the trouble."""
    match = _WORD.match(text, stumble.offset)
    is_field = match is not None and match[0] in _FIELDS.values()
    if is_field and not stumble.accepts & _FIELDS.keys():
        return innermost_open(text, stumble.start, stumble.offset)
    return None


def closest(word: str, candidates: Iterable[str]) -> str | None:
    """Give the candidate that the word was probably meant to be, or None."""
    if len(word) > _LONGEST_WORD:
        return None
    alike = [each for each in candidates if 3 * len(each) >= len(word) >= len(each) / 3]
    near = difflib.get_close_matches(word, alike, n=1, cutoff=0.6)
    return near[0] if near else None


def shortened(word: str) -> str:
    """Give a word as it is shown in a message: nobody wants to read a thousand letters."""
    return word if len(word) <= _LONGEST_WORD else f"{word[: _LONGEST_WORD - 1]}…"


def listing(words: Iterable[str], last: str = "and") -> str:
    """Write words as `a, b and c`; of more than twenty, the first ones."""
    words = list(islice(words, _LONGEST_LIST + 1))
    if len(words) > _LONGEST_LIST:
        words, last = [*words[: _LONGEST_LIST - 1], "so on"], "and"
    return f" {last} ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _last_word(text: str) -> str:
    text = text.rstrip(_BLANKS)[-_LONGEST_WORD:]
    return _WORD_ENDS.split(text)[-1]


def _place(lines: Lines, offset: int, word: str) -> Span:
    return lines.span(offset, offset + max(len(word), 1))


def _quoted(word: str) -> str:
    word = shortened(word)
    if word in ("(", ")"):
        return f'"{word}"'
    return word if word.startswith('"') else f"`{word}`"


def _outside(context: _Context) -> _Finding | None:
    if context.opening is not None:
        return None
    if context.rule != "file":
        hint = "write a pattern such as (holding ?hand ?obj)"
        if context.at_end:
            return "ICR006", "there is nothing to read", hint
        return "ICR009", f"{_quoted(context.word)} cannot stand here", hint
    hint = f"a file is a sequence of forms: {listing(f'({name} …)' for name in MODERN_FORMS)}"
    if context.word.startswith((":", "(")):
        hint = f'is there a ")" too many before it? {hint}'
    return "ICR009", f"{_quoted(context.word)} stands outside of every form", hint


def _gone(context: _Context) -> _Finding | None:
    """Say what became of a construct of an older dialect."""
    if context.word in GONE_FIELDS and context.accepts & _FIELDS.keys():
        message = f"`{context.word}` is a field of older dialects that has no place here"
        return "ICR037", message, GONE_FIELDS[context.word]
    if context.word in GONE_FORMS and context.accepts & _FORMS.keys():
        message = f"`{context.word}` is a form of older dialects that has no place here"
        return "ICR037", message, GONE_FORMS[context.word]
    return None


def _unknown_form(context: _Context) -> _Finding | None:
    if not context.accepts & _FORMS.keys():
        return None
    hint = f"the forms are {listing(MODERN_FORMS)}"
    if context.word == "(":
        hint = f'is there a ")" too many before it? {hint}'
    if context.word in ("(", ")"):
        return "ICR007", f"a form begins with its name, not with {_quoted(context.word)}", hint
    meant = closest(context.word, FORM_NAMES)
    if meant:
        hint = f"did you mean `{meant}`? {hint}"
    return "ICR007", f"there is no form {_quoted(context.word)}", hint


def _legal_fields(accepts: frozenset[str]) -> list[str]:
    """List the fields that may stand here, by their modern names, in the grammar's order."""
    if "ACTIONS" in accepts:
        accepts -= {"ACTION"}  # in a skill it is an older name
    fields = [text for terminal, text in _MODERN_FIELDS.items() if terminal in accepts]
    is_test = "EXPECT" in accepts
    return [":percepts", *fields] if is_test else fields


def _unknown_field(context: _Context) -> _Finding | None:
    if not context.word.startswith(":") or not context.accepts & _FIELDS.keys():
        return None
    hint = f"the fields here are {listing(_legal_fields(context.accepts))}"
    if context.word in _FIELDS.values():
        return "ICR008", f"`{context.word}` is not a field of this form", hint
    accepted = [text for terminal, text in _FIELDS.items() if terminal in context.accepts]
    meant = closest(context.word, accepted)
    if meant:
        hint = f"did you mean `{meant}`? {hint}"
    return "ICR008", f"there is no field `{context.word}`", hint


def _misplaced_field(context: _Context) -> _Finding | None:
    if not context.word.startswith(":") or context.opening is None:
        return None
    message = f"`{context.word}` cannot stand here"
    if context.is_at_form:
        return "ICR009", message, 'is there a ")" too many before it? no clause is open'
    place = context.lines.span(context.opening, context.opening + 1)
    hint = f'is a ")" missing before it? the "(" at {place.line}:{place.column} is still open'
    return "ICR009", message, hint


def _quote(context: _Context) -> _Finding | None:
    if context.word != "'":
        return None
    return "ICR009", "nothing is quoted in this language", "names stand for themselves: omit the '"


def _illegal_word(context: _Context) -> _Finding | None:
    if not context.word or _LEGAL_WORD.match(context.word):
        return None
    return (
        "ICR009",
        f"`{context.word}` is not a word of the language",
        'names hold none of ? : ^ * | # after their first character; a string "…" may hold any',
    )


def _variable_first(context: _Context) -> _Finding | None:
    wants_name = "SYMBOL" in context.accepts and "VARIABLE" not in context.accepts
    if not wants_name or not context.word.startswith("?"):
        return None
    return (
        "ICR009",
        f"a pattern begins with a name, not with {_quoted(context.word)}",
        f"write (object {shortened(context.word)} ^type plug), also for (?o is (object …)) of old",
    )


def _junction(context: _Context) -> _Finding | None:
    # In :tests, `and` and `or` are functions, which the parser takes.
    if context.head not in ("and", "or") or context.word != "(":
        return None
    hint = "all elements must hold anyway: write them one after another"
    if context.head == "or":
        hint = "alternatives are clauses with the same head: write one for each"
    return "ICR009", f"there is no `{context.head}` of patterns", hint


def _not(context: _Context) -> _Finding | None:
    if context.head != "not":
        return None
    if "VARIABLE" in context.accepts and "LPAR" not in context.accepts and context.word == "(":
        hint = ":elements, :while, :effects and goals take `not`; tests have :expect-not"
        return "ICR009", "`not` cannot stand here", hint
    # In :tests, `not` is a function, whose arguments the parser takes one after another.
    if "VARIABLE" in context.accepts:
        return None
    return (
        "ICR009",
        "`not` takes exactly one pattern, in parentheses",
        "write (not (holding ?hand ?obj)); two patterns need a `not` each",
    )


def _attribute_value(context: _Context) -> _Finding | None:
    wants_value = "VARIABLE" in context.accepts and "RPAR" not in context.accepts
    if not wants_value or not context.previous.startswith(("^", "*")):
        return None
    return (
        "ICR009",
        f"the attribute `{context.previous}` needs a value, not {_quoted(context.word)}",
        f"a value is {_VALUES}",
    )


def _late_argument(context: _Context) -> _Finding | None:
    after_attributes = "HAT" in context.accepts and "VARIABLE" not in context.accepts
    if not after_attributes or context.word in ("(", ")"):
        return None
    if context.form == "percepts":
        message = f"expected an attribute, found {_quoted(context.word)}"
        return "ICR009", message, "attributes are marked with a hat: (object ^type ^x ^y)"
    return (
        "ICR009",
        f"{_quoted(context.word)} stands after an attribute and its value",
        "positional arguments come first: (object ?obj ^type plug)",
    )


def _bare_list(context: _Context) -> _Finding | None:
    field = context.before_opening
    if field not in _FIELDS.values() or "LPAR" not in context.accepts:
        return None
    return (
        "ICR009",
        f"`{field}` takes a list, but its first entry is {_quoted(context.word)}",
        f"put a parenthesis around the list as well: {field} ((…) (…))",
    )


def _generic(context: _Context) -> _Finding | None:
    fields = _legal_fields(context.accepts)
    if fields:
        expected = ['")"'] if "RPAR" in context.accepts else []
        hint = f"the fields here are {listing(fields)}"
        message = f"expected {listing(['a field', *expected], 'or')}, found {_quoted(context.word)}"
        return "ICR009", message, hint
    phrases = [text for name, text in _PHRASES.items() if name in context.accepts]
    if "STAR" in context.accepts and "HAT" not in context.accepts:
        phrases.append("a command such as `*grasp`")
    found = _quoted(context.word) if context.word else "the end"
    return "ICR009", f"expected {listing(phrases, 'or')}, found {found}", ""


_FINDERS = (
    _outside,
    _gone,
    _unknown_form,
    _unknown_field,
    _misplaced_field,
    _quote,
    _illegal_word,
    _variable_first,
    _junction,
    _not,
    _attribute_value,
    _late_argument,
    _bare_list,
    _generic,
)
