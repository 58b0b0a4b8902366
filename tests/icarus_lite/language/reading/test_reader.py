from __future__ import annotations

import time
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from icarus_lite.language import (
    CODES,
    DomainError,
    Severity,
    check_domain,
    parse_atom,
    parse_domain,
    render,
)
from icarus_lite.language.reading.brackets import FORM_NAMES
from icarus_lite.language.reading.lines import Lines
from icarus_lite.language.reading.sources import decode
from icarus_lite.language.syntax import (
    Atom,
    Call,
    Constant,
    Domain,
    PerceptType,
    Span,
    Variable,
)

GEARBOX = (Path(__file__).parents[4] / "domains" / "gearbox.icr").read_text(encoding="utf-8")
PAPER_CLAUSE = """\
((pick-up ?hand ?obj)
 :elements ((hand ?hand)
         (object ?obj *type output)
         (in-reachable-pose ?hand ?obj)
         (not (holding ?hand ?any)))
 :actions ((*grasp ?hand ?obj))
 :effects ((holding ?hand ?obj)))"""


def read(text) -> Domain:
    domain, diagnostics = parse_domain(text, "d.icr")
    assert domain is not None, "\n".join(render(each, text) for each in diagnostics)
    return domain


def errors(text):
    domain, diagnostics = parse_domain(text, "d.icr")
    assert domain is None
    return diagnostics


def test_a_whole_domain():
    domain = read("""
    (domain gearbox "One arm.")
    (percepts (object ^type ^x) (hand))
    (concepts ((near ?a ?b ^d ?d) :binds ((?d (distance ?x ?y))) :tests ((/= ?a ?b))
               :elements ((object ?a ^x ?x) (object ?b ^x ?y))))
    (skills ((go ?h) :timeout 20 :while ((hand ?h)) :effects ((at ?h) (not (away ?h)))
             :elements ((hand ?h)) :tests ((= 1 1.0)) :actions ((*go ?h fast))))
    (skills ((tour ?h) :subskills ((go ?h) (go ?h))))
    (attachments ((insert ?o ?i) :parent ?i :until (take-out ?o ?i) :child ?o))
    (goals (at h1) (not (away h1)))
    (task 1.10 "There" :robot ur5 :goal ((at h1)))
    (task home :goal (at h1))
    (test "it goes" :percepts ((hand h1)) :action (go h1) :expect ((at h1)) :expect-not ((x)))
    """)
    assert (domain.name, domain.documentation) == ("gearbox", "One arm.")
    assert domain.percepts == (PerceptType("object", ("type", "x")), PerceptType("hand", ()))
    near = domain.concepts[0]
    assert str(near.head) == "(near ?a ?b ^d ?d)"
    assert [str(each) for each in near.elements] == ["(object ?a ^x ?x)", "(object ?b ^x ?y)"]
    assert (near.binds[0].variable, str(near.binds[0].expression)) == (
        Variable("?d"),
        "(distance ?x ?y)",
    )
    go, tour = domain.skills
    assert (go.timeout_s, go.actions) == (20.0, (parse_atom("(go ?h fast)"),))
    assert [str(each) for each in go.effects] == ["(at ?h)", "(not (away ?h))"]
    assert [str(each) for each in go.holds] == ["(hand ?h)"]
    assert len(tour.subskills) == 2
    rule = domain.attachments[0]
    assert (rule.child, rule.parent, str(rule.until)) == (
        Variable("?o"),
        Variable("?i"),
        "(take-out ?o ?i)",
    )
    assert [str(goal) for goal in domain.goals] == ["(at h1)", "(not (away h1))"]
    assert [(task.name, task.title, task.robot) for task in domain.tasks] == [
        ("1.10", "There", "ur5"),
        ("home", "", None),
    ]
    assert domain.tasks[0].goals == domain.tasks[1].goals
    test = domain.tests[0]
    assert (test.name, test.actions) == ("it goes", (parse_atom("(go h1)"),))
    assert (test.expect, test.expect_not) == ((parse_atom("(at h1)"),), (parse_atom("(x)"),))


def test_the_papers_clause_verbatim_equals_its_spelling_with_a_hat():
    verbatim = read(f"(skills {PAPER_CLAUSE})").skills
    assert verbatim == read(f"(skills {PAPER_CLAUSE.replace('*type', '^type')})").skills
    assert verbatim[0].elements[1].atom.attributes == (("type", Constant("output")),)
    assert verbatim[0].actions[0].predicate == "grasp"
    assert verbatim == read(GEARBOX).skills[:1]


def test_the_papers_clause_stands_in_the_gearbox_domain_as_printed():
    lines = [line.strip() for line in PAPER_CLAUSE.splitlines()]
    assert "\n".join(lines) in "\n".join(line.strip() for line in GEARBOX.splitlines())


def test_names_of_forms_are_ordinary_names_elsewhere():
    head, element = "(domain ?test ^goals ?task)", "(task ?test *concepts percepts ^not ?task)"
    clause = read(f"(concepts ({head} :elements ({element})))").concepts[0]
    assert (clause.head, clause.elements[0].atom) == (parse_atom(head), parse_atom(element))
    assert read("(domain domain)").name == "domain"


def test_several_actions_in_a_test_with_and_without_a_list():
    bare = read('(test "t" :action (a) (b x))').tests[0].actions
    assert bare == read('(test "t" :action ((a) (b x)))').tests[0].actions
    assert [str(action) for action in bare] == ["(a)", "(b x)"]


def test_comments_are_ignored_wherever_they_stand():
    text = '; one\n(goals #| (b\n |# (a ; (c)\n "; no comment" "#| nor this |#"))#||#;end'
    assert [str(goal) for goal in read(text).goals] == ['(a "; no comment" "#| nor this |#")']


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-7", -7),
        ("+7", 7),
        ("0.25", 0.25),
        ("-.5", -0.5),
        ("5.", 5.0),
        ("1e3", 1000.0),
        ("-2.5E-3", -0.0025),
        ("1.1.1", "1.1.1"),
        ("-", "-"),
        ("12mm", "12mm"),
        ("nan", "nan"),
        ("inf", "inf"),
        ("pick-up", "pick-up"),
        ("größe", "größe"),
        ('"a b"', "a b"),
        ('"say \\"no\\" \\\\ \\n\\t"', 'say "no" \\ \n\t'),
        ('"two\nlines"', "two\nlines"),
        ('""', ""),
    ],
)
def test_constants(text, value):
    (constant,) = parse_atom(f"(p {text})").args
    assert constant == Constant(value)
    assert type(constant.value) is type(value)


def test_older_forms_and_fields_mean_the_same_as_the_modern_ones():
    older = """
    (create-concepts ((on ?a ?b) :percepts ((block ?a x ?x) (block ?b ^x ?x)) :tests ((/= ?a ?b))
                                 :relations ((r ?a)) :conditions ((not (s ?a)))))
    (create-skills ((up ?a) :start ((on ?a ?b)) :requires ((r ?a)) :subgoals ((up ?b))))
    (create-goals (on a b) (not (on b a)))
    """
    modern = """
    (concepts ((on ?a ?b) :tests ((/= ?a ?b))
      :elements ((block ?a ^x ?x) (block ?b ^x ?x) (r ?a) (not (s ?a)))))
    (skills ((up ?a) :elements ((on ?a ?b)) :while ((r ?a)) :subskills ((up ?b))))
    (goals (on a b) (not (on b a)))
    """
    _, notes = parse_domain(older)
    assert read(older) == read(modern)
    assert {note.severity for note in notes} == {Severity.NOTE}
    assert len(notes) == 9
    assert parse_domain(modern)[1] == ()


def test_a_domain_without_a_name_is_called_like_its_file():
    assert parse_domain("(goals (a))", "some/blocks.icr")[0].name == "blocks"
    assert parse_domain("(goals (a))")[0].name == "unnamed"


def test_mistakes_in_several_forms_are_reported_together():
    text = "(concepts ((p) :elemnts ()))\n(goals (a))\n(task)\n(skill)\n(goals (b 1e999))"
    assert [(each.code, each.span.line) for each in errors(text)] == [
        ("ICR008", 1),
        ("ICR009", 3),
        ("ICR007", 4),
        ("ICR010", 5),
    ]


def test_a_form_left_open_does_not_swallow_the_next_ones():
    text = "(concepts\n  ((p ?x) :elements ((q ?x)))\n\n(gaols (a))\n\n(task 1)\n(tsk 1)\n"
    assert [(each.code, each.span.line) for each in errors(text)] == [
        ("ICR002", 1),
        ("ICR007", 4),
        ("ICR007", 7),
    ]


def test_a_known_form_may_begin_a_line_inside_another_when_all_is_closed():
    assert read("(goals\n(test a)\n(task b))").goals[0].atom.predicate == "test"


def test_deep_nesting_is_an_error_and_not_a_crash():
    deep = "(concepts ((p) :tests (" + "(not " * 100_000 + "(= 1 1)" + ")" * 100_000 + ")))"
    assert [each.code for each in errors(deep)] == ["ICR005"]
    fine = "(concepts ((p) :tests (" + "(not " * 90 + "(= 1 1)" + ")" * 90 + ")))"
    assert check_domain(read(fine)) == ()


GEARBOX_LINES = Lines(GEARBOX)


def text_at(span: Span) -> str:
    start = GEARBOX_LINES.offset(span.line, span.column)
    return GEARBOX[start : GEARBOX_LINES.offset(span.end_line, span.end_column)]


def assert_spans_inside(expression) -> None:
    if isinstance(expression, Call):
        assert text_at(expression.span).startswith(f"({expression.function}")
        assert text_at(expression.span).endswith(")")
        for argument in expression.args:
            assert_spans_inside(argument)
    else:
        assert parse_atom(f"(p {text_at(expression.span)})").args == (expression,)


def test_spans_of_atoms_and_terms_point_at_their_text():
    domain = read(GEARBOX)
    clauses = [*domain.concepts, *domain.skills]
    atoms = [condition.atom for clause in clauses for condition in clause.elements]
    atoms += [clause.head for clause in clauses]
    atoms += [percept for test in domain.tests for percept in test.percepts]
    for atom in atoms:
        assert parse_atom(text_at(atom.span)) == atom
        for term in (*atom.args, *(value for _, value in atom.attributes)):
            assert_spans_inside(term)


def test_spans_of_clauses_conditions_and_tests_point_at_their_text():
    domain = read(GEARBOX)
    for clause in (*domain.concepts, *domain.skills):
        assert text_at(clause.span).startswith("((")
        for test in clause.tests:
            assert_spans_inside(test)
        for condition in clause.elements:
            assert text_at(condition.span).startswith("(not ") is condition.negated
    assert [text_at(task.span)[:9] for task in domain.tasks] == [
        f"(task {task.name}" for task in domain.tasks
    ]


def test_a_hundred_kilobytes_are_read_in_about_a_second():
    text = "\n".join(PAPER_CLAUSE.replace("pick-up", f"pick-up-{number}") for number in range(450))
    text = f"(skills {text})"
    assert len(text) > 100_000
    parse_domain("(goals (a))")  # the parser is built once
    begin = time.process_time()
    domain = read(text)
    assert time.process_time() - begin < 3
    assert len(domain.skills) == 450


def test_bytes_become_text():
    assert decode(b"\xef\xbb\xbf(goals\r\n (a))", "d.icr").text == "(goals\n (a))"
    with pytest.raises(DomainError) as caught:
        decode(b"(goals\n  (gr\xf6\xdfe))", "d.icr")
    assert str(caught.value) == (
        "d.icr:2:6: error[ICR001]: the byte 0xf6 is not UTF-8\n"
        "    2 |   (gr\ufffd\ufffde))\n"
        "      |      ^\n"
        "   hint: save the file as UTF-8"
    )


def assert_sound(text):
    """Assert what holds for the reading of any text whatsoever."""
    domain, diagnostics = parse_domain(text, "d.icr")
    failed = any(each.severity is Severity.ERROR for each in diagnostics)
    assert (domain is None) == failed
    if domain is not None:
        diagnostics += check_domain(domain)
    rows = text.split("\n")
    for each in diagnostics:
        assert each.code in CODES
        assert render(each, text).startswith("d.icr:")
        assert 0 <= each.span.line <= len(rows)
        if each.span.line:
            assert 1 <= each.span.column <= len(rows[each.span.line - 1]) + 1


@settings(max_examples=200, deadline=None)
@given(st.text())
def test_any_text_is_read_or_explained(text):
    assert_sound(text)


PUNCTUATION = list("()()()()()\"'?^*:;|#\\\n\t\0")
WORDS = [
    *PUNCTUATION,
    *FORM_NAMES,
    *(":elements", ":tests", ":binds", ":actions", ":effects", ":child", ":goal", ":percepts"),
    *("not", "?x", "^type", "*grasp", "plug", "1.5", "1e999", "#|", "|#", ":timeout"),
]


@settings(max_examples=200, deadline=None)
@given(st.lists(st.sampled_from(WORDS), max_size=30).map(" ".join))
def test_any_words_of_the_language_are_read_or_explained(text):
    assert_sound(text)


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.tuples(
            st.integers(0, len(GEARBOX)),
            st.integers(0, 6),
            st.one_of(st.sampled_from(WORDS), st.text(max_size=3)),
        ),
        min_size=1,
        max_size=4,
    )
)
def test_any_mutation_of_a_domain_is_read_or_explained(edits):
    text = GEARBOX
    for start, length, inserted in edits:
        text = text[:start] + inserted + text[start + length :]
    assert_sound(text)


names = st.from_regex(r"[a-z][a-z0-9-]{0,6}", fullmatch=True)
readable = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=6)
terms = st.one_of(
    st.builds(Constant, readable),
    st.builds(Constant, st.integers()),
    st.builds(Constant, st.floats(allow_nan=False, allow_infinity=False)),
    st.builds(Variable, names.map("?{}".format)),
)
atoms = st.builds(
    Atom,
    names,
    st.lists(terms, max_size=4).map(tuple),
    st.lists(st.tuples(names, terms), max_size=3).map(tuple),
)


@given(atoms)
def test_what_is_printed_reads_back_the_same(atom):
    assert parse_atom(str(atom)) == atom
