// Colours files with the engine that VS Code itself uses, and writes what it has seen as JSON:
// node tests/tokens.js FILE… gives [[[line, start, end, scope], …], …], columns in UTF-16 units.

"use strict";

const fs = require("node:fs");
const path = require("node:path");
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const GRAMMARS = { "source.icarus": path.join(__dirname, "../syntaxes/icarus.tmLanguage.json") };

async function main(files) {
  const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
  await oniguruma.loadWASM(new Uint8Array(wasm).buffer);
  const registry = new textmate.Registry({
    onigLib: Promise.resolve({
      createOnigScanner: (sources) => new oniguruma.OnigScanner(sources),
      createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async (scope) =>
      GRAMMARS[scope]
        ? textmate.parseRawGrammar(fs.readFileSync(GRAMMARS[scope], "utf8"), GRAMMARS[scope])
        : null,
  });
  const grammar = await registry.loadGrammar("source.icarus");
  console.log(JSON.stringify(files.map((file) => tokens(grammar, fs.readFileSync(file, "utf8")))));
}

function tokens(grammar, text) {
  const found = [];
  let state = textmate.INITIAL;
  text.split("\n").forEach((line, number) => {
    const result = grammar.tokenizeLine(line, state);
    if (result.stoppedEarly) {
      throw new Error(`line ${number + 1} takes too long to colour`);
    }
    for (const { startIndex, endIndex, scopes } of result.tokens) {
      found.push([number, startIndex, endIndex, scopes[scopes.length - 1]]);
    }
    state = result.ruleStack;
  });
  return found;
}

main(process.argv.slice(2)).catch((error) => {
  console.error(error);
  process.exitCode = 1;
});
