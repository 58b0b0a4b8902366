"""The core cases of `datalog-conformance`, judged by its own runner.

Each program is told to a network at once, and to another in three parts, of which the last is taken
back and told again; both must give the model that the suite expects. Programs that share their
rules and facts are inferred once.
"""

from __future__ import annotations

import os
from functools import cache

import pytest
from datalog_conformance import ConformanceFailure, Program, YamlTestRunner
from datalog_conformance import TestCase as Case
from datalog_programs import RefusedError, beliefs_of, domain_of
from suite import BEYOND, LARGE, cases, core_files, small_cases

from icarus_lite import Belief
from icarus_lite.inference.network import Budget, Delta, Network, compile_domain

_ALL = "ICARUS_ALL_CASES" in os.environ


class AtOnce:
    """Infers a program's model from all of its facts at once."""

    def evaluate(self, program: Program) -> dict[str, set[tuple]]:
        return _model(_frozen(program), self._told)

    @staticmethod
    def _told(network: Network, facts: list[Belief]) -> None:
        network.update(Delta(asserted=tuple(facts)))


class InParts(AtOnce):
    """Infers a program's model step by step, with some facts taken back and told again."""

    @staticmethod
    def _told(network: Network, facts: list[Belief]) -> None:
        third = len(facts) // 3
        network.update(Delta(asserted=tuple(facts[:third])))
        network.update(Delta(asserted=tuple(facts[third:])))
        network.update(Delta(withdrawn=tuple(facts[-third:])))
        network.update(Delta(asserted=tuple(facts[-third:])))


def _frozen(program: Program) -> tuple:
    facts = tuple((name, tuple(map(tuple, rows))) for name, rows in program.facts.items())
    return tuple(program.rules), facts


@cache
def _model(program: tuple, told) -> dict[str, set[tuple]]:
    rules, facts = program[0], dict(program[1])
    unhurried = Budget(seconds=None)  # the machine may be busy with other tests
    network = compile_domain(domain_of(rules, facts)).network(unhurried)
    told(network, beliefs_of(facts))
    model: dict[str, set[tuple]] = {}
    for belief in network.beliefs():
        model.setdefault(belief.predicate, set()).add(belief.args)
    return model


def _run(case: Case, evaluator: AtOnce) -> None:
    YamlTestRunner(evaluator).run_test_case(case)


@pytest.mark.parametrize("evaluator", [AtOnce(), InParts()], ids=["at once", "in parts"])
@pytest.mark.parametrize("name", [name for name in core_files() if name not in LARGE])
def test_the_core_cases_of_a_file(name: str, evaluator: AtOnce) -> None:
    for case in cases(name):
        if case.name not in BEYOND:
            _run(case, evaluator)


@pytest.mark.parametrize("name", sorted(LARGE))
def test_a_file_of_large_core_cases(name: str) -> None:
    if not _ALL:
        pytest.skip(f"{LARGE[name]}; `make fuzz-engine` runs it")
    for case in cases(name):
        _run(case, AtOnce())
    _model.cache_clear()


def test_what_is_said_to_be_beyond_the_language_is() -> None:
    beyond = {case.name: case for case in small_cases() if case.name in BEYOND}
    assert beyond.keys() == BEYOND.keys()
    for case in beyond.values():
        with pytest.raises(ConformanceFailure):
            _run(case, AtOnce())


def test_no_core_case_is_left_out() -> None:
    assert set(core_files()) >= LARGE.keys()
    assert len(core_files()) == 48
    found = list(small_cases())
    assert len(found) == 92
    assert sum(case.expect_error is not None for case in found) == 6
    assert not [case.name for case in found if case.skip]


def test_the_suite_can_fail() -> None:
    case = next(case for case in small_cases() if case.name == "transitive_closure")

    class Forgetful(AtOnce):
        def evaluate(self, program: Program) -> dict[str, set[tuple]]:
            return {name: set(list(rows)[1:]) for name, rows in super().evaluate(program).items()}

    with pytest.raises(ConformanceFailure):
        _run(case, Forgetful())


def test_a_program_is_refused_by_our_own_checker() -> None:
    with pytest.raises(RefusedError, match="ICR019"):
        domain_of(["p(X) :- q(X), not p(X)."], {"q": [(1,)]})
