"""The cases of `datalog-conformance`, and which of them our language does not express."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import yaml
from datalog_conformance import TestCase, get_tests_dir

BEYOND = {
    "unsafe_negation_variable_only_in_negative_literal": (
        "a variable that occurs only inside `not` is legal here: it reads 'there is none'"
    ),
}
"""Core cases that our language cannot express as they are meant, and why."""

LARGE = {
    "recursion/souffle_example_hmmer.yaml": "54,000 facts; reading the file alone takes 2 s",
    "recursion/souffle_example_lubm.yaml": "120,000 facts; reading the file alone takes 10 s",
}
"""Files of core cases that are run by `make fuzz-engine` only, and why."""

NOT_CORE = "defeasible"
"""The folder of the cases on defeasible logic, which is another language."""


def core_files() -> list[str]:
    """Give the files with core cases."""
    root = get_tests_dir()
    names = (path.relative_to(root).as_posix() for path in sorted(root.rglob("*.yaml")))
    return [name for name in names if not name.startswith(NOT_CORE)]


@cache
def cases(name: str) -> tuple[TestCase, ...]:
    """Read the cases of a file."""
    # The suite's own reader does the same in pure Python, which takes minutes.
    raw = yaml.load((get_tests_dir() / name).read_text("utf-8"), yaml.CSafeLoader)
    entries = raw.get("tests", [raw])
    shared = {key: raw[key] for key in ("source", "tags", "verification") if key in raw}
    return tuple(TestCase.from_dict({**shared, **entry}) for entry in entries)


def small_cases() -> Iterator[TestCase]:
    """Give all core cases but those of the large files."""
    for name in core_files():
        if name not in LARGE:
            yield from cases(name)
