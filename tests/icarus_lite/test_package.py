"""The package's front door: all names there, none imported before it is asked for."""

from __future__ import annotations

import subprocess
import sys

import pytest

import icarus_lite


@pytest.mark.parametrize("name", icarus_lite.__all__)
def test_every_public_name_can_be_imported(name: str) -> None:
    assert getattr(icarus_lite, name) is not None


def test_a_name_that_is_not_there_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'Agnet'"):
        _ = icarus_lite.Agnet


def test_the_names_are_sorted_and_told_once() -> None:
    assert icarus_lite.__all__ == sorted(set(icarus_lite.__all__))
    assert set(icarus_lite._HOMES) == set(icarus_lite.__all__) - {"__version__"}


def test_importing_the_package_imports_no_engine() -> None:
    code = "import sys, icarus_lite; print(*sorted(m for m in sys.modules if 'icarus' in m))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["icarus_lite", "icarus_lite._on_use", "icarus_lite._version"]
