"""Packages that import their names on use: all names are there, each from where it says."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module

import pytest

LAZY = (
    "icarus_lite.inference",
    "icarus_lite.inference.network",
    "icarus_lite.inference.network.kernels",
    "icarus_lite.language",
    "icarus_lite.language.pddl",
    "icarus_lite.planning",
    "icarus_lite.planning.search",
)


@pytest.mark.parametrize("package", LAZY)
def test_every_public_name_can_be_imported_from_its_module(package: str) -> None:
    module = import_module(package)
    for name, home in module._HOMES.items():
        assert getattr(module, name) is getattr(import_module(f"{package}.{home}"), name)
    for name in module.__all__:
        assert getattr(module, name) is not None


@pytest.mark.parametrize("package", LAZY)
def test_the_names_are_told_once_and_no_module_stands_in_the_way(package: str) -> None:
    module = import_module(package)
    assert len(set(module.__all__)) == len(module.__all__)
    assert set(module._HOMES) <= set(module.__all__)
    for name in module._HOMES:
        with pytest.raises(ModuleNotFoundError):
            import_module(f"{package}.{name}")


@pytest.mark.parametrize("package", LAZY)
def test_a_name_that_is_not_there_is_an_attribute_error(package: str) -> None:
    with pytest.raises(AttributeError, match=f"module '{package}' has no attribute 'Nonesuch'"):
        _ = import_module(package).Nonesuch


@pytest.mark.parametrize("package", LAZY)
def test_a_package_alone_imports_nothing_slow(package: str) -> None:
    code = f"import sys, {package}; print(*sorted({{'numpy', 'lark'}} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []
