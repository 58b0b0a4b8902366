from __future__ import annotations

from icarus_lite.language.editing.lexemes import Lexeme, lexemes
from icarus_lite.language.editing.nesting import Group, nest
from icarus_lite.language.reading.lines import MAX_DEPTH


def shape(node):
    if isinstance(node, Lexeme):
        return node.text
    return [shape(item) for item in node.items]


def shapes(text):
    return [shape(node) for node in nest(text, lexemes(text))]


def test_lists_are_nested_and_comments_left_out():
    assert shapes("(a (b ; c\n) d) e") == [["a", ["b"], "d"], "e"]


def test_what_closes_nothing_is_passed_over():
    assert shapes(") (a))(b)") == [["a"], ["b"]]


def test_a_form_at_the_margin_begins_anew_after_a_forgotten_parenthesis():
    text = "(concepts ((a ?x)\n(skills ((b ?y)))\n"
    assert shapes(text) == [["concepts", [["a", "?x"]]], ["skills", [["b", "?y"]]]]


def test_layout_does_not_count_in_a_sound_text():
    assert shapes("(concepts\n(test x))") == [["concepts", ["test", "x"]]]


def test_an_open_group_reaches_to_the_last_word_in_it():
    text = "(a (b c"
    (group,) = nest(text, lexemes(text))
    assert isinstance(group, Group)
    assert (group.closing, group.stop, group.items[1].stop) == (None, len(text), len(text))


def test_what_lies_too_deep_is_flat():
    text = "(" * 50_000 + "a" + ")" * 50_000
    depth, node = 0, nest(text, lexemes(text))[0]
    while isinstance(node, Group):
        depth, node = depth + 1, node.items[0]
    assert depth == MAX_DEPTH + 1
