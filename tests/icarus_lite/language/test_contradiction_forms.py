"""The `contradictions` form: read, checked, laid out."""

from __future__ import annotations

import pytest

from icarus_lite.language import (
    check_domain,
    format_text,
    parse_atom,
    parse_conditions,
    parse_domain,
)
from icarus_lite.language.syntax import Call, Constant, Contradiction, Variable

HEAD = """(percepts (object ^x) (hand ^gripping))
(concepts
  ((apart ?a ?b)
   :elements ((object ?a ^x ?xa) (object ?b ^x ?xb))
   :tests ((> (- ?xb ?xa) 1))))
(skills
  ((grasp ?h ?o)
   :elements ((hand ?h) (object ?o))
   :actions ((*grasp ?h ?o))
   :effects ((holding ?h ?o)))
  ((insert ?o ?into)
   :elements ((object ?o) (object ?into))
   :actions ((*insert ?o ?into))))
(attachments ((insert ?o ?into) :child ?o :parent ?into))
"""


def read(form: str):
    domain, found = parse_domain(HEAD + form, "d.icr")
    assert domain is not None, found
    return domain


def codes(form: str, *, thorough: bool = False) -> list[str]:
    return [each.code for each in check_domain(read(form), thorough=thorough)]


def test_clauses_are_read_with_their_fields_in_any_order():
    domain = read("""
        (contradictions
          ((attached ?o ?into) :elements ((apart ?o ?into) (not (holding ?_h ?o))) :cycles 5)
          ((holding ?h ?o) :cycles 2 :tests ((/= ?h ?o)) :elements ((hand ?h ^gripping no))))
        (contradictions ((holding ?h plug) :elements ((hand ?h))))""")
    assert check_domain(domain) == ()
    assert domain.contradictions == (
        Contradiction(
            parse_atom("(attached ?o ?into)"),
            parse_conditions("((apart ?o ?into) (not (holding ?_h ?o)))"),
            cycles=5,
        ),
        Contradiction(
            parse_atom("(holding ?h ?o)"),
            parse_conditions("(hand ?h ^gripping no)"),
            (Call("/=", (Variable("?h"), Variable("?o"))),),
            2,
        ),
        Contradiction(parse_atom("(holding ?h plug)"), parse_conditions("(hand ?h)")),
    )
    first = domain.contradictions[0]
    assert first.head.args == (Variable("?o"), Variable("?into"))
    assert (first.span.line, domain.contradictions[2].cycles) == (17, 1)
    assert domain.contradictions[2].head.args[1] == Constant("plug")


def test_the_word_is_no_keyword_elsewhere():
    assert codes("(concepts ((contradictions ?h) :elements ((hand ?h ^gripping no))))") == []


@pytest.mark.parametrize(
    "field", [":conditions ((hand ?h))", ":binds ((?x 1))", ":while ((hand ?h))", ":until (p)"]
)
def test_other_fields_are_refused(field):
    domain, found = parse_domain(f"{HEAD}(contradictions ((holding ?h ?o) {field}))")
    assert domain is None
    assert "ICR008" in [each.code for each in found]


def test_a_head_variable_binds_like_an_element():
    assert codes("(contradictions ((holding ?h ?o) :elements ((hand ?h)) :tests ((= ?o x))))") == []
    rule = "(contradictions ((holding ?h ?o) :elements ((hand ?h)) :tests ((< ?o 2))))"
    assert codes(rule) == []  # nothing says what a held thing is
    named = "(contradictions ((holding ?h ?o) :elements ((hand ?h)) :tests ((< ?h 2))))"
    assert codes(named) == ["ICR044"]  # a hand is named by a symbol


def test_what_a_task_gives_can_be_withdrawn_and_what_only_a_contradiction_asks_for_be_given():
    rule = "(contradictions ((sealed ?o) :elements ((object ?o) (opened ?o))))"
    task = "(task t :init ((sealed a) (opened a)) :goal ((sealed a)))"
    assert codes(f"{rule}{task}") == []
    assert "ICR070" in codes(task)  # without it nothing asks for `opened`


def test_what_it_asks_for_counts_as_used():
    rule = "(contradictions ((attached ?o ?into) :elements ((apart ?o ?into))))"

    def unused(form: str) -> list[str]:
        found = check_domain(read(form), thorough=True)
        return [each.message for each in found if each.code == "ICR040"]

    assert "nothing uses the concept `apart`" in unused("")
    assert "nothing uses the concept `apart`" not in unused(rule)


def test_a_silenced_warning_stays_silent():
    rule = "(contradictions ((holding ?h ?o) :elements ((object ?o ^x ?x)))) ; noqa: ICR029"
    assert codes(rule) == []


def test_rows_of_the_same_fields_are_laid_out_as_a_table():
    text = """(contradictions
  ((attached ?o ?into) :elements ((apart ?o ?into))       :cycles 5)
  ((holding ?h ?o)     :elements ((hand ?h ^gripping no)) :cycles 3)
  ((holding ?h ?o)
   :elements ((hand ?h) (object ?o ^x ?x))  ; looked at closely
   :tests ((> ?x 1))
   :cycles 2))
"""
    assert format_text(text) == text
    assert format_text(" ".join(text.replace("; looked at closely", "").split())) == text.replace(
        "  ; looked at closely", ""
    )
