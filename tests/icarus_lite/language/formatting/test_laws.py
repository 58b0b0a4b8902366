"""What holds whatever is formatted.

Nothing is lost, added or moved: words, strings, parentheses and comments come out in the order in
which they went in, so the meaning is the same. A second time changes nothing.
"""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.language import parse_domain
from icarus_lite.language.formatting.formatter import format_text

DOMAINS = sorted((Path(__file__).parents[4] / "domains").glob("*.icr"))
TEXTS = [path.read_text(encoding="utf-8") for path in DOMAINS]
GEARBOX = next(text for text in TEXTS if "(domain gearbox" in text)

LEXEME = re.compile(
    r'"[^"\\]*(?:\\[\s\S][^"\\]*)*"|;[^\n]*|\#\|[\s\S]*?\|\#|[()]|[^ \t\n\r\f\v()"\';]+'
)
BLANKS = " \t\r\f\v"


def lexemes(text):
    """Give all that counts, in order: markers all written ^, comments without trailing blanks."""
    found = []
    for match in LEXEME.finditer(text):
        lexeme = match[0]
        if lexeme[0] == ";":
            lexeme = lexeme.rstrip(BLANKS)
        elif (
            lexeme[0] == "*"
            and len(lexeme) > 1
            and [x for x in found if x[0] not in "#;"][-1] != "("
        ):
            lexeme = "^" + lexeme[1:]
        found.append(lexeme)
    return found


def places(text):
    """Tell what each comment follows on its line: an opening parenthesis, a word, or nothing."""
    found, stop, before = [], 0, ""
    for match in LEXEME.finditer(text):
        if "\n" in text[stop : match.start()]:
            before = ""
        if match[0][0] == ";":
            found.append(before)
        elif not match[0].startswith("#|"):
            before = "(" if match[0] == "(" else "word"
        stop = match.end()
    return found


def are_same_places(before, after):
    """Tell whether comments stayed behind words, or on lines of their own."""
    pairs = zip(before, after, strict=True)
    return all((old == "word") == (new == "word") for old, new in pairs)


def assert_lawful(text):
    formatted = format_text(text)
    assert lexemes(formatted) == lexemes(text)
    assert format_text(formatted) == formatted
    domain, _ = parse_domain(text)
    if domain is not None:
        assert parse_domain(formatted)[0] == domain
    return formatted


def assert_canonical(text, formatted):
    assert are_same_places(places(text), places(formatted))
    assert formatted.endswith("\n") or not formatted
    assert not formatted.endswith("\n\n")
    assert "\r\n" not in formatted


PLAIN = [" ", " ", " ", " ", "\n", "\n"]
BLANK = ["\n\n", "\n  ", "  \t", "\n\n\n\n ", "\r\n"]
NOTES = [" ; note\n", "\n; own\n", "\n\n ;; apart\n\n", "\n; a\n; b\n", " ;\n", " ; (\n"]
BLOCKS = [" #| b |# ", "\n#| b |#\n", " #|\n two |# ", " #|x|# #|y|#\n", " #| b |# ; c\n"]
SWITCHES = ["\n; fmt: off\n", "\n ; fmt: on\n", " ; fmt: off\n", "\n;; fmt:off\n\n"]
TRIVIA = [*PLAIN, *BLANK, *NOTES, *BLOCKS]
symbols = st.sampled_from(
    ["a", "free", "?x", "?hand", "*grasp", "^x", "1.50", '"s (t"', '"two\nlines"', "x" * 45]
)
keywords = st.sampled_from([":elements", ":tests", ":is", ":goal"])
heads = st.sampled_from(["concepts", "domain", "task", "attachments", "not", "*grasp", "rule"])


def grouped(children):
    return st.builds(
        lambda head, rest: ["(", *head, *(word for words in rest for word in words), ")"],
        st.one_of(st.just([]), heads.map(lambda head: [head])),
        st.lists(children, max_size=4),
    )


nodes = st.recursive(
    st.one_of(symbols, symbols, keywords).map(lambda word: [word]), grouped, max_leaves=20
)
forests = st.lists(grouped(nodes), max_size=3).map(
    lambda forms: [w for form in forms for w in form]
)


def spelt(words, gaps=TRIVIA):
    """Put comments and blanks in odd places between words."""
    count = len(words) + 1
    return st.lists(st.sampled_from(gaps), min_size=count, max_size=count).map(
        lambda drawn: drawn[0] + "".join(map(str.__add__, words, drawn[1:]))
    )


@settings(max_examples=120)
@given(forests.flatmap(spelt))
def test_any_lists_with_comments_anywhere(text):
    formatted = assert_lawful(text)
    assert_canonical(text, formatted)


@settings(max_examples=120)
@given(forests.flatmap(lambda words: spelt(words, [*TRIVIA, *SWITCHES])))
def test_any_lists_with_switches_anywhere(text):
    assert_lawful(text)


def forms_of(text):
    """Cut a text into its top-level forms, each as its words without comments."""
    forms, depth = [], 0
    for lexeme in LEXEME.findall(text):
        if lexeme[0] == ";" or lexeme.startswith("#|"):
            continue
        if depth == 0:
            forms.append([])
        forms[-1].append(lexeme)
        depth += (lexeme == "(") - (lexeme == ")")
    return forms


FORMS = [form for text in TEXTS for form in forms_of(text) if len(form) < 400]


@settings(max_examples=60)
@given(
    st.lists(st.sampled_from(FORMS), min_size=1, max_size=2).flatmap(
        lambda forms: spelt([word for form in forms for word in form])
    )
)
def test_shipped_forms_with_comments_anywhere(text):
    formatted = assert_lawful(text)
    assert_canonical(text, formatted)


@settings(max_examples=40)
@given(
    st.lists(
        st.tuples(
            st.integers(0, len(GEARBOX)),
            st.integers(0, 4),
            st.sampled_from([*"()\"';#|*^:?\n ", *TRIVIA, *SWITCHES, "\0", "ü", "\u2028"]),
        ),
        min_size=1,
        max_size=4,
    )
)
def test_mutations_of_a_domain(edits):
    text = GEARBOX
    for start, length, inserted in edits:
        text = text[:start] + inserted + text[start + length :]
    formatted = format_text(text)
    assert format_text(formatted) == formatted
    before, after = parse_domain(text)[0], parse_domain(formatted)[0]
    assert before == after


@settings(max_examples=120)
@given(st.text())
def test_any_text(text):
    formatted = format_text(text)
    assert format_text(formatted) == formatted


@settings(max_examples=120)
@given(st.text(alphabet="()\";#|\\ \n\r\tab*^:?'", max_size=40))
def test_any_punctuation(text):
    formatted = format_text(text)
    assert format_text(formatted) == formatted


@pytest.mark.parametrize("path", DOMAINS, ids=lambda path: path.name)
def test_shipped_domains_are_formatted(path):
    text = path.read_text(encoding="utf-8")
    assert format_text(text) == text, f"run: icarus fmt {path}"


@pytest.mark.parametrize("path", DOMAINS, ids=lambda path: path.name)
def test_shipped_domains_out_of_shape(path):
    text = path.read_text(encoding="utf-8").replace("\n ", "\n\n\n ").replace(" (", "(")
    formatted = assert_lawful(text)
    assert_canonical(text, formatted)
    assert all(len(line) <= 100 for line in formatted.splitlines())


def test_the_time_grows_with_the_size_only():
    times = []
    for size in (20_000, 200_000):
        text = GEARBOX * (size // len(GEARBOX) + 1)
        start = time.process_time()
        format_text(text)
        times.append(time.process_time() - start)
    assert times[0] < 1
    assert times[1] < 40 * times[0] + 0.5


@pytest.mark.parametrize(
    "unit", ['"', "#|", ";", "(", ")", "a#|", "\\", "'", '"\\', "#", "|#", "* "]
)
def test_no_repetition_takes_long(unit):
    text = unit * 50_000
    start = time.process_time()
    format_text(text)
    assert time.process_time() - start < 5
