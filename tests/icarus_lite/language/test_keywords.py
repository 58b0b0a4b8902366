from __future__ import annotations

from icarus_lite.language import older_names
from icarus_lite.language.keywords import FIELDS, FORMS, IN_CLAUSES, NOT, field_named
from icarus_lite.language.reading.brackets import FORM_NAMES


def test_the_forms_are_those_of_the_language():
    assert set(FORMS) == set(FORM_NAMES)


def test_older_names_mean_what_the_reader_takes_them_for():
    forms = {name: each.modern for name, each in FORMS.items() if each.modern}
    assert older_names.MODERN_FORMS.items() <= forms.items()
    fields = {**FIELDS, **IN_CLAUSES}
    older = {name: each.modern for name, each in fields.items() if each.modern}
    assert older == dict(older_names.MODERN_FIELDS)


def test_some_fields_are_older_names_in_clauses_only():
    assert field_named(":percepts", "concepts").modern == ":elements"
    assert field_named(":percepts", "test").modern == ""
    assert field_named(":unheard-of", "test") is None


def test_every_keyword_has_a_sentence():
    for keyword in (*FORMS.values(), *FIELDS.values(), *IN_CLAUSES.values(), NOT):
        assert keyword.documentation.endswith("."), keyword.name
