"""The extension's few lines, run with stand-ins for VS Code and its language client."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

EXTENSION = Path(__file__).parents[2] / "editors" / "vscode" / "extension.js"
NODE = shutil.which("node")

STAND_INS = """
const Module = require("module");
const [extension, failing] = process.argv.slice(1);
const said = { started: [], stopped: 0, errors: [], commands: [] };
let restart;
const vscode = {
  workspace: {
    getConfiguration: () => ({ get: () => ["/opt/icarus", "lsp"] }),
    workspaceFolders: [{ uri: { fsPath: "/project" } }],
    onDidChangeConfiguration: () => ({ dispose() {} }),
  },
  window: { showErrorMessage: async (message) => { said.errors.push(message); } },
  commands: {
    registerCommand: (name, run) => { said.commands.push(name); restart = run; },
    executeCommand: async () => {},
  },
};
class LanguageClient {
  constructor(id, name, server, options) { Object.assign(this, { id, server, options }); }
  async start() {
    if (failing === "yes") throw new Error("spawn ENOENT");
    said.started.push({ id: this.id, server: this.server, options: this.options });
  }
  async stop() { said.stopped += 1; }
}
const load = Module._load;
Module._load = (name, ...rest) =>
  ({ vscode, "vscode-languageclient/node": { LanguageClient } })[name] ?? load(name, ...rest);
(async () => {
  const { activate, deactivate } = require(extension);
  await activate({ subscriptions: [] });
  await restart();
  await deactivate();
  console.log(JSON.stringify(said));
})();
"""


def run(*, failing):
    answer = "yes" if failing else "no"
    done = subprocess.run(
        [NODE, "-e", STAND_INS, str(EXTENSION), answer],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads(done.stdout)


@pytest.mark.skipif(NODE is None, reason="node is not installed")
def test_it_starts_restarts_and_stops_the_server_of_the_settings():
    said = run(failing=False)
    assert said["commands"] == ["icarus.restart"]
    assert len(said["started"]) == said["stopped"] == 2
    assert said["started"][0] == {
        "id": "icarus",
        "server": {"command": "/opt/icarus", "args": ["lsp"], "options": {"cwd": "/project"}},
        "options": {"documentSelector": [{"language": "icarus"}]},
    }
    assert said["errors"] == []


@pytest.mark.skipif(NODE is None, reason="node is not installed")
def test_a_server_that_does_not_start_is_told_with_what_to_do():
    said = run(failing=True)
    assert said["errors"][0] == (
        "The ICARUS language server does not start: spawn ENOENT. Install it with "
        "pip install 'icarus-lite[lsp]', or name its program in icarus.command."
    )
