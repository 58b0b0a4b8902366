"""The small benchmark problems, the shipped tasks, and the reference they are compared with."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

PROBLEMS = Path(__file__).parent / "problems"
_REFERENCE = Path(__file__).parents[3] / "reference" / "naive_pddl.py"


@pytest.fixture(scope="session")
def naive_pddl() -> ModuleType:
    """Give the reference implementation of PDDL."""
    spec = importlib.util.spec_from_file_location("naive_pddl", _REFERENCE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["naive_pddl"] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def problems() -> Path:
    """Give the folder of the benchmark problems."""
    return PROBLEMS
