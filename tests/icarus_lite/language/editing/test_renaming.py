from __future__ import annotations

import re

import pytest

from icarus_lite.language import parse_domain
from icarus_lite.language.editing import RenameError, Role, rename, renameable

TEXT = """\
(percepts (object ^type ^x) (hand *x))
(concepts
  ((free ?h) :elements ((hand ?h *x ?x) (not (held ?h ?any))))
  ((ball ?o) :elements ((object ?o ^type ball ^x ?x)) :tests ((< ?x 1))))
(skills ((hold ?h ?o) :elements ((free ?h) (ball ?o)) :actions ((*hold ?h ?o))
         :effects ((held ?h ?o))))
(attachments ((hold ?h ?o) :child ?o :parent ?h))
(task t :goal ((held h b)))
"""


def renamed(index, text, needle, name, within=0):
    thing = renameable(index, "it", index.at("it", text.index(needle) + within))
    for located, new in reversed(rename(index, thing, name)):
        word = located.occurrence
        text = text[: word.start] + new + text[word.stop :]
    return text


@pytest.mark.parametrize(
    ("needle", "name", "pattern", "new"),
    [
        ("held ?h ?any", "grips", r"\bheld\b", "grips"),
        ("object ^type", "thing", r"\bobject\b", "thing"),
        ("hold ?h ?o) :el", "close-on", r"(?<!\*)\bhold\b", "close-on"),
        ("?any", "nobody", r"\?any", "?nobody"),
        ("?any", "?nobody", r"\?any", "?nobody"),
        ("^type", "kind", r"\^type", "^kind"),
        ("^type", "^kind", r"\^type", "^kind"),
    ],
)
def test_every_use_gets_the_new_name(reading, needle, name, pattern, new):
    found = renamed(reading(TEXT), TEXT, needle, name)
    assert found == re.sub(pattern, new, TEXT)
    assert parse_domain(found)[0] is not None


def test_an_attribute_is_renamed_for_its_own_type_only(reading):
    found = renamed(reading(TEXT), TEXT, "*x", "reach")
    assert found == TEXT.replace("*x", "*reach")


def test_a_variable_is_renamed_in_its_own_clause_only(reading):
    found = renamed(reading(TEXT), TEXT, "^x ?x", "?far", within=4)
    assert found == TEXT.replace("^x ?x", "^x ?far").replace("< ?x", "< ?far")


def test_the_same_name_changes_nothing(reading):
    assert renamed(reading(TEXT), TEXT, "free", "free") == TEXT


@pytest.mark.parametrize(
    ("needle", "name", "reason"),
    [
        ("free", "ball", "there is a predicate `ball` already, in line 4"),
        ("free", "attached", "`attached` is the language's own predicate of what moves with what"),
        ("free", "not", "`not` is a word of the language"),
        ("free", "12", "`12` is a number, not a name"),
        (
            "free",
            "a b",
            "`a b` is not a word of the language: names hold no blanks, parentheses, quotes",
        ),
        ("free", "", "`` is not a word of the language: names hold no blanks"),
        ("?any", "h", "there is a variable `?h` already, in line 3"),
        ("^type", "x", "`object` has an attribute `^x` already"),
    ],
)
def test_a_name_that_cannot_be_is_refused(reading, needle, name, reason):
    with pytest.raises(RenameError, match="^" + re.escape(reason)):
        renamed(reading(TEXT), TEXT, needle, name)


@pytest.mark.parametrize(
    ("needle", "reason"),
    [
        ("skills", "`skills` is a word of the language"),
        (":tests", "`:tests` is a word of the language"),
        ("not (held", "`not` is a word of the language"),
        ("< ?x", "`<` is a function of the language"),
        ("*hold", "`*hold` is a command of the driver, which gives it its name"),
        ("ball ^x", "`ball` is a value: percepts carry it, so that only its source can rename it"),
        ("1))", "there is no name here that can be changed"),
        ("(percepts", "there is no name here that can be changed"),
    ],
)
def test_what_is_no_name_of_the_file_is_not_renamed(reading, needle, reason):
    with pytest.raises(RenameError, match="^" + re.escape(reason)):
        renamed(reading(TEXT), TEXT, needle, "new")


def test_an_attribute_cannot_take_the_name_of_one_of_a_subtype(reading):
    text = "(percepts (object ^type) (part :is object ^grip))"
    with pytest.raises(RenameError, match=r"^`part` has an attribute `\^grip` already$"):
        renamed(reading(text), text, "^type", "grip")


def test_attached_keeps_its_name(reading):
    text = "(task t :goal ((attached a b)))"
    with pytest.raises(RenameError, match="own predicate"):
        renamed(reading(text), text, "attached", "stuck")


def test_renaming_there_and_back_gives_the_same_text(reading, shipped):
    index = reading(shipped)
    for role in (Role.PREDICATE, Role.SKILL):
        for name in index.names(role)[:3]:
            if name == "attached":
                continue
            thing = next(
                index.thing("it", word)
                for word in index.words("it")
                if (word.role, word.name) == (role, name)
            )
            there = shipped
            for located, new in reversed(rename(index, thing, "quite-new")):
                start, stop = located.occurrence.start, located.occurrence.stop
                there = there[:start] + new + there[stop:]
            assert there != shipped
            assert parse_domain(there)[0] is not None
            back = there.replace("quite-new", name)
            assert back == shipped
