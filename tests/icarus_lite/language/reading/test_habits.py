"""Habits from other languages: each is told with what is written here instead."""

from __future__ import annotations

import pytest

from icarus_lite.language import diagnose_text
from icarus_lite.language.keywords import FIELDS
from icarus_lite.language.reading.habits import HABITS
from icarus_lite.language.reading.parsing import parser
from icarus_lite.language.reading.stumbles import FIELD_TERMINALS

PERCEPTS = "(percepts (object ^type ^x) (hand))\n"
CASES = {
    "# objects\n": ("`#` begins no comment", "a comment begins with ;"),
    "// objects\n": ("`//` begins no comment", "a comment begins with ;"),
    "(concepts ((l ?o) :elements [(object ?o)]))": (
        "`[` is no parenthesis of the language",
        "all are round: ( and )",
    ),
    "(concepts ((l\N{NO-BREAK SPACE}?o) :elements ((object ?o))))": (
        "a character that looks like a blank is none: U+00A0",
        "write an ordinary blank instead",
    ),
    "(goals\N{ZERO WIDTH SPACE} (l o))": (
        "a character that looks like a blank is none: U+200B",
        "write an ordinary blank instead",
    ),
    "(domain shop \N{LEFT DOUBLE QUOTATION MARK}A shop\N{RIGHT DOUBLE QUOTATION MARK})": (
        "is a typographic quotation mark",
        'strings stand in straight ones: "…"',
    ),
    "(domain shop 'A shop')": (
        "a string does not begin with '",
        'strings stand in double quotes: "…"',
    ),
    "(domain shop A shop of things)": (
        "expected a string, found `A`",
        'put it into double quotes: "A shop of things"',
    ),
    "(include parts.icr)": (
        "expected a string, found `parts.icr`",
        'put it into double quotes: "parts.icr"',
    ),
    '(concepts ((l ?o) "it lies" :elements ((object ?o))))': (
        "a clause has no string of its own",
        "say what the clause means in a comment above it",
    ),
    '(concepts ((l ?o) :elements ((object ?o)) :break "on-gain"))': (
        "a moment is a word, not a string",
        "write :break on-gain",
    ),
    "(concepts ((l ?o) elements ((object ?o))))": (
        "`elements` has no colon, as fields do",
        "write :elements",
    ),
    "(concepts ((l ?o) :elements ((object ?o ^x ?x)) :tests ((?x < 0.5))))": (
        "the function comes first, not `?x`",
        "write (< ?x 0.5)",
    ),
    "(concepts ((l ?o) :elements ((object ?o ^x ?x)) :tests ((< (2 * ?x) 1))))": (
        "the function comes first, not `2`",
        "write (* 2 ?x)",
    ),
    "(concepts ((l ?o ^y ?y) :elements ((object ?o ^x ?x)) :binds ((?y = ?x + 1))))": (
        "a bind is a variable and one expression",
        "such as (?y (+ ?x 1))",
    ),
    "(concepts ((l ?o) :elements ((object ?o ^type=plug))))": (
        'the attribute `^type=plug` needs a value, not ")"',
        "its value stands behind a blank: ^type plug",
    ),
    "(concepts ((l ?o) :elements ((object ?o ^x (> 3)))))": (
        "a pattern compares nothing: it only names values",
        "^x ?x … :tests ((< ?x 3))",
    ),
    "(concepts ((l ?o) :elements ((object ?o ^x > 3))))": (
        "a pattern compares nothing: it only names values",
        "^x ?x … :tests ((> ?x 3))",
    ),
    "(concepts ((l ?o) :elements ((object ?o :type plug))))": (
        "`:type` cannot stand in a pattern",
        "attributes are marked with a hat: ^type",
    ),
    "(concepts ((l ?o) :elements ((object ?o ^ type plug))))": (
        "`^` stands alone",
        "its name follows without a blank: ^type",
    ),
    "(concepts ((l) :elements ((object ? ^type plug))))": (
        "`?` stands alone",
        "a variable has a name: ?obj, or ?_ for anything",
    ),
    "(skills ((go ?h) :elements ((hand ?h)) :actions ((go* ?h))))": (
        "the star stands before a command, not behind it",
        "write *go",
    ),
    "(concepts ((l ?h) :elements ((hand ?h) !(object ?h))))": (
        "`!` is no negation",
        "write (not (holding ?hand ?obj))",
    ),
    "(concepts ((l ?h) :elements ((hand ?h) (NOT (object ?h)))))": (
        "`NOT` stands in capitals, and case matters",
        "write (not (holding ?hand ?obj))",
    ),
    "(concepts ((l ?h) :elements (and (hand ?h))))": (
        "`and` does not join the entries of `:elements`",
        "all entries must hold anyway: :elements ((…) (…))",
    ),
    "(concepts ((l ?h) :elements (OR (hand ?h) (object ?h))))": (
        "`OR` does not join the entries of `:elements`",
        "alternatives are clauses with the same head",
    ),
    "(concepts (plug ?o) :elements ((object ?o)))": (
        'a second "(" is missing before `plug`',
        "a clause and its head have one each: ((plug …) :elements (…))",
    ),
    "(concepts ((l) :elements nil))": (
        "`:elements` takes patterns, not `nil`",
        "a field with nothing in it is left out",
    ),
    "(task 1 :goal (object o1) (object o2))": (
        "a second list stands behind `:goal`",
        "its entries go into one list: :goal ((…) (…))",
    ),
    "(task :goal (object o1))": ("the task has no name", "write (task NAME :goal ((…)))"),
    "(skills ((go ?h) :elements ((hand ?h)) :actions ((*go ?h)) :timeout 5s))": (
        "`:timeout` takes a number, not `5s`",
        "such as :timeout 5",
    ),
    "(skills ((go ?h) :elements ((hand ?h)) :actions ((*go ?h)) :effects ((at ?h (+ 1 2)))))": (
        "an argument is a variable or a value, nothing in parentheses",
        "a concept computes with :binds",
    ),
    "(skills ((go ?h) :precondition ((hand ?h)) :actions ((*go ?h))))": (
        "`:precondition` is a word of PDDL",
        "say when it may start in :elements",
    ),
    "(define (domain shop))": ("this looks like PDDL", "icarus pddl import makes a domain of it"),
    "(GOALS (object o1))": ("there is no form `GOALS`", "did you mean `goals`?"),
}


@pytest.mark.parametrize(("text", "said"), CASES.items(), ids=CASES)
def test_a_habit_is_told_with_what_to_write(text, said):
    _, _, found = diagnose_text(PERCEPTS + text, "d.icr")
    message, hint = said
    assert message in found[0].message
    assert hint in found[0].hint


def test_one_habit_is_one_remark():
    for text in CASES:
        _, _, found = diagnose_text(PERCEPTS + text, "d.icr")
        assert len(found) == 1, text


def test_every_habit_is_met():
    from icarus_lite.language.reading import explanations  # noqa: PLC0415

    met = set()
    watched = tuple(watch(habit, met) for habit in HABITS)
    before, explanations.HABITS = explanations.HABITS, watched
    try:
        for text in CASES:
            diagnose_text(PERCEPTS + text, "d.icr")
    finally:
        explanations.HABITS = before
    assert {habit.__name__ for habit in HABITS} - met == set()


def watch(habit, met):
    def watched(context):
        found = habit(context)
        if found is not None:
            met.add(habit.__name__)
        return found

    return watched


@pytest.mark.parametrize(
    ("written", "hint"),
    [
        ("0,5", "the number is written 0.5"),
        ('"0.5"', "the number is written 0.5"),
        ("\N{EN DASH}1", "the number is written -1"),
        ("5cm", "a number has no unit: write it in the unit of what it is compared with"),
        ("plug", "Each is less than the next."),
    ],
)
def test_numbers_written_in_another_way(written, hint):
    text = f"(concepts ((l ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x {written}))))"
    _, _, (found,) = diagnose_text(PERCEPTS + text, "d.icr")
    assert (found.code, found.hint) == ("ICR017", hint)


def test_a_number_before_its_function():
    text = "(concepts ((l ?o) :elements ((object ?o ^x ?x)) :tests ((3 < ?x))))"
    _, _, (found,) = diagnose_text(PERCEPTS + text, "d.icr")
    assert (found.code, found.hint) == ("ICR016", "the function comes first: (< 3 …)")


def test_names_that_mean_something_else():
    text = PERCEPTS + "(concepts ((busy) :elements ((object _ ^type plug))))"
    _, _, (found,) = diagnose_text(text, "d.icr")
    assert (found.code, found.hint) == ("ICR047", "write ?_ for anything")
    text = (
        PERCEPTS + "(skills ((go ?h) :elements ((hand ?h)) :actions ((*go ?h)) :effects ((and))))"
    )
    assert [each.code for each in diagnose_text(text, "d.icr")[2]] == ["ICR047"]


def test_hints_know_every_field_of_the_grammar():
    written = {each.pattern.value.partition("(?!")[0] for each in parser().terminals}
    assert {name for name in written if name in FIELDS} <= set(FIELD_TERMINALS.values())
