"""Goals that are given together are what they always were: one conjunction, for the executor."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

from icarus_lite import Agent
from icarus_lite.execution import Executor

WORLDS = Path(__file__).parents[1] / "execution" / "test_random_domains.py"


class Unmanaged(Agent):
    """An agent whose executor pursues all goals, without any management."""

    def __init__(self, domain, goals=(), **options):
        super().__init__(domain, goals, **options)
        evaluator = self._engine.evaluator
        self._executor = Executor(domain, evaluator, self.goals, self.intentions)
        self._management = self

    def decide(self, moment, outcomes):
        going, failures = self._executor.settle(moment, outcomes)
        return going or self._executor.choose(moment, failures), ()


@pytest.fixture(scope="module")
def worlds():
    spec = importlib.util.spec_from_file_location("random_domains", WORLDS)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


def said(decisions):
    return [
        (each.kind, each.reason, str(each.skill_path), each.path, each.failures, each.candidates)
        for each in decisions
    ]


@pytest.mark.parametrize("calm", [True, False])
def test_one_goal_is_pursued_as_if_there_were_no_others_to_choose_from(worlds, monkeypatch, calm):
    managed = [said(worlds.decisions_of(seed, calm=calm)) for seed in range(40)]
    monkeypatch.setattr(worlds, "Agent", Unmanaged)
    unmanaged = [said(worlds.decisions_of(seed, calm=calm)) for seed in range(40)]
    assert managed == unmanaged
    assert max(map(len, managed)) > 3
