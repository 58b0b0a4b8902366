"""What all tests share: hypothesis runs the same examples each time."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
    database=None,
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))

ROOT = Path(__file__).resolve().parent.parent


_WITH_CONTROLLERS = ("runtime/controller", "runtime/drivers", "runtime/test_run.py")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run all that starts controllers in one process, one after the other.

    A controller's address is free again once it has died: another test at the same time would
    start its own there, and be taken for the dead one.
    """
    for item in items:
        place = item.path.relative_to(ROOT / "tests").as_posix() if _is_ours(item.path) else ""
        if place.startswith(_WITH_CONTROLLERS) or item.get_closest_marker("robot"):
            item.add_marker(pytest.mark.xdist_group("robot"))


def _is_ours(path: Path) -> bool:
    return path.is_relative_to(ROOT / "tests")


@pytest.fixture
def root() -> Path:
    """Give the folder of the project."""
    return ROOT


@pytest.fixture
def gearbox() -> Path:
    """Give the shipped domain file."""
    return ROOT / "domains" / "gearbox.icr"
