"""The server as an editor meets it: a process that talks over its standard input and output."""

from __future__ import annotations

import asyncio
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.client import LanguageClient

from icarus_lite.language.formatting.formatter import format_text

DEADLINE_S = 30
DOMAINS = Path(__file__).parents[3] / "domains"
# A comment with a character outside the BMP: two UTF-16 units, one code point, four bytes.
SMALL = """\
(percepts (object ^type ^x) (hand ^reach))
(concepts
  ((free ?hand) :elements ((hand ?hand) (not (holding ?hand ?any)))) #| 🦾é |# ((near ?a) :tests ((< ?d 1)))
  ; Anything round.
  ((ball ?obj) :elements ((object ?obj ^type ball))))
(skills
  ((pick-up ?hand ?obj)
   :elements ((free ?hand) (ball ?obj))
   :actions ((*grasp ?hand ?obj))
   :effects ((holding ?hand ?obj))))
(task fetch :goal ((holding hand1 ball1)))
"""  # noqa: E501 - what is tested is a long line


@dataclass
class Editor:
    """An editor with one server."""

    runner: asyncio.Runner
    client: LanguageClient
    published: asyncio.Queue[types.PublishDiagnosticsParams] = field(default_factory=asyncio.Queue)
    capabilities: types.ServerCapabilities | None = None

    def ask(self, request):
        async def answer():
            return await asyncio.wait_for(request, DEADLINE_S)

        return self.runner.run(answer())

    def diagnostics(self, uri, version=None):
        """Wait for what is published about a text."""

        async def wait():
            while True:
                found = await self.published.get()
                if found.uri == uri and version in (None, found.version):
                    return found.diagnostics

        return self.ask(wait())

    def open(self, uri, text):
        item = types.TextDocumentItem(uri, "icarus", 1, text)

        async def send():
            self.client.text_document_did_open(types.DidOpenTextDocumentParams(item))

        self.ask(send())
        return self.diagnostics(uri)

    def change(self, uri, text, version):
        document = types.VersionedTextDocumentIdentifier(version, uri)
        whole = types.TextDocumentContentChangeWholeDocument(text)

        async def send():
            self.client.text_document_did_change(
                types.DidChangeTextDocumentParams(document, [whole])
            )

        self.ask(send())
        return self.diagnostics(uri, version)

    def close(self, uri):
        async def send():
            self.client.text_document_did_close(
                types.DidCloseTextDocumentParams(types.TextDocumentIdentifier(uri))
            )

        self.ask(send())
        return self.diagnostics(uri)


def start(encodings=None):
    runner = asyncio.Runner()
    client = LanguageClient("tests", "1")
    editor = Editor(runner, client)

    @client.feature(types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
    def published(params):
        editor.published.put_nowait(params)

    async def begin():
        await client.start_io(sys.executable, "-m", "runtime.cli", "lsp")
        general = types.GeneralClientCapabilities(position_encodings=encodings)
        renaming = types.RenameClientCapabilities(prepare_support=True)
        texts = types.TextDocumentClientCapabilities(rename=renaming)
        capabilities = types.ClientCapabilities(general=general, text_document=texts)
        answer = await client.initialize_async(types.InitializeParams(capabilities=capabilities))
        client.initialized(types.InitializedParams())
        return answer

    editor.capabilities = editor.ask(begin()).capabilities
    return editor


def stop(editor):
    async def end():
        await editor.client.shutdown_async(None)
        editor.client.exit(None)
        await editor.client.stop()
        return editor.client._server

    server = editor.ask(end())
    errors = editor.ask(server.stderr.read()).decode()
    editor.runner.close()
    return server.returncode, errors


@pytest.fixture(scope="module")
def editor():
    editor = start()
    yield editor
    code, errors = stop(editor)
    assert (code, errors) == (0, "")


@pytest.fixture
def uri(tmp_path):
    return (tmp_path / "small.icr").as_uri()


def at(text, needle, within=0):
    """Give the UTF-16 position of a needle, or so many characters into it."""
    offset = text.index(needle) + within
    line = text.count("\n", 0, offset)
    before = text[text.rfind("\n", 0, offset) + 1 : offset]
    return types.Position(line, len(before.encode("utf-16-le")) // 2)


def marked(text, place):
    """Give the stretch of a text that a range marks, counting in UTF-16 units."""
    lines = text.encode("utf-16-le").decode("utf-16-le").split("\n")
    assert place.start.line == place.end.line
    line = lines[place.start.line].encode("utf-16-le")
    return line[place.start.character * 2 : place.end.character * 2].decode("utf-16-le")


def document(uri):
    return types.TextDocumentIdentifier(uri)


def test_it_offers_what_it_says(editor):
    offered = editor.capabilities
    assert offered.text_document_sync.change is types.TextDocumentSyncKind.Full
    assert offered.position_encoding == "utf-16"
    assert offered.rename_provider.prepare_provider
    assert offered.completion_provider.trigger_characters == ("(", ":", "^", "*", "?")
    assert offered.document_formatting_provider
    assert offered.document_symbol_provider
    assert offered.references_provider
    assert offered.definition_provider
    assert offered.hover_provider
    assert "skill" not in offered.semantic_tokens_provider.legend.token_types


def test_diagnostics_stand_under_the_words_they_are_about(editor, uri):
    found = {each.code: each for each in editor.open(uri, SMALL)}
    assert {"ICR012"} <= found.keys()
    unbound = found["ICR012"]
    assert marked(SMALL, unbound.range) in ("?d", "?a")
    assert unbound.severity is types.DiagnosticSeverity.Error
    assert unbound.source == "icarus"
    assert unbound.message.splitlines()[1] == "bind it in a positive pattern of :elements"


def test_a_change_brings_new_diagnostics(editor, uri):
    sound = SMALL.replace("((near ?a) :tests ((< ?d 1)))", "")
    assert any(each.severity == 1 for each in editor.open(uri, SMALL))
    assert not any(each.severity == 1 for each in editor.change(uri, sound, 2))
    broken = sound.replace("(task fetch :goal", "(task fetch :gaol")
    (error,) = [each for each in editor.change(uri, broken, 3) if each.severity == 1]
    assert error.code == "ICR008"
    assert marked(broken, error.range) == ":gaol"
    assert "did you mean `:goal`?" in error.message
    assert not editor.close(uri)


def test_older_names_are_struck_out(editor, uri):
    text = "(percepts (o ^x))\n(create-concepts ((a ?o) :percepts ((o ?o))))\n"
    notes = [each for each in editor.open(uri, text) if each.code == "ICR028"]
    assert [marked(text, each.range) for each in notes] == ["create-concepts", ":percepts"]
    assert all(each.tags == (types.DiagnosticTag.Deprecated,) for each in notes)


def test_hover_explains_a_concept_with_the_comment_above_it(editor, uri):
    editor.open(uri, SMALL)
    position = at(SMALL, "(ball ?obj))\n", 2)
    found = editor.ask(
        editor.client.text_document_hover_async(types.HoverParams(document(uri), position))
    )
    assert marked(SMALL, found.range) == "ball"
    assert found.contents.value == (
        "**`ball`** · concept\n\nAnything round.\n\n"
        "```icarus\n((ball ?obj) :elements ((object ?obj ^type ball)))\n```\n\n"
        "Used by `pick-up`."
    )


def test_hover_says_nothing_about_a_parenthesis(editor, uri):
    editor.open(uri, SMALL)
    params = types.HoverParams(document(uri), types.Position(0, 0))
    assert editor.ask(editor.client.text_document_hover_async(params)) is None


def test_definition_of_a_name_behind_a_wide_comment(editor, uri):
    text = SMALL.replace("((near ?a) :tests ((< ?d 1)))", "((near ?a) :elements ((free ?a)))")
    editor.open(uri, text)
    params = types.DefinitionParams(document(uri), at(text, "((free ?a)", 3))
    (found,) = editor.ask(editor.client.text_document_definition_async(params))
    assert found.uri == uri
    assert found.range.start == at(text, "free ?hand")
    assert marked(text, found.range) == "free"


def test_references_with_and_without_the_definition(editor, uri):
    editor.open(uri, SMALL)
    position = at(SMALL, "holding ?hand ?any")

    def references(*, with_definition):
        context = types.ReferenceContext(with_definition)
        params = types.ReferenceParams(context, document(uri), position)
        found = editor.ask(editor.client.text_document_references_async(params))
        return [each.range.start.line for each in found]

    assert references(with_definition=True) == [2, 9, 10]
    assert references(with_definition=False) == [2, 10]


def test_highlights_tell_the_definition_from_the_uses(editor, uri):
    editor.open(uri, SMALL)
    params = types.DocumentHighlightParams(document(uri), at(SMALL, "ball ?obj)) \n".strip()))
    found = editor.ask(editor.client.text_document_document_highlight_async(params))
    kinds = [each.kind for each in found]
    assert kinds == [types.DocumentHighlightKind.Write, types.DocumentHighlightKind.Read]


def rename(editor, uri, position, name):
    params = types.RenameParams(document(uri), position, name)
    edit = editor.ask(editor.client.text_document_rename_async(params))
    return edit.changes


def applied(text, edits):
    lines = text.split("\n")
    for edit in sorted(edits, key=lambda e: (e.range.start.line, -e.range.start.character)):
        line = lines[edit.range.start.line].encode("utf-16-le")
        start, stop = edit.range.start.character * 2, edit.range.end.character * 2
        line = line[:start] + edit.new_text.encode("utf-16-le") + line[stop:]
        lines[edit.range.start.line] = line.decode("utf-16-le")
    return "\n".join(lines)


def test_rename_changes_every_use(editor, uri):
    editor.open(uri, SMALL)
    changes = rename(editor, uri, at(SMALL, "holding ?hand ?obj"), "grips")
    assert list(changes) == [uri]
    assert applied(SMALL, changes[uri]) == SMALL.replace("holding", "grips")


@pytest.mark.parametrize(
    ("needle", "name", "reason"),
    [
        ("free ?hand", "ball", "there is a predicate `ball` already, in line 5"),
        ("free ?hand", "two words", "`two words` is not a word of the language"),
        ("*grasp", "grab", "`*grasp` is a command of the driver, which gives it its name"),
        (":elements", "parts", "`:elements` is a word of the language"),
    ],
)
def test_rename_refuses_with_a_sentence(editor, uri, needle, name, reason):
    editor.open(uri, SMALL)
    with pytest.raises(JsonRpcException, match=reason.replace("*", r"\*")) as refusal:
        rename(editor, uri, at(SMALL, needle, 1), name)
    assert refusal.value.code == types.LSPErrorCodes.RequestFailed.value


def test_prepare_rename_leaves_the_marker_of_an_attribute_alone(editor, uri):
    editor.open(uri, SMALL)
    params = types.PrepareRenameParams(document(uri), at(SMALL, "^type", 2))
    found = editor.ask(editor.client.text_document_prepare_rename_async(params))
    assert (marked(SMALL, found.range), found.placeholder) == ("type", "type")


def labels(editor, uri, text, needle):
    """Complete right behind a needle."""
    params = types.CompletionParams(document(uri), at(text, needle, len(needle)))
    found = editor.ask(editor.client.text_document_completion_async(params))
    return {item.label: item for item in found.items}


def test_completion_in_a_text_that_does_not_parse(editor, uri):
    text = (
        SMALL + "(skills\n  ((drop ?hand ?obj)\n   :elements ((hol)\n              (object ?part ^)"
    )
    assert any(each.severity == 1 for each in editor.open(uri, text))
    assert "holding" in labels(editor, uri, text, ":elements ((hol")
    attributes = labels(editor, uri, text, "(object ?part ^")
    assert list(attributes) == ["^type", "^x"]
    edit = attributes["^type"].text_edit
    assert marked(text, edit.range) == "^"
    assert edit.new_text == "^type"


def test_completion_offers_the_commands_of_the_driver(editor, uri):
    text = SMALL + "(skills ((drop ?obj) :actions (("
    editor.open(uri, text)
    assert {"*grasp", "*place", "*insert"} <= labels(
        editor, uri, text, "(drop ?obj) :actions (("
    ).keys()


def test_symbols_list_what_a_broken_text_defines(editor, uri):
    editor.open(uri, SMALL.replace("(task fetch", "(tsk fetch"))
    params = types.DocumentSymbolParams(document(uri))
    found = editor.ask(editor.client.text_document_document_symbol_async(params))
    assert [(each.name, [child.name for child in each.children or ()]) for each in found] == [
        ("percepts", ["object", "hand"]),
        ("concepts", ["free", "near", "ball"]),
        ("skills", ["pick-up"]),
    ]
    assert found[2].children[0].detail == "?hand ?obj"
    assert found[2].children[0].kind is types.SymbolKind.Method


def test_semantic_tokens_say_what_words_stand_for(editor, uri):
    editor.open(uri, SMALL)
    params = types.SemanticTokensParams(document(uri))
    data = editor.ask(editor.client.text_document_semantic_tokens_full_async(params)).data
    legend = editor.capabilities.semantic_tokens_provider.legend
    lines = [line.encode("utf-16-le") for line in SMALL.split("\n")]
    line = column = 0
    seen = {}
    for i in range(0, len(data), 5):
        down, right, length, kind, modifiers = data[i : i + 5]
        line, column = line + down, right if down else column + right
        word = lines[line][column * 2 : (column + length) * 2].decode("utf-16-le")
        seen.setdefault(word, (legend.token_types[kind], modifiers))
    assert seen["object"] == ("type", 1)
    assert seen["free"] == ("class", 1)
    assert seen["pick-up"] == ("method", 1)
    assert seen["*grasp"] == ("macro", 0)
    assert seen["?any"] == ("variable", 0)
    assert seen["^reach"] == ("property", 1)
    assert seen["#| 🦾é |#"] == ("comment", 0)
    assert seen["<"] == ("function", 4)


def test_formatting_gives_the_canonical_layout(editor, uri):
    text = "(goals   (on a b)(not (on b c)))"
    editor.open(uri, text)
    options = types.FormattingOptions(tab_size=2, insert_spaces=True)
    params = types.DocumentFormattingParams(document(uri), options)
    (edit,) = editor.ask(editor.client.text_document_formatting_async(params))
    assert edit.new_text == format_text(text) != text
    editor.change(uri, edit.new_text, 2)
    assert not editor.ask(editor.client.text_document_formatting_async(params))


def test_definitions_are_found_in_included_files(editor, tmp_path):
    parts, main = tmp_path / "parts.icr", tmp_path / "main.icr"
    parts.write_text("(percepts (object ^type))\n", encoding="utf-8")
    text = '(include "parts.icr")\n(concepts ((ball ?o) :elements ((object ?o ^type ball))))\n'
    assert not any(each.severity == 1 for each in editor.open(main.as_uri(), text))
    params = types.DefinitionParams(document(main.as_uri()), at(text, "object"))
    (found,) = editor.ask(editor.client.text_document_definition_async(params))
    assert found.uri == parts.as_uri()
    changes = rename(editor, main.as_uri(), at(text, "object"), "thing")
    assert set(changes) == {main.as_uri(), parts.as_uri()}


def test_errors_of_an_included_file_are_told_at_the_include(editor, tmp_path):
    parts, main = tmp_path / "parts.icr", tmp_path / "main.icr"
    parts.write_text("(percepts (object ^type)\n", encoding="utf-8")
    text = '(domain it)\n(include "parts.icr")\n'
    (error,) = [each for each in editor.open(main.as_uri(), text) if each.severity == 1]
    assert marked(text, error.range) == '"parts.icr"'
    assert "is never closed" in error.message


def test_saving_an_included_file_checks_the_texts_that_include_it(editor, tmp_path):
    parts, main = tmp_path / "parts.icr", tmp_path / "main.icr"
    parts.write_text("(percepts (object ^type)\n", encoding="utf-8")
    assert editor.open(main.as_uri(), '(include "parts.icr")\n')[0].severity == 1
    sound = "(percepts (object ^type))\n"
    editor.open(parts.as_uri(), sound)
    parts.write_text(sound, encoding="utf-8")

    async def send():
        editor.client.text_document_did_save(
            types.DidSaveTextDocumentParams(document(parts.as_uri()))
        )

    editor.ask(send())
    assert not [each for each in editor.diagnostics(main.as_uri()) if each.severity == 1]


def test_names_are_found_in_open_texts_before_they_are_saved(editor, tmp_path):
    parts, main = tmp_path / "parts.icr", tmp_path / "main.icr"
    parts.write_text("", encoding="utf-8")
    editor.open(parts.as_uri(), "(percepts (object ^type ^fresh))\n")
    text = '(include "parts.icr")\n(concepts ((ball ?o) :elements ((object ?o ^'
    editor.open(main.as_uri(), text)
    assert list(labels(editor, main.as_uri(), text, "?o ^")) == ["^type", "^fresh"]


MAIN = '(include "parts.icr")\n(concepts ((big ?p) :elements ((part ?p))))\n'


@pytest.fixture
def pair(editor, tmp_path):
    """Give an open text and one that it includes, open and changed but not saved."""
    parts = tmp_path / "parts.icr"
    parts.write_text("(percepts (piece))\n", encoding="utf-8")
    main, part = (tmp_path / "main.icr").as_uri(), parts.as_uri()
    assert [each.code for each in editor.open(main, MAIN)] == ["ICR013"]
    editor.open(part, "(percepts (piece))\n")
    editor.diagnostics(main)
    yield main, part
    for uri in (part, main):
        editor.close(uri)


def test_a_change_in_an_included_text_checks_those_that_include_it(editor, pair):
    main, part = pair
    editor.change(part, "(percepts (part))\n", 2)
    assert [each.code for each in editor.diagnostics(main)] == ["ICR040"]
    editor.change(part, "(percepts (part)\n", 3)
    about = [each for each in editor.diagnostics(main) if each.code == "ICR002"]
    assert about[0].range == types.Range(types.Position(0, 9), types.Position(0, 20))
    editor.change(part, "(percepts (prt))\n", 4)
    assert "did you mean `prt`?" in editor.diagnostics(main)[0].message
    editor.close(part)  # so that it counts as it is on the disk
    assert "did you mean" not in editor.diagnostics(main)[0].message
    editor.open(part, "(percepts (part))\n")
    assert [each.code for each in editor.diagnostics(main)] == ["ICR040"]


def test_names_are_found_and_changed_in_included_texts_that_are_not_saved(editor, pair):
    main, part = pair
    text = "(percepts\n  (part))\n"
    editor.change(part, text, 2)
    editor.diagnostics(main)
    document = types.TextDocumentIdentifier(main)
    where = at(MAIN, "(part", 2)
    (found,) = editor.ask(
        editor.client.text_document_definition_async(types.DefinitionParams(document, where))
    )
    assert (found.uri, marked(text, found.range)) == (part, "part")
    context = types.ReferenceContext(include_declaration=True)
    references = editor.ask(
        editor.client.text_document_references_async(
            types.ReferenceParams(context, types.TextDocumentIdentifier(part), at(text, "part"))
        )
    )
    assert {each.uri for each in references} == {main, part}
    edit = editor.ask(
        editor.client.text_document_rename_async(types.RenameParams(document, where, "piece"))
    )
    assert {uri: len(edits) for uri, edits in edit.changes.items()} == {main: 1, part: 1}
    symbols = editor.ask(
        editor.client.workspace_symbol_async(types.WorkspaceSymbolParams(query="pT"))
    )
    assert [(each.name, each.location.uri, each.container_name) for each in symbols] == [
        ("part", part, "percepts")
    ]
    every = editor.ask(editor.client.workspace_symbol_async(types.WorkspaceSymbolParams(query="")))
    assert {each.name for each in every} >= {"part", "big"}


def test_a_quick_fix_carries_the_hint_out(editor, uri):
    text = SMALL.replace("(not (holding", "(not (holdng")
    editor.open(uri, text)
    document = types.TextDocumentIdentifier(uri)
    place = at(text, "holdng", 3)

    def ask(only=None, end=place):
        context = types.CodeActionContext([], only)
        params = types.CodeActionParams(document, types.Range(place, end), context)
        return editor.ask(editor.client.text_document_code_action_async(params))

    (action,) = ask()
    assert (action.title, action.kind, action.is_preferred) == (
        "Write `holding`",
        types.CodeActionKind.QuickFix,
        True,
    )
    assert action.diagnostics[0].code == "ICR013"
    (edit,) = action.edit.changes[uri]
    assert (marked(text, edit.range), edit.new_text) == ("holdng", "holding")
    assert len(ask([types.CodeActionKind.QuickFix])) == 1
    assert not ask([types.CodeActionKind.Refactor])
    mended = text.replace("holdng", "holding")
    editor.change(uri, mended, 2)
    assert "Write `holding`" not in [each.title for each in ask(end=at(mended, "(task"))]


def test_older_spellings_are_rewritten_by_a_quick_fix(editor, uri):
    text = "(percepts (o))\n(create-concepts ((c ?x) :relations ((o ?x)) :percepts ((o ?x))))\n"
    editor.open(uri, text)
    params = types.CodeActionParams(
        types.TextDocumentIdentifier(uri),
        types.Range(at(text, ":relations"), at(text, ":relations")),
        types.CodeActionContext([]),
    )
    actions = editor.ask(editor.client.text_document_code_action_async(params))
    assert [each.title for each in actions] == [
        "Write this form as it is written today",
        "Write the whole file as it is written today",
    ]
    (edit,) = actions[0].edit.changes[uri]
    assert edit.new_text == "(concepts\n  ((c ?x) :elements ((o ?x) (o ?x))))"


def test_signature_help_shows_what_comes_next(editor, uri):
    text = SMALL.replace("(holding hand1 ball1)", "(holding hand1 ")
    editor.open(uri, text)
    params = types.SignatureHelpParams(
        types.TextDocumentIdentifier(uri), at(text, "hand1", len("hand1 "))
    )
    found = editor.ask(editor.client.text_document_signature_help_async(params))
    assert found.signatures[0].label == "(holding ?hand ?obj)"
    assert found.active_parameter == 1
    assert found.signatures[0].parameters[1].label == (15, 19)


def test_files_outside_the_folder_are_not_looked_at(editor, tmp_path):
    (tmp_path / "secret.icr").write_text("(percepts (object ^secret))\n", encoding="utf-8")
    main = tmp_path / "inner" / "main.icr"
    text = '(include "../secret.icr")\n(include "no\\u0000such")\n(task t :goal ((ob'
    editor.open(main.as_uri(), text)
    assert "object" not in labels(editor, main.as_uri(), text, "((ob")


def test_a_text_that_was_never_opened_has_nothing_to_say(editor, tmp_path):
    params = types.HoverParams(document((tmp_path / "no.icr").as_uri()), types.Position(3, 4))
    assert editor.ask(editor.client.text_document_hover_async(params)) is None


def test_other_line_ends_keep_the_places(editor, uri):
    text = SMALL.replace("\n", "\r\n")
    found = {each.code: each for each in editor.open(uri, text)}
    assert marked(SMALL, found["ICR012"].range) in ("?d", "?a")


def test_the_shipped_domains_have_no_errors(editor):
    for path in sorted(DOMAINS.glob("*.icr")):
        found = editor.open(path.as_uri(), path.read_text(encoding="utf-8"))
        assert not [each.message for each in found if each.severity == 1], path.name
        editor.close(path.as_uri())


def test_columns_count_as_the_editor_wants_them(tmp_path):
    editor = start([types.PositionEncodingKind.Utf8])
    assert editor.capabilities.position_encoding == "utf-8"
    uri = (tmp_path / "small.icr").as_uri()
    (unbound, *_) = [each for each in editor.open(uri, SMALL) if each.code == "ICR012"]
    line = SMALL.split("\n")[unbound.range.start.line].encode()
    assert line[unbound.range.start.character : unbound.range.end.character] in (b"?d", b"?a")
    assert stop(editor) == (0, "")
