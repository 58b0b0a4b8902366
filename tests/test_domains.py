"""The shipped domains: nothing to remark, and tests that hold for a reason."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from icarus_lite.inference import InferenceEngine
from icarus_lite.language import diagnose_file, load_domain
from icarus_lite.language.syntax import Domain, DomainTest
from icarus_lite.testing import run_test, run_tests

DOMAINS = sorted((Path(__file__).parent.parent / "domains").glob("*.icr"))

each_domain = pytest.mark.parametrize("file", DOMAINS, ids=lambda path: path.stem)


def test_the_domains_are_there() -> None:
    names = {file.stem for file in DOMAINS}
    assert {"blocks", "cater", "gearbox", "gripper", "hanoi"} <= names


@each_domain
def test_there_is_nothing_to_remark(file: Path) -> None:
    domain, _, diagnostics = diagnose_file(file)
    assert diagnostics == ()
    assert domain is not None
    assert (domain.name, bool(domain.documentation)) == (file.stem, True)


@each_domain
def test_its_tests_hold(file: Path) -> None:
    outcomes = run_tests(load_domain(file))
    assert outcomes
    assert [outcome.test.name for outcome in outcomes if not outcome.passed] == []


@each_domain
def test_no_test_of_it_would_hold_if_it_stated_the_opposite(file: Path) -> None:
    domain = load_domain(file)
    engine = InferenceEngine(domain)
    held = [
        f"{test.name}: {opposite}"
        for test in domain.tests
        for opposite in _opposites(test)
        if run_test(engine, opposite).passed
    ]
    assert held == []


@each_domain
def test_each_skill_that_acts_occurs_in_a_test(file: Path) -> None:
    domain = load_domain(file)
    acting = {clause.head.predicate for clause in domain.skills if clause.actions}
    assert acting - set(_stated(domain)) == set()


def _opposites(test: DomainTest) -> Iterator[DomainTest]:
    """Give the test with one expectation at a time turned into its opposite."""
    for atom in test.expect:
        yield replace(test, expect=(), expect_not=(atom,), then=(), goals=(), plan=None)
    for atom in test.expect_not:
        yield replace(test, expect=(atom,), expect_not=(), then=(), goals=(), plan=None)
    for at, later in enumerate(test.then):
        for turned in (
            *(replace(later, expect=(), expect_not=(atom,)) for atom in later.expect),
            *(replace(later, expect=(atom,), expect_not=()) for atom in later.expect_not),
        ):
            yield replace(test, then=(*test.then[:at], turned), goals=(), plan=None)
    if test.plan:
        yield replace(test, plan=test.plan[:-1])
        yield replace(test, plan=(*test.plan, test.plan[-1]))


def _stated(domain: Domain) -> Iterator[str]:
    for test in domain.tests:
        for cycle in (test, *test.then):
            yield from (action.predicate for action in cycle.actions)
        yield from (step.predicate for step in test.plan or ())
