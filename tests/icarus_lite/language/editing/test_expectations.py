from __future__ import annotations

import pytest

from icarus_lite.language.editing.expectations import accepted, keyword_terminals, skeleton
from icarus_lite.language.editing.lexemes import lexemes
from icarus_lite.language.editing.nesting import Group, nest
from icarus_lite.language.keywords import FIELDS, FORMS, NOT


def chain(text):
    groups, items = [], nest(text, lexemes(text))
    while items and isinstance(items[-1], Group) and items[-1].closing is None:
        groups.append(items[-1])
        items = items[-1].items
    return groups


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("(concepts ((near ?a ?b) :tests ((:bad)) :elements ((object ?a ", None),
        ("(concepts ((near ?a ?b) :tests () ", "( concepts ( (x) "),
        ("(concepts ((a)) ((b) :tests ((< (f ?x) 1) (< ?y ", "( concepts ( (x) :tests ( ( < ?y "),
        ('(task 1.1 "so" :goal ((a b)) :robot ', '( task 1.1 "so" :robot '),
        ("(test t :then ((:expect ()) (:action ((go ", "( test t :then ( ( :action ( ( go "),
    ],
)
def test_only_what_matters_is_shown_to_the_parser(text, expected):
    expected = expected or "( concepts ( (x) :elements ( ( object ?a "
    assert skeleton(chain(text)) == expected
    assert accepted(chain(text))


def test_where_nothing_can_stand_nothing_is_accepted():
    assert accepted(chain("(concepts (:elements (")) == frozenset()
    assert accepted(chain("(task t :priority 99999999999999999999e999 ")) != frozenset({"NUMBER"})


def test_every_keyword_of_the_grammar_has_its_sentence():
    ours = {*FORMS, *FIELDS, NOT.name}
    grammar = set(keyword_terminals().values())
    assert grammar - ours == set(), "add it to icarus_lite/language/keywords.py"
    assert ours - grammar == set(), "remove it from icarus_lite/language/keywords.py"
