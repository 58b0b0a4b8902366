"""What is looked at in a packaged extension."""

from __future__ import annotations

import importlib.util
import json
import shutil
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "editors" / "vscode"
IDENTITY = """<?xml version="1.0"?>
<PackageManifest xmlns="http://schemas.microsoft.com/developer/vsx-schema/2011">
<Metadata><Identity Id="icarus-lite" Version="{}"/></Metadata></PackageManifest>
"""
CLIENT = "node_modules/vscode-languageclient/"


@pytest.fixture(scope="module")
def script():
    path = ROOT / "editors" / "check_package.py"
    spec = importlib.util.spec_from_file_location("check_package", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def package(tmp_path):
    """Give what packages the extension, without some files and with others."""

    def make(without=(), version="0.1.0", **more):
        manifest = (EXTENSION / "package.json").read_text(encoding="utf-8")
        assert json.loads(manifest)["version"] == "0.1.0"
        files = {
            "package.json": manifest,
            "extension.js": (EXTENSION / "extension.js").read_text(encoding="utf-8"),
            "language-configuration.json": "{}",
            "syntaxes/icarus.tmLanguage.json": "{}",
            "syntaxes/markdown.tmLanguage.json": "{}",
            f"{CLIENT}package.json": '{"main": "node.js"}',
            f"{CLIENT}node.js": "exports.LanguageClient = class {};",
            **more,
        }
        path = tmp_path / "it.vsix"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("[Content_Types].xml", "<Types/>")
            archive.writestr("extension.vsixmanifest", IDENTITY.format(version))
            for name, text in files.items():
                if name not in without:
                    archive.writestr(f"extension/{name}", text)
        return path

    return make


def test_a_sound_package_is_sound(script, package):
    assert list(script.problems(package())) == []


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"without": ("package.json",)}, "it lacks extension/package.json"),
        ({"version": "0.2.0"}, "its two manifests give different versions"),
        (
            {"without": ("syntaxes/icarus.tmLanguage.json",)},
            "its manifest names ./syntaxes/icarus.tmLanguage.json, which is not inside",
        ),
        (
            {"without": (f"{CLIENT}package.json",)},
            "the module vscode-languageclient is not inside",
        ),
        ({"tests/clauses.icr": ""}, "extension/tests/clauses.icr should not be inside"),
    ],
)
def test_what_is_wrong_is_told(script, package, changes, said):
    assert said in list(script.problems(package(**changes)))


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_a_program_that_does_not_load_is_told(script, package):
    (found,) = script.problems(package(**{"extension.js": 'require("left-out");'}))
    assert found.startswith("its program does not load: Error: Cannot find module 'left-out'")
    (found,) = script.problems(package(**{"extension.js": "module.exports = {};"}))
    assert "no activate" in found
