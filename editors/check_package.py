"""Is a packaged extension one that VS Code can load?

    python editors/check_package.py editors/vscode/icarus-lite.vsix

Everything its manifest names must be inside, and its program must find all modules that it asks
for; `vscode` itself is the editor's.
"""  # noqa: INP001 - a script, no package

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree as ET

_NEEDED = ("[Content_Types].xml", "extension.vsixmanifest", "extension/package.json")
_VSIX = "{http://schemas.microsoft.com/developer/vsx-schema/2011}"
_MOST_BYTES = 5_000_000
_LOAD = """
const Module = require("module");
const load = Module._load;
Module._load = (name, ...rest) => (name === "vscode" ? STAND_IN : load(name, ...rest));
const get = (target, name) => (name === "prototype" ? target.prototype : anything());
const anything = () => new Proxy(function () {}, { get });
const STAND_IN = anything();
const { activate, deactivate } = require(process.argv[1]);
const isSound = typeof activate === "function" && typeof deactivate === "function";
if (!isSound) throw new Error("Error: it has no activate and deactivate");
"""


def problems(package: Path) -> Iterator[str]:
    """Say what keeps a package from being loaded, one sentence each."""
    with zipfile.ZipFile(package) as archive:
        names = set(archive.namelist())
        missing = [name for name in _NEEDED if name not in names]
        if missing:
            yield f"it lacks {', '.join(missing)}"
            return
        manifest = json.loads(archive.read("extension/package.json"))
        identity = ET.fromstring(archive.read("extension.vsixmanifest")).find(  # noqa: S314
            f"{_VSIX}Metadata/{_VSIX}Identity"
        )
        if identity is None or identity.get("Version") != manifest["version"]:
            yield "its two manifests give different versions"
        for name in _named(manifest):
            if f"extension/{name.removeprefix('./')}" not in names:
                yield f"its manifest names {name}, which is not inside"
        for name in manifest["dependencies"]:
            if f"extension/node_modules/{name}/package.json" not in names:
                yield f"the module {name} is not inside"
        yield from (f"{name} should not be inside" for name in names if "/tests/" in name)
        if package.stat().st_size > _MOST_BYTES:
            yield f"it is larger than {_MOST_BYTES // 1_000_000} MB"
        yield from _loading(archive, manifest["main"])


def _named(manifest: dict[str, object]) -> Iterator[str]:
    """Give the files that a manifest names."""
    yield str(manifest["main"])
    contributed = manifest["contributes"]
    assert isinstance(contributed, dict)
    for kind, key in (("languages", "configuration"), ("grammars", "path")):
        yield from (each[key] for each in contributed[kind])


def _loading(archive: zipfile.ZipFile, main: str) -> Iterator[str]:
    """Load the program as the editor does, from what is inside and from nowhere else."""
    node = shutil.which("node")
    if node is None:
        return
    with tempfile.TemporaryDirectory() as folder:
        archive.extractall(folder)
        program = str(Path(folder, "extension", main))
        command = [node, "-e", _LOAD, program]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)  # noqa: S603
        if done.returncode:
            said = [line for line in done.stderr.splitlines() if "Error" in line]
            yield f"its program does not load: {' '.join(said[:1]) or done.stderr}"


def main() -> int:
    """Check the packages named on the command line."""
    status = 0
    for name in sys.argv[1:]:
        found = list(problems(Path(name)))
        for each in found:
            sys.stdout.write(f"{name}: {each}\n")
        sys.stdout.write(f"{name}: {'not ' if found else ''}sound\n")
        status = status or bool(found)
    return int(status)


if __name__ == "__main__":
    sys.exit(main())
