"""Typical mistakes, and word for word what is said of each.

    python benchmarks/mistakes.py --out docs/results/mistakes.md

Each mistake comes with a judgement: would you know what to do?
"""

from __future__ import annotations

import argparse
import contextlib
import tempfile
from dataclasses import dataclass
from pathlib import Path

from icarus_lite.language import diagnose_file, render

P = "(percepts (object ^type ^x ^y) (hand ^x))\n"


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake.

    Args:
        what: What the person did.
        text: The file.
        judgement: Whether the message helps, and why.
        encoding: In which the file is saved.
    """

    what: str
    text: str
    judgement: str
    encoding: str = "utf-8"


MISTAKES = (
    Mistake(
        "A parenthesis forgotten at the end of a clause",
        P + "(concepts\n  ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0)))\n\n"
        "(goals (left o1))",
        "Yes: it names the form and the line at whose end the parenthesis is missing.",
    ),
    Mistake(
        "A parenthesis too many",
        P + "(concepts\n  ((plug ?o) :elements ((object ?o ^type plug))))\n"
        "  ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0))))",
        "Yes: it shows the very parenthesis, and what it closes too early.",
    ),
    Mistake(
        "A field's list without its outer parentheses",
        P + "(concepts ((busy ?h) :elements (hand ?h)))",
        "Yes: it shows the shape.",
    ),
    Mistake(
        "A field misspelt",
        P + "(concepts ((busy ?h) :element ((hand ?h))))",
        "Yes.",
    ),
    Mistake(
        "A form misspelt",
        P + "(concept ((busy ?h) :elements ((hand ?h))))",
        "Yes.",
    ),
    Mistake(
        "A percept type misspelt",
        P + "(concepts ((plug ?o) :elements ((objcet ?o ^type plug))))",
        "Yes.",
    ),
    Mistake(
        "An attribute misspelt",
        P + "(concepts ((plug ?o) :elements ((object ?o ^tpye plug))))",
        "Yes.",
    ),
    Mistake(
        "Attributes without their hats",
        P + "(concepts ((plug ?o) :elements ((object ?o type plug))))",
        "Yes: the hint writes the pattern as it was meant.",
    ),
    Mistake(
        "A variable without its question mark",
        P + "(concepts ((plug ?o) :elements ((object o ^type plug))))",
        "Yes: it has found the `o` and says what to write.",
    ),
    Mistake(
        "Commas between arguments",
        P + "(concepts ((pair ?a, ?b) :elements ((object ?a) (object ?b))))",
        "Yes: it says that the comma became part of the name.",
    ),
    Mistake(
        "A variable misspelt",
        P + "(concepts ((left ?obj) :elements ((object ?obj ^x ?x)) :tests ((< ?xx 0))))",
        "Yes: the two remarks show the slip, and the second asks whether the other was meant.",
    ),
    Mistake(
        "A variable used only inside `not`",
        P + "(concepts ((free ?h) :elements ((hand ?h) (not (attached ?o ?h)))))",
        "Yes: it says how it is read, and what to write if that is meant.",
    ),
    Mistake(
        "Two patterns in one `not`",
        P + "(concepts ((free ?h) :elements ((hand ?h) (not (object a) (object b)))))",
        "Yes.",
    ),
    Mistake(
        "Elements joined by `and`",
        P + "(concepts ((pair ?a ?b) :elements ((and (object ?a) (object ?b)))))",
        "Yes: it says that elements are joined anyway.",
    ),
    Mistake(
        "A quoted symbol, as in Lisp",
        P + "(concepts ((plug ?o) :elements ((object ?o ^type 'plug))))",
        "Yes.",
    ),
    Mistake(
        "A comparison among the elements",
        P + "(concepts ((left ?o) :elements ((object ?o ^x ?x) (< ?x 0))))",
        "Yes.",
    ),
    Mistake(
        "A pattern among the tests",
        P + "(concepts ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0) (hand ?x))))",
        "Yes: it knows that `hand` is perceived, and says where that belongs.",
    ),
    Mistake(
        "`==` for `=`",
        P + "(concepts ((plug ?o) :elements ((object ?o ^type ?t)) :tests ((== ?t plug))))",
        "Yes.",
    ),
    Mistake(
        "A test that is a number",
        P + "(concepts ((far ?o) :elements ((object ?o ^x ?x ^y ?y)) :tests "
        "((distance ?x ?y 0 0))))",
        "Yes.",
    ),
    Mistake(
        "An object compared with a number",
        P + "(concepts ((left ?o) :elements ((object ?o)) :tests ((< ?o 0))))",
        "Yes: it says why the variable is a symbol.",
    ),
    Mistake(
        "A symbol attribute compared with a number",
        P + "(concepts ((plug ?o) :elements ((object ?o ^type plug)))\n"
        "  ((big ?o) :elements ((object ?o ^type ?t)) :tests ((> ?t 2))))",
        "Yes: it shows the line that it concludes this from.",
    ),
    Mistake(
        "A wrong number of arguments",
        P + "(concepts ((near ?a ?b) :elements ((object ?a ^x ?x) (object ?b ^x ?x))))\n"
        "(goals (near o1))",
        "Yes: it shows the head.",
    ),
    Mistake(
        "A concept that depends on its own negation",
        P + "(concepts\n  ((good ?o) :elements ((object ?o) (not (bad ?o))))\n"
        "  ((bad ?o) :elements ((object ?o) (not (good ?o)))))",
        "Yes: the circle is shown, though which `not` to remove only the author knows.",
    ),
    Mistake(
        "A recursion that never begins",
        P + "(concepts ((above ?a ?c) :elements ((above ?a ?b) (above ?b ?c))))",
        "Yes.",
    ),
    Mistake(
        "A command without its star",
        P + "(skills ((open ?h) :elements ((hand ?h)) :actions ((open ?h))))",
        "Yes.",
    ),
    Mistake(
        "A skill that does nothing",
        P + "(skills ((wait ?h) :elements ((hand ?h))))",
        "Yes.",
    ),
    Mistake(
        "A subskill misspelt",
        P + "(skills\n  ((open ?h) :elements ((hand ?h)) :actions ((*open ?h)))\n"
        "  ((drop ?h) :elements ((hand ?h)) :subskills ((opne ?h))))",
        "Yes.",
    ),
    Mistake(
        "A detach action under another name (the paper has both put-down and place-down)",
        P + "(skills\n  ((pick-up ?h ?o) :elements ((hand ?h) (object ?o)) :actions "
        "((*grasp ?h ?o)))\n  ((place-down ?h ?o) :elements ((attached ?o ?h)) :actions "
        "((*place ?h ?o))))\n"
        "(attachments ((pick-up ?h ?o) :until (put-down ?h ?o) :child ?o :parent ?h))",
        "Yes. Spelt quite differently, the hint would say that only an observed action can match.",
    ),
    Mistake(
        "A goal that no skill leads to",
        P + "(concepts ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0))))\n"
        "(skills ((push ?o) :elements ((object ?o)) :actions ((*push ?o))))\n"
        "(task 1 :goal ((left o1)))",
        "Yes: the effect to add is written out.",
    ),
    Mistake(
        "A task without a goal",
        P + '(task 1.1 "Attach hub cover to case" :robot ur5)',
        "Yes.",
    ),
    Mistake(
        "A variable in a test",
        P + '(test "a plug" :percepts ((object ?o ^type plug)))',
        "Yes.",
    ),
    Mistake(
        "An effect on a percept",
        P + "(skills ((push ?o) :elements ((object ?o)) :actions ((*push ?o)) "
        ":effects ((object ?o ^x 1))))",
        "Yes.",
    ),
    Mistake(
        "A field of an older dialect without a counterpart",
        P + "(create-skills ((push ?o) :percepts ((object ?o)) :changes ((object ?o ^x 1)) "
        ":action (*push ?o)))",
        "Yes.",
    ),
    Mistake(
        "An include of a file that is not there",
        '(include "parts.icr")\n' + P,
        "Yes: it says where it has looked.",
    ),
    Mistake(
        "A file saved as UTF-16",
        P,
        "Yes.",
        encoding="utf-16",
    ),
    Mistake(
        "A parenthesis forgotten in the middle of a clause, among others that are fine",
        P + "(concepts\n  ((near ?a ?b)\n   :elements ((object ?a ^x ?x) (object ?b ^x ?x)\n"
        "   :tests ((/= ?a ?b)))\n  ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0))))",
        "Yes: the clause, the list in it and the line; the clauses behind it are not blamed.",
    ),
    Mistake(
        "A parenthesis forgotten before a field in the same line, and a slip further on",
        P + "(concepts\n  ((left ?o :elements ((object ?o ^x ?x)) :tests ((< ?x 0)))\n"
        "  ((plug ?o) :elements ((objct ?o ^type plug))))",
        "Yes: it says before which word; and the other mistake is told in the same run.",
    ),
    Mistake(
        "A comparison written as in mathematics",
        P + "(concepts ((left ?o) :elements ((object ?o ^x ?x)) :tests ((?x < 0))))",
        "Yes: it writes the test as it must be.",
    ),
    Mistake(
        "A comparison inside a pattern",
        P + "(concepts ((left ?o) :elements ((object ?o ^x < 0))))",
        "Yes: it shows how to name the value and where to compare it.",
    ),
    Mistake(
        "An attribute with an equals sign",
        P + "(concepts ((plug ?o) :elements ((object ?o ^type=plug))))",
        "Yes.",
    ),
    Mistake(
        "An attribute marked with a colon",
        P + "(concepts ((plug ?o) :elements ((object ?o :type plug))))",
        "Yes.",
    ),
    Mistake(
        "A field without its colon",
        P + "(concepts ((plug ?o) elements ((object ?o ^type plug))))",
        "Yes.",
    ),
    Mistake(
        "A clause whose head has no parentheses of its own",
        P + "(concepts (plug ?o) :elements ((object ?o ^type plug)))",
        "Yes: it shows the shape of a clause.",
    ),
    Mistake(
        "Alternatives joined by `or`",
        P + "(concepts ((thing ?o) :elements (or (object ?o) (hand ?o))))",
        "Yes: one clause for each alternative.",
    ),
    Mistake(
        "`nil` for an empty field",
        P + "(concepts ((busy) :elements nil))",
        "Yes.",
    ),
    Mistake(
        "A goal of several literals without a parenthesis around them",
        P + "(skills ((grasp ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o))\n"
        "  :effects ((held ?o))))\n(task fetch :goal (held o1) (held o2))",
        "Yes: it shows the list.",
    ),
    Mistake(
        "A test among the effects",
        P + "(skills ((push ?o) :elements ((object ?o ^x ?x)) :actions ((*push ?o))\n"
        "  :effects ((= ?x 3))))",
        "Yes: an effect is a belief. It used to load, and would have been believed.",
    ),
    Mistake(
        "A sum as an argument",
        P + "(skills ((push ?o) :elements ((object ?o ^x ?x)) :actions ((*push ?o))\n"
        "  :effects ((at ?o (+ ?x 1)))))",
        "Mostly: it says where to compute, but a skill has no :binds, so a concept must be found.",
    ),
    Mistake(
        "A precondition, as in PDDL",
        P + "(skills ((go ?h) :precondition ((hand ?h)) :actions ((*go ?h))))",
        "Yes.",
    ),
    Mistake(
        "Curly quotation marks, from a word processor",
        "(domain shop “A shop”)\n" + P,
        "Yes.",
    ),
    Mistake(
        "A blank that is none, from a web page",
        P + "(concepts ((plug\u00a0?o) :elements ((object ?o ^type plug))))",
        "Yes: nobody could have seen it.",
    ),
    Mistake(
        "A comma in a number",
        P + "(concepts ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 0,5))))",
        "Yes.",
    ),
    Mistake(
        "A number with a unit",
        P + "(concepts ((left ?o) :elements ((object ?o ^x ?x)) :tests ((< ?x 5cm))))",
        "Yes; what the unit is, only the percepts' author knows.",
    ),
    Mistake(
        "`_` for anything, as in Prolog",
        P + "(concepts ((busy) :elements ((object _ ^type plug))))",
        "Yes. It used to load without a word, and never matched.",
    ),
    Mistake(
        "A comment of another language",
        "# what there is\n" + P,
        "Yes.",
    ),
    Mistake(
        "Capitals",
        "(PERCEPTS (object ^type))\n(concepts ((Plug ?O) :elements ((object ?o ^type plug))))",
        "Yes: form and variable are both recognised. The heads of concepts may be in capitals.",
    ),
    Mistake(
        "A moment of a skill as the breakpoint of a concept",
        P + "(concepts ((plug ?o) :elements ((object ?o ^type plug)) :break on-start))",
        "Yes: it lists those of a concept.",
    ),
)


def said(mistake: Mistake) -> str:
    """Give what is said of a mistake."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        Path("mine.icr").write_bytes(mistake.text.encode(mistake.encoding))
        _, source, found = diagnose_file("mine.icr")
    return "\n".join(render(each, source) for each in found)


def page() -> str:
    """Write all mistakes with their messages as a page."""
    sections = [
        f"## {number}. {each.what}\n\n```lisp\n{each.text.rstrip()}\n```\n\n```text\n{said(each)}\n"
        f"```\n\n{each.judgement}\n"
        for number, each in enumerate(MISTAKES, start=1)
    ]
    opening = (
        "# Typical mistakes, and what is said of them\n\n"
        "Made by `make mistakes`; a test keeps it true. Below each message stands the answer to "
        "the question: would you know what to do?\n"
    )
    return "\n".join([opening, *sections])


def main() -> None:
    """Write the page."""
    parser = argparse.ArgumentParser(description="Typical mistakes, and what is said of them.")
    parser.add_argument("--out", type=Path, help="where the page goes")
    options = parser.parse_args()
    text = page()
    if options.out:
        options.out.write_text(text, encoding="utf-8")
    else:
        print(text)


if __name__ == "__main__":
    main()
