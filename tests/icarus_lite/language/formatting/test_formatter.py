from __future__ import annotations

import re
import textwrap

import pytest

from icarus_lite.language.formatting.formatter import format_text


def dedent(text):
    return textwrap.dedent(text).lstrip("\n")


def assert_formats(before, after):
    expected = dedent(after)
    assert format_text(dedent(before)) == expected
    assert format_text(expected) == expected


def test_a_clause_that_fits_stays_on_one_line():
    assert_formats(
        """
        (concepts ((free ?hand)
            :elements ((hand ?hand)
                       (not (holding ?hand ?any)))))
        """,
        """
        (concepts
          ((free ?hand) :elements ((hand ?hand) (not (holding ?hand ?any)))))
        """,
    )


def test_a_clause_with_several_lists_has_each_on_a_line_of_its_own():
    assert_formats(
        """
        (skills
        ((go ?h) :elements ((hand ?h)) :actions ((*go ?h)) :timeout 20))
        """,
        """
        (skills
          ((go ?h)
           :elements ((hand ?h))
           :actions ((*go ?h))
           :timeout 20))
        """,
    )


def test_literals_that_do_not_fit_stand_below_each_other():
    assert_formats(
        """
        (concepts
          ((in-reach ?hand ?obj) :elements ((hand ?hand ^reach ?reach) (object ?obj ^x ?x
          ^y ?y ^z ?z) (not (attached ?obj ?anything)))))
        """,
        """
        (concepts
          ((in-reach ?hand ?obj)
           :elements ((hand ?hand ^reach ?reach)
                      (object ?obj ^x ?x ^y ?y ^z ?z)
                      (not (attached ?obj ?anything)))))
        """,
    )


def test_a_pattern_that_does_not_fit_keeps_attribute_and_value_together():
    attributes = " ".join(f"^attribute-{n} ?value-{n}" for n in range(6))
    text = format_text(f"(concepts ((p ?x) :elements ((object ?x {attributes}))))")
    assert text == dedent("""
        (concepts
          ((p ?x)
           :elements ((object ?x ^attribute-0 ?value-0 ^attribute-1 ?value-1 ^attribute-2 ?value-2
                              ^attribute-3 ?value-3 ^attribute-4 ?value-4 ^attribute-5 ?value-5))))
        """)
    assert format_text(text) == text


def test_the_order_of_fields_is_the_authors():
    text = "(test a\n  :expect ((p x))\n  :percepts ((p x)))\n"
    assert format_text(text) == text


def test_an_attribute_marker_is_a_hat_and_a_command_keeps_its_star():
    assert_formats(
        "(skills ((p ?o) :elements ((o ?o *type a)) :actions ((*grasp ?o *force 3))"
        " :tests ((> (* 2 3) 5))))",
        """
        (skills
          ((p ?o)
           :elements ((o ?o ^type a))
           :actions ((*grasp ?o ^force 3))
           :tests ((> (* 2 3) 5))))
        """,
    )


def test_attachments_are_a_table():
    assert_formats(
        """
        (attachments
          ((pick-up ?hand ?obj) :until (place-down ?hand ?obj) :child ?obj :parent ?hand)
          ((insert ?obj ?into) :until (take-out ?obj ?into) :child ?obj :parent ?into)

          ((tie ?a ?b) :child ?a :parent ?b))
        """,
        """
        (attachments
          ((pick-up ?hand ?obj) :until (place-down ?hand ?obj) :child ?obj :parent ?hand)
          ((insert ?obj ?into)  :until (take-out ?obj ?into)   :child ?obj :parent ?into)

          ((tie ?a ?b) :child ?a :parent ?b))
        """,
    )


def test_a_table_that_would_be_too_wide_is_none():
    long = "x" * 20
    text = dedent(f"""
        (attachments
          ((a ?{long}) :until (b ?c) :child ?{long} :parent ?d)
          ((a ?e) :until (b ?{long} ?{long}) :child ?e :parent ?f))
        """)
    assert format_text(text) == text


def test_forms_are_apart_unless_short_ones_of_a_kind_stand_together():
    assert_formats(
        """
        (include "a.icr")
        (include "b.icr")
        (domain d)
        (goals (on a b))


        (goals (on b c))
        """,
        """
        (include "a.icr")
        (include "b.icr")

        (domain d)

        (goals (on a b))

        (goals (on b c))
        """,
    )


def test_blank_lines_between_clauses_are_kept_one_at_a_time():
    assert_formats(
        """
        (concepts

          ((p ?x) :elements ((o ?x)))
          ((q ?x) :elements ((o ?x)))



          ((r ?x) :elements ((o ?x)))

          )
        """,
        """
        (concepts
          ((p ?x) :elements ((o ?x)))
          ((q ?x) :elements ((o ?x)))

          ((r ?x) :elements ((o ?x))))
        """,
    )


def test_percept_types_and_goals_stand_below_each_other():
    assert_formats(
        "(percepts (object ^x) (part :is object ^grip)) (goals (on a b) (not (on b c)))",
        """
        (percepts
          (object ^x)
          (part :is object ^grip))

        (goals
          (on a b)
          (not (on b c)))
        """,
    )


def test_a_form_the_grammar_does_not_know_is_laid_out_like_the_others():
    assert_formats(
        '(rule  "a new one"  :when ((p ?x)  ; first\n (q ?x)) :then (r   ?x))',
        """
        (rule "a new one"
          :when ((p ?x)  ; first
                 (q ?x))
          :then (r ?x))
        """,
    )


def test_later_cycles_of_a_test_begin_with_a_field():
    assert_formats(
        "(test a :percepts ((h x)) :then ((:percepts ((h x)) :expect ((p x))) (:expect ((q x)))))",
        """
        (test a
          :percepts ((h x))
          :then ((:percepts ((h x))
                  :expect ((p x)))
                 (:expect ((q x)))))
        """,
    )


def test_strings_and_numbers_are_verbatim():
    name = '"a  \\"b\\"\t; no comment\n   #| nor this |#"'
    text = f'(test {name}\n  :percepts ((o a ^x +1.50e-3 ^y "")))\n'
    assert format_text(text) == text


class TestComments:
    def test_comments_stay_where_they_were(self):
        assert_formats(
            """
            ; the file

            ;; about a

            (concepts   ; what can be derived
                 ; about the clause
               ((p ?x)      ; its head
               ; about the field
                 :elements ((o ?x)   ; first
               ; about the second
                   (q ?x))     ; second
                   )
                   ; none left
             )   ; the end
            ; bye
            """,
            """
            ; the file

            ;; about a

            (concepts  ; what can be derived
              ; about the clause
              ((p ?x)  ; its head
               ; about the field
               :elements ((o ?x)  ; first
                          ; about the second
                          (q ?x))  ; second
              )
              ; none left
            )  ; the end
            ; bye
            """,
        )

    def test_neighbouring_comments_at_line_ends_are_aligned(self):
        assert_formats(
            """
            (percepts
              (object ^x ^y ^z) ; in m
              (hand ^x) ; also
              (a)
              (b) ; alone
              (c))
            """,
            """
            (percepts
              (object ^x ^y ^z)  ; in m
              (hand ^x)          ; also
              (a)
              (b)  ; alone
              (c))
            """,
        )

    def test_comments_are_not_aligned_with_one_far_off(self):
        text = dedent(f"""
            (percepts
              (a)  ; near
              (b ^{"x" * 40})  ; far
              (c))
            """)
        assert format_text(text) == text

    def test_a_comment_below_a_form_stays_there(self):
        text = dedent("""
            (domain d)
            ; that was the domain

            ; here are the goals
            (goals (on a b))
            """)
        assert format_text(text) == text

    def test_block_comments_are_untouched(self):
        assert_formats(
            """
            #| many
                lines   |#
            (percepts   #| all |#   (object ^x   #| in m |#   ^y)
               #| no more |#)
            """,
            """
            #| many
                lines   |#
            (percepts
              #| all |# (object ^x #| in m |# ^y)
              #| no more |#)
            """,
        )

    def test_a_comment_between_a_parenthesis_and_what_it_opens(self):
        assert_formats(
            """
            (concepts
              ((p ?x) :elements (
                 ; the thing itself
                 (o ?x))))
            """,
            """
            (concepts
              ((p ?x)
               :elements (; the thing itself
                          (o ?x))))
            """,
        )

    def test_a_text_of_comments_only(self):
        assert_formats("\n\n; a   \n\n\n\n; b\n\n", "; a\n\n; b\n")


class TestOff:
    def test_what_is_switched_off_stays_as_it_is(self):
        text = dedent("""
            (skills
              ; fmt: off
              ; as printed
              ((pick-up ?hand ?obj)
               :elements ((hand ?hand)
                       (object ?obj *type output))
               :actions   ((*grasp ?hand ?obj)))
              ; fmt: on

              ((go ?h) :timeout 20))
            """)
        assert format_text(text) == text

    def test_around_it_all_is_laid_out(self):
        assert_formats(
            """
            (domain   a)
               ; fmt: off
            (goals   (on a b)
               )
                 ; fmt: on
            (goals   (on b c))
            """,
            """
            (domain a)

            ; fmt: off
            (goals   (on a b)
               )
            ; fmt: on

            (goals (on b c))
            """,
        )

    def test_it_ends_with_its_list(self):
        assert_formats(
            """
            (concepts
              ; fmt: off
              ((p ?x)   :elements ((o ?x)))
              ((q ?x)   :elements ((o ?x)))   )
            (goals   (on b c))
            """,
            """
            (concepts
              ; fmt: off
              ((p ?x)   :elements ((o ?x)))
              ((q ?x)   :elements ((o ?x))))

            (goals (on b c))
            """,
        )

    def test_it_ends_with_the_file(self):
        text = "(domain d)\n\n; fmt: off\n(goals   (on a b))\n; bye\n"
        assert format_text(text) == text

    def test_single_fields_may_be_switched_off(self):
        text = dedent("""
            (skills
              ((go ?h)
               :elements ((hand ?h))
               ; fmt: off
               :tests ((<   1   2))
               ; fmt: on
               :timeout 20))
            """)
        assert format_text(text) == text

    def test_behind_other_words_it_is_a_comment_like_others(self):
        text = "(domain   d) ; fmt: off\n(goals   (on a b))\n"
        assert format_text(text) == "(domain d)  ; fmt: off\n\n(goals (on a b))\n"


@pytest.mark.parametrize(
    "text",
    [
        "(a",
        "(a))",
        '(a "b)',
        "(a #| b)",
        "(a#|b|#)",
        "(a 'b)",
        "(" * 101 + ")" * 101,
    ],
)
def test_a_text_that_does_not_hold_together_is_left_alone(text):
    assert format_text(text) == text


@pytest.mark.parametrize("text", ["", "\n \t\r\n", "\f"])
def test_nothing_comes_of_nothing(text):
    assert format_text(text) == ""


def test_lines_end_with_lf():
    text = "; a\r\n(domain d #| x\r\n y |#)\r\n\r\n\r\n(goals (on a b))\r\n"
    assert format_text(text) == "; a\n(domain d #| x\n y |#)\n\n(goals (on a b))\n"


def test_letters_of_all_scripts_are_kept():
    text = '; größe\n(domain würfel "积木 🧱\N{NO-BREAK SPACE}")\n'
    assert format_text(text) == text


def test_deep_nesting_moves_to_the_right_slowly():
    text = format_text("(a (" + "function-with-a-name (" * 98 + ")" * 100)
    indents = [len(line) - len(line.lstrip()) for line in text.splitlines()]
    assert 100 < max(indents) < 250
    assert re.sub(r"\s", "", text) == "(a(" + "function-with-a-name(" * 98 + ")" * 100
    assert format_text(text) == text
