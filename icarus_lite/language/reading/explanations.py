"""What a syntax error means, said in the words of the language.

The parser knows which words it would have accepted at the place of the error; together with the
parenthesis that is open there, this is enough to say what was expected and what to write.
"""

from __future__ import annotations

import re

from icarus_lite.language.diagnostics import Diagnostic, Severity
from icarus_lite.language.reading.brackets import (
    FORM_NAMES,
    MODERN_FORMS,
    first_word,
    innermost_open,
)
from icarus_lite.language.reading.habits import HABITS
from icarus_lite.language.reading.lines import Lines
from icarus_lite.language.reading.older import GONE_FIELDS, GONE_FORMS, PDDL_FIELDS
from icarus_lite.language.reading.stumbles import (
    FIELD_TERMINALS,
    FORM_TERMINALS,
    MODERN_FIELD_TERMINALS,
    Context,
    Finding,
    Stumble,
    last_word,
    legal_fields,
    quoted,
    shortened,
)
from icarus_lite.language.syntax import Span
from icarus_lite.language.wording import closest, listing

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
_VALUES = "a variable, a name, a number or a string"
_WORD = re.compile(r'"[^"\\]*(?:\\[\s\S][^"\\]*)*"|[()\']|[^ \t\n\r\f\v()"\';]+')
_LEGAL_WORD = re.compile(r'[()"\']|[?^:*]?[^ \t\n\r\f\v()"\';?:^*|#]+\Z|\*\Z')


def explain(stumble: Stumble, text: str, path: str, lines: Lines) -> Diagnostic:
    """Say what is wrong at the place where the parser stopped."""
    match = None if stumble.at_end else _WORD.match(text, stumble.offset)
    word = match[0] if match else ""
    opening = innermost_open(text, stumble.start, stumble.offset)
    context = Context(
        word=word,
        previous=last_word(text[stumble.start : stumble.offset]),
        opening=opening,
        head="" if opening is None else first_word(text, opening),
        before_opening="" if opening is None else last_word(text[stumble.start : opening]),
        form=first_word(text, max(text.find("(", stumble.start), 0)),
        is_at_form=opening is not None and not text[stumble.start : opening].strip(),
        rule=stumble.rule,
        at_end=stumble.at_end,
        accepts=stumble.accepts,
        lines=lines,
        text=text,
        offset=stumble.offset,
    )
    for finder in (*HABITS, *_FINDERS):
        finding = finder(context)
        if finding is not None:
            code, message, hint = finding
            span = _place(lines, stumble.offset, word)
            return Diagnostic(path, span, Severity.ERROR, code, message, hint)
    raise AssertionError("the last finder always finds something")


def stands_inside(stumble: Stumble, text: str) -> int | None:
    """Give the parenthesis that a misplaced field shows to be unclosed, if that is the trouble."""
    match = _WORD.match(text, stumble.offset)
    is_field = match is not None and match[0] in FIELD_TERMINALS.values()
    if is_field and not stumble.accepts & FIELD_TERMINALS.keys():
        return innermost_open(text, stumble.start, stumble.offset)
    return None


def _place(lines: Lines, offset: int, word: str) -> Span:
    return lines.span(offset, offset + max(len(word), 1))


def _outside(context: Context) -> Finding | None:
    if context.opening is not None:
        return None
    if context.rule != "file":
        hint = "write a pattern such as (holding ?hand ?obj)"
        if context.at_end:
            return "ICR006", "there is nothing to read", hint
        return "ICR009", f"{quoted(context.word)} cannot stand here", hint
    hint = f"a file is a sequence of forms: {listing(f'({name} …)' for name in MODERN_FORMS)}"
    if context.word.startswith((":", "(")):
        hint = f'is there a ")" too many before it? {hint}'
    return "ICR009", f"{quoted(context.word)} stands outside of every form", hint


def _gone(context: Context) -> Finding | None:
    """Say what became of a construct of an older dialect."""
    if context.word in PDDL_FIELDS and context.accepts & FIELD_TERMINALS.keys():
        return "ICR008", f"`{context.word}` is a word of PDDL", PDDL_FIELDS[context.word]
    if context.word == "define" and context.accepts & FORM_TERMINALS.keys():
        hint = "icarus pddl import makes a domain of it, and of its problem"
        return "ICR007", "this looks like PDDL", hint
    if context.word in GONE_FIELDS and context.accepts & FIELD_TERMINALS.keys():
        message = f"`{context.word}` is a field of older dialects that has no place here"
        return "ICR037", message, GONE_FIELDS[context.word]
    if context.word in GONE_FORMS and context.accepts & FORM_TERMINALS.keys():
        message = f"`{context.word}` is a form of older dialects that has no place here"
        return "ICR037", message, GONE_FORMS[context.word]
    return None


def _unknown_form(context: Context) -> Finding | None:
    if not context.accepts & FORM_TERMINALS.keys():
        return None
    hint = f"the forms are {listing(MODERN_FORMS)}"
    if context.word == "(":
        hint = f'is there a ")" too many before it? {hint}'
    if context.word in ("(", ")"):
        return "ICR007", f"a form begins with its name, not with {quoted(context.word)}", hint
    meant = closest(context.word, FORM_NAMES)
    if meant:
        hint = f"did you mean `{meant}`? {hint}"
    return "ICR007", f"there is no form {quoted(context.word)}", hint


def _unknown_field(context: Context) -> Finding | None:
    if not context.word.startswith(":") or not context.accepts & FIELD_TERMINALS.keys():
        return None
    hint = f"the fields here are {listing(legal_fields(context.accepts))}"
    if context.word in FIELD_TERMINALS.values():
        return "ICR008", f"`{context.word}` is not a field of this form", hint
    terminals = [name for name in FIELD_TERMINALS if name in context.accepts]
    older = [FIELD_TERMINALS[name] for name in terminals]
    modern = [FIELD_TERMINALS[name] for name in terminals if name in MODERN_FIELD_TERMINALS]
    meant = closest(context.word, modern) or closest(context.word, older)
    if meant:
        hint = f"did you mean `{meant}`? {hint}"
    return "ICR008", f"there is no field `{context.word}`", hint


def _misplaced_field(context: Context) -> Finding | None:
    if not context.word.startswith(":") or context.opening is None:
        return None
    message = f"`{context.word}` cannot stand here"
    if context.is_at_form:
        return "ICR009", message, 'is there a ")" too many before it? no clause is open'
    place = context.lines.span(context.opening, context.opening + 1)
    hint = f'is a ")" missing before it? the "(" at {place.line}:{place.column} is still open'
    return "ICR009", message, hint


def _quote(context: Context) -> Finding | None:
    if context.word != "'":
        return None
    return "ICR009", "nothing is quoted in this language", "names stand for themselves: omit the '"


def _illegal_word(context: Context) -> Finding | None:
    if not context.word or _LEGAL_WORD.match(context.word):
        return None
    return (
        "ICR009",
        f"`{context.word}` is not a word of the language",
        'names hold none of ? : ^ * | # after their first character; a string "…" may hold any',
    )


def _variable_first(context: Context) -> Finding | None:
    wants_name = "SYMBOL" in context.accepts and "VARIABLE" not in context.accepts
    if not wants_name or not context.word.startswith("?"):
        return None
    return (
        "ICR009",
        f"a pattern begins with a name, not with {quoted(context.word)}",
        f"write (object {shortened(context.word)} ^type plug), also for (?o is (object …)) of old",
    )


def _junction(context: Context) -> Finding | None:
    # In :tests, `and` and `or` are functions, which the parser takes.
    if context.head not in ("and", "or") or context.word != "(":
        return None
    hint = "all elements must hold anyway: write them one after another"
    if context.head == "or":
        hint = "alternatives are clauses with the same head: write one for each"
    return "ICR009", f"there is no `{context.head}` of patterns", hint


def _not(context: Context) -> Finding | None:
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


def _attribute_value(context: Context) -> Finding | None:
    wants_value = "VARIABLE" in context.accepts and "RPAR" not in context.accepts
    if not wants_value or not context.previous.startswith(("^", "*")):
        return None
    return (
        "ICR009",
        f"the attribute `{context.previous}` needs a value, not {quoted(context.word)}",
        f"a value is {_VALUES}",
    )


def _late_argument(context: Context) -> Finding | None:
    after_attributes = "HAT" in context.accepts and "VARIABLE" not in context.accepts
    if not after_attributes or context.word in ("(", ")"):
        return None
    if context.form == "percepts":
        message = f"expected an attribute, found {quoted(context.word)}"
        return "ICR009", message, "attributes are marked with a hat: (object ^type ^x ^y)"
    return (
        "ICR009",
        f"{quoted(context.word)} stands after an attribute and its value",
        "positional arguments come first: (object ?obj ^type plug)",
    )


def _bare_list(context: Context) -> Finding | None:
    field = context.before_opening
    if field not in FIELD_TERMINALS.values() or "LPAR" not in context.accepts:
        return None
    return (
        "ICR009",
        f"`{field}` takes a list, but its first entry is {quoted(context.word)}",
        f"put a parenthesis around the list as well: {field} ((…) (…))",
    )


def _generic(context: Context) -> Finding | None:
    fields = legal_fields(context.accepts)
    if fields:
        expected = ['")"'] if "RPAR" in context.accepts else []
        hint = f"the fields here are {listing(fields)}"
        message = f"expected {listing(['a field', *expected], 'or')}, found {quoted(context.word)}"
        return "ICR009", message, hint
    phrases = [text for name, text in _PHRASES.items() if name in context.accepts]
    if "STAR" in context.accepts and "HAT" not in context.accepts:
        phrases.append("a command such as `*grasp`")
    found = quoted(context.word) if context.word else "the end"
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
