from __future__ import annotations

import textwrap

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from icarus_lite.language import parse_domain
from icarus_lite.language.formatting.formatter import format_text

OLD = """\
; An old domain.
(create-concepts   ; what can be derived
  ((block ?b) :percepts ((block ?b)))
  ((near ?a ?b ^gap ?g)
   ; what is seen
   :percepts ((block ?a xpos ?xa "note" ?n)  ; one
              (block ?b xpos ?xb))
   ; what is believed
   :relations ((free ?a) (not (on ?b ?any)))  ; above
   :tests ((/= ?a ?b))
   :conditions (; last
                (clear ?b))  ; the top
   :attributes ((?g (- ?xa ?xb)))))

(create-skills
  ((stack ?a ?b)
   :percepts ((block ?a xpos ?x ypos 3) (not (block ?c zpos ?x)) (hand ?h 4))
   :start ((clear ?b))
   :requires ((holding ?a))
   :action (*stack ?a ?b)  ; the driver's
   :effects ((on ?a ?b)))
  ((tower ?a) :subgoals ((on ?a ?b))))

(create-goals (on a b))

; problems
(create-problems
  ; first
  ((on a b) (on b c))  ; easy
  ((on c a)))  ; hard

(test old :percepts ((block a xpos 3)) :action (stack a b) :expect ((on a b)))
"""


def codes(text):
    return {found.code for found in parse_domain(text)[1]}


def test_an_old_domain_becomes_a_modern_one_and_means_the_same():
    old = OLD.replace('"note"', "note")
    modern = format_text(old, modernize=True)
    assert modern == textwrap.dedent("""\
        ; An old domain.
        (concepts  ; what can be derived
          ((block ?b) :elements ((block ?b)))
          ((near ?a ?b ^gap ?g)
           ; what is seen
           :elements ((block ?a ^xpos ?xa ^note ?n)  ; one
                      (block ?b ^xpos ?xb)
                      ; what is believed
                      (free ?a)
                      (not (on ?b ?any))  ; above
                      ; last
                      (clear ?b))  ; the top
           :tests ((/= ?a ?b))
           :binds ((?g (- ?xa ?xb)))))

        (skills
          ((stack ?a ?b)
           :elements ((block ?a ^xpos ?x ^ypos 3) (not (block ?c ^zpos ?x)) (hand ?h 4) (clear ?b))
           :while ((holding ?a))
           :actions ((*stack ?a ?b))  ; the driver's
           :effects ((on ?a ?b)))
          ((tower ?a) :subskills ((on ?a ?b))))

        (goals (on a b))

        ; problems
        ; first
        (task problem-1 :goal ((on a b) (on b c)))  ; easy
        (task problem-2 :goal ((on c a)))           ; hard

        (test old
          :percepts ((block a xpos 3))
          :action (stack a b)
          :expect ((on a b)))
        """)
    assert format_text(modern, modernize=True) == modern
    before, after = parse_domain(old)[0], parse_domain(modern)[0]
    assert before is not None
    assert after == before
    assert "ICR028" in codes(old)
    assert "ICR028" not in codes(modern)


def test_without_the_option_older_names_stay():
    assert [word for word in format_text(OLD).split() if ":" in word or "create" in word] == [
        word for word in OLD.replace("(;", "( ;").split() if ":" in word or "create" in word
    ]


@pytest.mark.parametrize(
    "clause",
    [
        '((p ?a) :percepts ((block ?a "two words" ?x)))',
        "((p ?a)\n   :percepts ((block ?a))\n   :percepts ((block ?a)))",
        "((p ?a)\n   ; fmt: off\n   :percepts   ((block ?a))\n   ; fmt: on\n  )",
    ],
)
def test_a_clause_that_cannot_be_rewritten_safely_is_left(clause):
    text = f"(concepts\n  {clause})\n"
    assert format_text(text, modernize=True) == text


@pytest.mark.parametrize(
    "text",
    [
        "(create-problems)\n",
        "(create-problems\n  ((on a b))\n  ; no more\n)\n",
        "(create-problems  ; all\n  ((on a b)))\n",
        "(create-problems\n  ((on a b))  ; 1\n)             ; 2\n",
    ],
)
def test_problems_whose_comments_would_have_no_place_are_left(text):
    assert format_text(text, modernize=True) == text


FIELDS = {
    ":percepts": "((block ?a xpos ?x) (block ?b))",
    ":conditions": "((clear ?a))",
    ":relations": "()",
    ":elements": "((free ?b) (not (on ?a ?b)))",
    ":tests": "((/= ?a ?b))",
    ":start": "((near ?a ?b))",
    ":requires": "((holding ?a))",
    ":while": "((seen ?a))",
    ":subgoals": "((go ?a))",
    ":subskills": "((come ?b))",
    ":effects": "((done ?a))",
    ":timeout": "3",
}
GAPS = [" ", " ", "\n", "\n\n", " ; c\n", "\n; d\n", " #| e |# "]


@st.composite
def old_skills(draw):
    names = draw(st.permutations(list(FIELDS)))[: draw(st.integers(0, len(FIELDS)))]
    words = ["(", "create-skills", "(", "(go ?a ?b)"]
    for name in names:
        inside = FIELDS[name].replace("((", "( (").replace("))", ") )")
        words += [name, *inside.split(" ")] if inside.startswith("( ") else [name, inside]
    words += [")", ")"]
    gaps = draw(st.lists(st.sampled_from(GAPS), min_size=len(words), max_size=len(words)))
    return "".join(word + gap for word, gap in zip(words, gaps, strict=True))


@settings(max_examples=80)
@given(old_skills())
def test_fields_in_any_order_mean_the_same_and_keep_their_comments(text):
    modern = format_text(text, modernize=True)
    before, after = parse_domain(text)[0], parse_domain(modern)[0]
    assert before is not None
    assert after == before
    assert "ICR028" not in codes(modern)
    assert format_text(modern, modernize=True) == modern
    for comment in ("; c", "; d", "#| e |#"):
        assert modern.count(comment) == text.count(comment)
