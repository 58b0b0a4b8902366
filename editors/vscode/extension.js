// Starts `icarus lsp` and lets it answer for every .icr file. All knowledge is in the server.

"use strict";

const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

/** @type {LanguageClient | undefined} */
let client;

/** @returns {LanguageClient} a client for the server that the settings name */
function makeClient() {
  const [command, ...args] = vscode.workspace.getConfiguration("icarus").get("command");
  const folder = vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
  const server = { command, args, options: { cwd: folder } }; // over standard input and output
  const selector = [{ language: "icarus" }];
  return new LanguageClient("icarus", "ICARUS", server, { documentSelector: selector });
}

async function start() {
  client = makeClient();
  try {
    await client.start();
  } catch (error) {
    client = undefined;
    const settings = "Open the settings";
    const chosen = await vscode.window.showErrorMessage(
      `The ICARUS language server does not start: ${error.message ?? error}. ` +
        "Install it with pip install 'icarus-lite[lsp]', or name its program in icarus.command.",
      settings,
    );
    if (chosen === settings) {
      await vscode.commands.executeCommand("workbench.action.openSettings", "icarus.command");
    }
  }
}

async function stop() {
  const running = client;
  client = undefined;
  await running?.stop();
}

/** @param {vscode.ExtensionContext} context */
async function activate(context) {
  const restart = async () => {
    await stop();
    await start();
  };
  context.subscriptions.push(
    vscode.commands.registerCommand("icarus.restart", restart),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("icarus.command")) {
        void restart();
      }
    }),
  );
  await start();
}

module.exports = { activate, deactivate: stop };
