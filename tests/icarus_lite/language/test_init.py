"""`:init` of a task: what it may give, and the words in which the rest is refused."""

from __future__ import annotations

from icarus_lite.language import check_domain, parse_domain, render

HEAD = """(percepts (block ^x) (hand))
(concepts ((clear ?b) :elements ((block ?b) (not (on ?any ?b)))))
(skills ((move ?a ?b) :elements ((clear ?a) (clear ?b) (near ?a ?b)) :actions ((*move ?a ?b))
         :effects ((on ?a ?b))))
"""


def found(init: str) -> list[str]:
    domain, problems = parse_domain(f"{HEAD}(task t :init ({init}) :goal ((on a b)))", "d.icr")
    assert domain is not None, problems
    return [render(each, domain.source) for each in check_domain(domain)]


def test_percepts_attachments_effects_and_facts_of_its_own_may_be_given() -> None:
    assert found("(block a ^x 3) (block b) (on b a) (near a b) (attached a b)") == []


def test_the_facts_are_in_the_tree() -> None:
    domain, _ = parse_domain(f"{HEAD}(task t :init ((block a ^x 3) (near a b)) :goal ((on a b)))")
    assert domain is not None
    assert list(map(str, domain.tasks[0].init)) == ["(block a ^x 3)", "(near a b)"]


def test_a_concept_is_derived_and_not_given() -> None:
    (text,) = found("(near a b) (clear a)")
    assert text == (
        "d.icr:5:28: error[ICR070]: `clear` is a concept: it is derived, and cannot be given\n"
        "    5 | (task t :init ((near a b) (clear a)) :goal ((on a b)))\n"
        "      |                            ^^^^^\n"
        "   hint: give the facts that its clauses speak of"
    )


def test_a_fact_that_nobody_asks_for_is_probably_misspelt() -> None:
    (text,) = found("(near a b) (naer b a)")
    assert text == (
        "d.icr:5:28: warning[ICR070]: nothing asks for `naer`\n"
        "    5 | (task t :init ((near a b) (naer b a)) :goal ((on a b)))\n"
        "      |                            ^^^^\n"
        "   hint: did you mean `near`?"
    )


def test_facts_have_no_variables() -> None:
    (text,) = found("(near a ?b)")
    assert "error[ICR025]: a fact of :init cannot hold the variable ?b" in text


def test_percepts_are_checked_like_any_other() -> None:
    texts = found("(near a b) (block a ^y 3) (block a b) (hand 3)")
    codes = [text.split("error[")[1][:6] for text in texts]
    assert codes == ["ICR015", "ICR014", "ICR014"]
