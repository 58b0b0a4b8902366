"""What the analyses must not say: a checker that cries wolf is switched off."""

from __future__ import annotations

import pytest

from icarus_lite.language import check_domain, parse_domain
from icarus_lite.language.checking.reachability import changeable_signs

PERCEPTS = "(percepts (object ^type ^x ^y) (hand ^x))\n"


def codes(text, functions=None):
    domain, problems = parse_domain(PERCEPTS + text, "d.icr")
    assert domain is not None, problems
    return [each.code for each in check_domain(domain, functions)]


GRASP = "((grasp ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o)))"
SOUND = {
    "an attribute whose values the file never names may be anything": """
    (concepts ((big ?o) :elements ((object ?o ^x ?x)) :tests ((> ?x 2))))""",
    "an attribute with values of both kinds may be either": """
    (concepts ((a ?o) :elements ((object ?o ^x left))) ((b ?o) :elements ((object ?o ^x 1)))
      ((big ?o) :elements ((object ?o ^x ?x)) :tests ((> ?x 2))))""",
    "objects may be compared with objects and with names": """
    (concepts ((same ?a ?b) :elements ((object ?a) (hand ?b)) :tests ((= ?a ?b) (/= ?a o1))))""",
    "what is computed is a number": """
    (concepts ((far ?o ^d ?d) :elements ((object ?o ^x ?x)) :binds ((?d (abs ?x))))
      ((very-far ?o) :elements ((far ?o ^d ?d)) :tests ((> ?d 2) (= ?d 3))))""",
    "an argument that some clause takes from elsewhere may be a number": """
    (concepts ((place ?o) :elements ((object ?o))) ((place ?x) :elements ((hand ?_h ^x ?x)))
      ((right ?p) :elements ((place ?p)) :tests ((> ?p 0))))""",
    "a recursion may begin in any clause": """
    (concepts ((above ?a ?c) :elements ((above ?a ?b) (above ?b ?c)))
      ((above ?a ?b) :elements ((object ?a ^x ?x) (object ?b ^x ?x))))""",
    "a concept may rest on the absence of what is never there": """
    (concepts ((alone ?o) :elements ((object ?o) (not (attached ?o ?any)))))""",
    "an effect may attach where no attachment does": f"""
    (concepts ((held ?o) :elements ((attached ?o ?_h))))
    (skills {GRASP.replace(":actions", ":effects ((attached ?o ?h)) :actions")})
    (goals (held o1))""",
    "an effect may name a concept that perception confirms": """
    (concepts ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0))))
    (skills ((push ?o) :elements ((object ?o)) :actions ((*push ?o)) :effects ((left ?o))))
    (task 1 :goal ((left o1)))""",
    "a goal may be reached through the negation in a concept": f"""
    (concepts ((free ?h) :elements ((hand ?h) (not (attached ?any ?h)))))
    (skills {GRASP}
      ((drop ?h ?o) :elements ((attached ?o ?h)) :actions ((*drop ?h))))
    (attachments ((grasp ?h ?o) :until (drop ?h ?o) :child ?o :parent ?h))
    (task 1 :goal ((free h1) (not (attached o1 h1))))""",
    "a goal may be given from the start": """
    (skills ((push ?o) :elements ((object ?o) (road ?o b)) :actions ((*push ?o))
      :effects ((pushed ?o))))
    (task 1 :goal ((road a b) (pushed o1)) :init ((road a b)))""",
    "a domain without skills only observes, and may have goals": """
    (concepts ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0))))
    (goals (left o1))""",
    "observed actions need no skills": """
    (attachments ((contain ?c ?o) :until (move ?c) :child ?o :parent ?c))""",
    "what detaches may leave the child open": f"""
    (skills {GRASP} ((open ?h) :elements ((hand ?h)) :actions ((*open ?h))))
    (attachments ((grasp ?h ?o) :until (open ?h) :child ?o :parent ?h))""",
    "one action may attach and detach, by its constants": """
    (skills ((turn ?o ?way) :elements ((object ?o ^type ?way)) :actions ((*turn ?o ?way))))
    (attachments ((turn ?o in) :until (turn ?o out) :child ?o :parent case))""",
    "a skill with several clauses is matched by any of them": """
    (skills ((open hand1) :elements ((hand hand1)) :actions ((*open)))
      ((open hand2) :elements ((hand hand2)) :actions ((*open))))
    (attachments ((grasp ?h ?o) :until (open hand2) :child ?o :parent hand2)) ; noqa: ICR023""",
}


@pytest.mark.parametrize("text", SOUND.values(), ids=SOUND.keys())
def test_nothing_is_said_without_reason(text):
    assert codes(text) == []


def test_python_functions_take_anything():
    text = "(concepts ((p ?o) :elements ((object ?o)) :tests ((nice ?o 3))))"
    assert codes(text, {"nice": lambda name, count: len(name) > count}) == []


def test_literals_change_through_attachments_concepts_and_their_negation():
    domain, _ = parse_domain(
        PERCEPTS + SOUND["a goal may be reached through the negation in a concept"]
    )
    assert changeable_signs(domain) == {
        ("attached", True),
        ("attached", False),
        ("free", True),
        ("free", False),
    }


def test_one_impossible_concept_is_told_and_not_all_that_rest_on_it():
    text = """(concepts ((a ?o) :elements ((a ?o) (object ?o))) ((b ?o) :elements ((a ?o)))
      ((c ?o) :elements ((b ?o) (object ?o)))) (skills ((go ?o) :elements ((c ?o))
      :actions ((*go ?o))))"""
    assert codes(text) == ["ICR041"]


def test_each_circle_of_impossible_concepts_is_told_once():
    text = """(concepts ((a ?o) :elements ((b ?o))) ((b ?o) :elements ((a ?o)))
      ((c ?o) :elements ((d ?o))) ((d ?o) :elements ((c ?o))))"""
    assert codes(text) == ["ICR041", "ICR041"]


def test_an_argument_of_which_nothing_is_known_conflicts_with_nothing():
    text = """(percepts (peg) (disk))
(concepts ((top ?disk ?peg) :elements ((on-peg ?disk ?peg))))
(skills ((move ?disk ?from ?to)
         :elements ((top ?disk ?from) (peg ?to)) :tests ((/= ?from ?to))
         :actions ((*move ?disk ?from ?to)) :effects ((on-peg ?disk ?to))))"""
    domain, problems = parse_domain(text)
    assert domain is not None, problems
    assert "ICR044" not in [found.code for found in check_domain(domain)]
