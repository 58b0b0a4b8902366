"""The generated Python of one clause, cut out of that of its domain."""

from __future__ import annotations

import textwrap

from icarus_lite.inference.network import CompiledDomain
from icarus_lite.inference.profiling.plans import RulePlan
from icarus_lite.language.syntax import Domain

_RULE = "# ----"
_END = "# ===="


def clause_source(compiled: CompiledDomain, plan: RulePlan) -> str:
    """Give the block of generated code that begins with the text of a clause.

    Args:
        compiled: The domain.
        plan: The clause.
    """
    first, last = clause_lines(compiled.source, compiled.domain)[plan.number]
    lines = compiled.source.splitlines()[first - 1 : last]
    return textwrap.dedent("\n".join(lines)).strip("\n")


def clause_lines(source: str, domain: Domain) -> dict[int, tuple[int, int]]:
    """Give the first and last line of each clause's block, by the clause's number.

    Args:
        source: The generated Python.
        domain: What it was generated from.
    """
    lines = [line.strip() for line in source.splitlines()]
    ends = [n for n, line in enumerate(lines) if line.startswith((_RULE, _END))]
    blocks: dict[int, tuple[int, int]] = {}
    for begin, end in zip(ends, [*ends[1:], len(lines)], strict=True):
        title = lines[begin + 1 : begin + 3]
        for number, clause in enumerate(domain.concepts):
            fits = len(title) == 2 and title[0].endswith(f":{clause.span.line}")
            if fits and title[1] == f"# ({clause.head}" and number not in blocks:
                blocks[number] = begin + 1, end
                break
    return blocks
