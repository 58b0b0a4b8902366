from __future__ import annotations

from icarus_lite.language.checking.vocabulary import Origin
from icarus_lite.language.editing import File, Index, Role, Thing

TEXT = """\
(percepts (object ^type ^x) (part :is object ^grip))
(concepts
  ((big ?o) :elements ((object ?o ^x ?x)) :tests ((< 1 ?x)))
  ((small ?o) :elements ((part ?o ^x ?x ^grip firm) (not (big ?o)))))
(skills ((grasp ?o) :elements ((big ?o)) :actions ((*take ?o))
  :effects ((held ?o) (attached ?o h))))
         :effects ((held ?o) (attached ?o h))))
(attachments ((grasp ?o) :child ?o :parent h))
"""


def thing_at(index, text, needle, within=0):
    word = index.at("it", text.index(needle) + within)
    return index.thing("it", word)


def stretches(index, thing):
    return [
        index.text(each.path)[each.occurrence.start : each.occurrence.stop]
        for each in index.occurrences(thing)
    ]


def test_a_word_is_found_from_its_first_to_behind_its_last_character(reading):
    index = reading("(big ?o)")
    assert [word and word.name for word in (index.at("it", i) for i in range(9))] == [
        None,
        "big",
        "big",
        "big",
        "big",
        "?o",
        "?o",
        "?o",
        None,
    ]


def test_variables_belong_to_their_clause(reading):
    index = reading(TEXT)
    thing = thing_at(index, TEXT, "?x))")
    assert len(index.occurrences(thing)) == 2
    assert index.variables("it", thing.scope) == ("?o", "?x")
    (first,) = index.definitions(thing)
    assert first.occurrence.start == TEXT.index("?x))")


def test_an_attribute_belongs_to_the_type_that_declares_it(reading):
    index = reading(TEXT)
    inherited = thing_at(index, TEXT, "(part ?o ^x", len("(part ?o ^"))
    assert inherited == Thing(Role.ATTRIBUTE, "x", "object")
    assert stretches(index, inherited) == ["^x", "^x", "^x"]
    assert index.attributes("part") == ("grip", "type", "x")
    assert index.values(Thing(Role.ATTRIBUTE, "grip", "part")) == ("firm",)


def test_skills_are_not_predicates(reading):
    index = reading(TEXT)
    assert index.names(Role.SKILL) == ("grasp",)
    assert index.names(Role.PREDICATE) == ("object", "part", "big", "small", "held", "attached")
    assert [
        each.occurrence.place.form for each in index.occurrences(Thing(Role.SKILL, "grasp"))
    ] == [
        "skills",
        "attachments",
    ]


def test_origins(reading):
    index = reading(TEXT)
    assert index.origins("object") == (Origin.PERCEPT,)
    assert index.origins("big") == (Origin.CONCEPT,)
    assert index.origins("held") == (Origin.EFFECT,)
    assert index.origins("attached") == (Origin.ATTACHMENT,)
    assert index.origins("unheard-of") == ()


def test_a_concept_is_defined_by_its_clauses_and_not_by_effects(reading):
    text = TEXT + "(concepts ((held ?o) :elements ((object ?o))))"
    index = reading(text)
    (located,) = index.definitions(Thing(Role.PREDICATE, "held"))
    assert index.clause(located) == "((held ?o) :elements ((object ?o)))"
    assert index.head(located) == "(held ?o)"


def test_supertypes_that_lead_in_a_circle_do_no_harm(reading):
    index = reading("(percepts (a :is b ^x) (b :is a ^y))")
    assert index.attributes("a") == ("x", "y")


def test_files_share_their_names_but_not_their_variables():
    other = "(concepts ((round ?o) :elements ((big ?o))))"
    index = Index([File.read("it", TEXT), File.read("other", other)])
    big = index.occurrences(Thing(Role.PREDICATE, "big"))
    assert [each.path for each in big] == ["it", "it", "it", "other"]
    word = index.at("other", other.index("?o"))
    assert {each.path for each in index.occurrences(index.thing("other", word))} == {"other"}


def test_what_only_a_task_gives_is_known_as_well(reading):
    task = "(task t :init ((sealed o1) (object o1) (big o1) (attached o1 h)) :goal ((seald o1)))"
    index = reading(TEXT + task)
    assert index.origins("sealed") == (Origin.GIVEN,)
    assert index.origins("object") == (Origin.PERCEPT,)
    assert index.origins("big") == (Origin.CONCEPT,)
    assert index.origins("attached") == (Origin.ATTACHMENT,)
    assert "sealed" in index.names(Role.PREDICATE)
    assert "seald" not in index.names(Role.PREDICATE)
