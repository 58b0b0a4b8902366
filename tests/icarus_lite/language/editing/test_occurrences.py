from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from icarus_lite.language import parse_domain
from icarus_lite.language.editing import Role, occurrences
from icarus_lite.language.syntax import Variable

FORMS = ["(concepts", "(skills", "(test", "(task", "(percepts"]
FIELDS = [":elements", ":tests", ":action", ":then", ":is"]
WORDS = ["(", ")", "((", "))", "^x", "*x", "?v", "not", "near", "<", "1", '"', ";", "#|", "|#", "'"]
PIECES = st.sampled_from([*FORMS, *FIELDS, *WORDS])


def words(text, *roles):
    return [word.name for word in occurrences(text) if word.role in roles]


def placed(text, name):
    return [word for word in occurrences(text) if word.name == name]


def test_one_name_stands_for_different_things_in_different_places():
    text = """
    (percepts (a ^a))
    (concepts ((b ?a) :elements ((a ?a ^a a)) :tests ((abs ?a))))
    (skills ((a ?a) :elements ((a ?a)) :actions ((*a ?a)) :effects ((a ?a))))
    (test a :action ((a a)))
    """
    roles = [word.role.value for word in occurrences(text) if word.name == "a"]
    assert roles == [
        "predicate",
        "attribute",
        "predicate",
        "attribute",
        "symbol",
        "skill",
        "predicate",
        "command",
        "predicate",
        "name",
        "skill",
        "symbol",
    ]


def test_heads_and_effects_define_and_removing_effects_do_not():
    text = "(skills ((a ?x) :elements ((b ?x)) :effects ((b ?x) (not (b ?x)) (c ?x))))"
    defining = [word.name for word in occurrences(text) if word.defines]
    assert defining == ["a", "b", "c"]


def test_the_place_names_form_field_and_clause():
    text = "(create-skills ((go ?x) :start ((not (at ?x)))))"
    (at,) = placed(text, "at")
    place = at.place
    assert (place.form, place.field, place.clause) == ("skills", ":elements", "go")
    assert place.negated
    assert text[place.scope : place.end] == "((go ?x) :start ((not (at ?x))))"


def test_an_older_field_counts_as_what_it_means_in_its_form():
    skill = "(skills ((go ?x) :percepts ((at ?x)) :action (*move ?x)))"
    assert placed(skill, "at")[0].place.field == ":elements"
    assert placed(skill, "move")[0].role is Role.COMMAND
    test = "(test t :percepts ((at x)) :action (go x))"
    assert placed(test, "at")[0].place.field == ":percepts"
    assert placed(test, "go")[0].role is Role.SKILL


def test_values_and_arguments_know_their_pattern():
    text = "(concepts ((a ?x) :elements ((object ?x ^type ball))))"
    (ball,) = placed(text, "ball")
    assert (ball.role, ball.owner, ball.attribute) == (Role.SYMBOL, "object", "type")
    assert [word.owner for word in placed(text, "?x")] == ["a", "object"]


def test_cycles_of_a_test_have_fields_of_their_own():
    text = "(test t :then ((:percepts ((at x)) :action ((go x)) :expect ((there x)))))"
    assert words(text, Role.FIELD) == [":then", ":percepts", ":action", ":expect"]
    assert words(text, Role.SKILL) == ["go"]


def test_a_subtype_uses_its_supertype():
    text = "(percepts (object ^x) (part :is object ^grip))"
    assert [
        (word.name, word.defines) for word in occurrences(text) if word.role == "predicate"
    ] == [
        ("object", True),
        ("part", True),
        ("object", False),
    ]


def test_pieces_of_a_domain_are_read_without_their_form():
    assert words("((near ?a) :elements ((object ?a)))", Role.PREDICATE) == ["near", "object"]
    assert words("(not (object ?a))", Role.PREDICATE) == ["object"]


def test_the_same_is_read_as_by_the_parser(shipped):
    domain, _ = parse_domain(shipped)
    found = occurrences(shipped)
    heads = [word.name for word in found if word.defines and not word.place.field]
    for clause in (*domain.concepts, *domain.skills):
        assert clause.head.predicate in heads
    defined = {word.name for word in found if word.defines and word.place.form == "concepts"}
    named = {clause.head.predicate for clause in domain.concepts}
    named |= {name for clause in domain.concepts for name, _ in clause.head.attributes}
    assert defined == named
    commands = [word.name for word in found if word.role is Role.COMMAND]
    assert commands == [each.predicate for skill in domain.skills for each in skill.actions]
    tests = [call for clause in (*domain.concepts, *domain.skills) for call in clause.tests]
    assert [word.name for word in found if word.role is Role.FUNCTION][: len(tests) and 1] == [
        call.function for call in tests[:1]
    ]
    variables = {
        term.name
        for clause in (*domain.concepts, *domain.skills)
        for condition in clause.elements
        for term in (*condition.atom.args, *(value for _, value in condition.atom.attributes))
        if isinstance(term, Variable)
    }
    assert variables <= {word.name for word in found if word.role is Role.VARIABLE}
    assert not [word for word in found if word.role is Role.ILLEGAL]


@given(st.lists(PIECES).map(" ".join))
def test_any_text_is_read_and_nothing_overlaps(text):
    end = 0
    for word in occurrences(text):
        assert end <= word.start < word.stop
        assert word.place.scope <= word.place.end <= len(text)
        end = word.stop
