"""The fields of `(test …)`: later cycles, a goal and its plan."""

from __future__ import annotations

from icarus_lite.language import check_domain, parse_domain
from icarus_lite.language.syntax import DomainTest, LaterCycle

DOMAIN = """(percepts (hand) (place))
(skills ((go ?h ?to) :elements ((hand ?h) (place ?to)) :actions ((*go ?to)) :effects ((at ?h ?to))))
"""


def form(fields: str) -> DomainTest:
    domain, problems = parse_domain(f'{DOMAIN}(test "it" {fields})')
    assert domain is not None, problems
    assert not check_domain(domain)
    (test,) = domain.tests
    return test


def problems_of(fields: str) -> list[tuple[str, str]]:
    domain, problems = parse_domain(f'{DOMAIN}(test "it" {fields})')
    found = [*problems, *(check_domain(domain) if domain is not None else ())]
    return [(each.code, each.message) for each in found]


def test_a_test_alone_has_one_cycle_and_no_plan() -> None:
    test = form(":percepts ((hand h))")
    assert (test.then, test.goals, test.plan) == ((), (), None)


def test_later_cycles_keep_their_order() -> None:
    test = form(":then ((:action (go h a)) (:percepts () :expect-not ((at h a))) ())")
    assert [later.percepts for later in test.then] == [None, (), None]
    assert [list(map(str, later.actions)) for later in test.then] == [["(go h a)"], [], []]
    assert test.then[2] == LaterCycle(None, (), (), ())
    assert test.then[1].span.line == 3


def test_a_plan_without_steps_is_not_the_same_as_none() -> None:
    assert form(":goal ((at h a)) :plan ()").plan == ()
    assert form(":goal ((at h a))").plan is None


def test_the_goal_may_be_one_literal_or_several() -> None:
    assert list(map(str, form(":goal (at h a)").goals)) == ["(at h a)"]
    assert len(form(":goal ((at h a) (not (at h b)))").goals) == 2


def test_a_plan_needs_a_goal() -> None:
    ((code, message),) = problems_of(":plan ((go h a))")
    assert (code, message) == ("ICR011", "the test `it` has a `:plan` but no `:goal`")


def test_later_cycles_and_plans_are_checked_like_the_rest() -> None:
    assert problems_of(":then ((:expect ((att h a))))")[0][0] == "ICR013"
    assert problems_of(":then ((:percepts ((hand ?h))))")[0][0] == "ICR025"
    assert problems_of(":then ((:expect ((hand h)) :expect ((hand i))))")[0][0] == "ICR011"
    assert problems_of(":goal ((at h))")[0][0] == "ICR014"
    assert problems_of(":goal ((at h a)) :plan ((go ?h a))")[0][0] == "ICR025"
    assert problems_of(":goal ((at h a)) :plan ((gone h a))")[0][0] == "ICR023"
    assert problems_of(":then ((:goal ((at h a))))")[0][0] in ("ICR008", "ICR009")


def test_a_test_may_begin_with_facts() -> None:
    assert list(map(str, form(":init ((at h a) (attached h a))").init)) == [
        "(at h a)",
        "(attached h a)",
    ]
    assert form(":percepts ((hand h))").init == ()


def test_percepts_are_not_given_but_perceived() -> None:
    assert problems_of(":init ((hand h))") == [
        ("ICR070", "`hand` is a percept: a test perceives it cycle by cycle")
    ]


def test_facts_of_a_test_are_known_and_ground() -> None:
    assert problems_of(":init ((ta h a))") == [("ICR013", "nothing is ever known about `ta`")]
    assert problems_of(":init ((at h ?there))") == [
        ("ICR025", "a fact of :init cannot hold the variable ?there")
    ]
