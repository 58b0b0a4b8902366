"""The generated Python of a clause: its own block and nothing else."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from icarus_lite import load_domain
from icarus_lite.inference.network import compile_domain
from icarus_lite.inference.profiling import clause_source, rule_plans

DOMAINS = sorted((Path(__file__).parents[4] / "domains").glob("*.icr"))


@pytest.mark.parametrize("path", DOMAINS, ids=lambda path: path.stem)
def test_each_clause_has_a_block_that_begins_with_its_text(path: Path) -> None:
    compiled = compile_domain(load_domain(path))
    blocks = []
    for plan in rule_plans(compiled):
        block = clause_source(compiled, plan)
        rule, place, head, *_ = block.splitlines()
        assert rule.startswith("# ----")
        assert place == f"# {plan.place}"
        assert head == f"# ({plan.clause.head}"
        assert block.count("# ----------") == 1
        assert "# ====" not in block
        assert any(isinstance(each, ast.FunctionDef) for each in ast.parse(block).body)
        blocks.append(block)
    assert len(set(blocks)) == len(blocks)
