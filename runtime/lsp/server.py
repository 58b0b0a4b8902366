"""The language server itself: which question of the protocol gets which answer."""

from __future__ import annotations

import logging
from collections.abc import Callable, Collection
from typing import Final, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pygls.lsp.server import LanguageServer

from icarus_lite import __version__
from icarus_lite.language.editing import RenameError
from runtime.lsp import answers
from runtime.lsp.actions import KINDS, code_actions
from runtime.lsp.colours import LEGEND, semantic_tokens
from runtime.lsp.documents import Documents, Project
from runtime.lsp.findings import findings

_REQUEST_FAILED: Final = types.LSPErrorCodes.RequestFailed.value
_Answer = TypeVar("_Answer")


def serve(commands: Collection[str]) -> None:
    """Serve one editor over standard input and output, until it says goodbye.

    Args:
        commands: The commands that drivers are known to offer, without the star.
    """
    handler = logging.StreamHandler()  # standard error: standard output belongs to the protocol
    handler.addFilter(_is_unexpected)
    logging.basicConfig(level=logging.WARNING, handlers=[handler])
    make_server(commands).start_io()


def make_server(commands: Collection[str] = ()) -> LanguageServer:
    """Build the server.

    Args:
        commands: The commands that drivers are known to offer, without the star.
    """
    # Whole texts: they are small, and pygls splits lines in more places than the protocol does.
    server = LanguageServer(
        "icarus", __version__, text_document_sync_kind=types.TextDocumentSyncKind.Full
    )
    documents = Documents()

    def project(uri: str) -> Project:
        return documents.project(server.workspace, uri)

    _add_checking(server, documents, project)
    _add_reading(server, project, commands)
    _add_writing(server, project, commands)

    @server.feature(types.WORKSPACE_SYMBOL)
    def workspace_symbols(params: types.WorkspaceSymbolParams) -> list[types.WorkspaceSymbol]:
        files = documents.everything(server.workspace)
        encoding = server.workspace.position_encoding or types.PositionEncodingKind.Utf16
        return answers.workspace_symbols(files, params.query, encoding)

    return server


def _add_checking(
    server: LanguageServer, documents: Documents, project: Callable[[str], Project]
) -> None:
    """Let the server check a text whenever it changes."""

    def check(uri: str) -> None:
        version = server.workspace.get_text_document(uri).version
        found = findings(project(uri))
        server.text_document_publish_diagnostics(
            types.PublishDiagnosticsParams(uri, found, version)
        )

    def check_includers(uri: str) -> None:
        for each in documents.includers(server.workspace, uri):
            check(each)

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def did_open(params: types.DidOpenTextDocumentParams) -> None:
        check(params.text_document.uri)
        check_includers(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def did_change(params: types.DidChangeTextDocumentParams) -> None:
        check(params.text_document.uri)
        check_includers(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def did_save(params: types.DidSaveTextDocumentParams) -> None:
        # Others may include the saved file; they read it from the disk.
        for uri in sorted({params.text_document.uri, *server.workspace.text_documents}):
            check(uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def did_close(params: types.DidCloseTextDocumentParams) -> None:
        uri = params.text_document.uri
        documents.forget(uri)
        server.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, []))
        check_includers(uri)  # for them the file is again as it is on the disk


def _add_reading(
    server: LanguageServer, project: Callable[[str], Project], commands: Collection[str]
) -> None:
    """Let the server answer what changes nothing."""

    @server.feature(types.TEXT_DOCUMENT_HOVER)
    def hover(params: types.HoverParams) -> types.Hover | None:
        return answers.hover(project(params.text_document.uri), params.position, commands)

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    def definition(params: types.DefinitionParams) -> list[types.Location]:
        return answers.definition(project(params.text_document.uri), params.position)

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    def references(params: types.ReferenceParams) -> list[types.Location]:
        with_definitions = params.context.include_declaration
        where = project(params.text_document.uri)
        return answers.references(where, params.position, with_definitions=with_definitions)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
    def highlights(params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
        return answers.highlights(project(params.text_document.uri), params.position)

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    def symbols(params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
        return answers.symbols(project(params.text_document.uri))

    @server.feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
    def tokens(params: types.SemanticTokensParams) -> types.SemanticTokens:
        return semantic_tokens(project(params.text_document.uri))


def _add_writing(
    server: LanguageServer, project: Callable[[str], Project], commands: Collection[str]
) -> None:
    """Let the server propose words and edits."""

    @server.feature(
        types.TEXT_DOCUMENT_COMPLETION,
        types.CompletionOptions(trigger_characters=["(", ":", "^", "*", "?"]),
    )
    def completion(params: types.CompletionParams) -> types.CompletionList:
        return answers.completion(project(params.text_document.uri), params.position, commands)

    @server.feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
    def prepare_rename(params: types.PrepareRenameParams) -> types.PrepareRenamePlaceholder:
        where = project(params.text_document.uri)
        return _or_refuse(lambda: answers.prepare_rename(where, params.position))

    @server.feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
    def rename(params: types.RenameParams) -> types.WorkspaceEdit:
        where = project(params.text_document.uri)
        return _or_refuse(lambda: answers.renaming(where, params.position, params.new_name))

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(list(KINDS)))
    def actions(params: types.CodeActionParams) -> list[types.CodeAction]:
        return code_actions(project(params.text_document.uri), params)

    @server.feature(
        types.TEXT_DOCUMENT_SIGNATURE_HELP, types.SignatureHelpOptions(trigger_characters=[" "])
    )
    def signature_help(params: types.SignatureHelpParams) -> types.SignatureHelp | None:
        return answers.signature_help(project(params.text_document.uri), params.position)

    @server.feature(types.TEXT_DOCUMENT_FORMATTING)
    def formatting(params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        return answers.formatting(project(params.text_document.uri))


def _or_refuse(answer: Callable[[], _Answer]) -> _Answer:
    """Give the answer, or the reason why there is none, as the protocol wants it."""
    try:
        return answer()
    except RenameError as error:
        raise JsonRpcException(str(error), code=_REQUEST_FAILED) from None


def _is_unexpected(record: logging.LogRecord) -> bool:
    """Leave refusals out of the log: the editor shows them."""
    error = record.exc_info[1] if record.exc_info else None
    return not (isinstance(error, JsonRpcException) and error.code == _REQUEST_FAILED)
