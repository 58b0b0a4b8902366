"""The page of typical mistakes shows what is said of them today."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def script():
    path = ROOT / "benchmarks" / "mistakes.py"
    spec = importlib.util.spec_from_file_location("mistakes", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


def test_the_page_is_what_the_script_writes(script):
    page = ROOT / "docs" / "results" / "mistakes.md"
    assert page.read_text(encoding="utf-8") == script.page(), "run: make mistakes"


def test_every_mistake_is_noticed_and_its_message_says_what_to_do(script):
    assert len(script.MISTAKES) >= 20
    for mistake in script.MISTAKES:
        assert "   hint: " in script.said(mistake), mistake.what
