"""The REPL on a terminal: history, several lines, brackets, colours, completion."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from prompt_toolkit import PromptSession
from prompt_toolkit.application import get_app
from prompt_toolkit.auto_suggest import AutoSuggestFromHistory
from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document
from prompt_toolkit.filters import Condition
from prompt_toolkit.formatted_text import StyleAndTextTuples
from prompt_toolkit.history import FileHistory, History, InMemoryHistory
from prompt_toolkit.key_binding import KeyBindings, KeyPressEvent
from prompt_toolkit.layout.processors import HighlightMatchingBracketProcessor
from prompt_toolkit.lexers import Lexer
from pygments.token import Token

from icarus_lite.language.highlighting import IcarusLexer
from runtime.repl.book import COMMANDS
from runtime.repl.proposals import proposals
from runtime.repl.session import Session

_COLOURS = {
    "Name.Class": "ansicyan",
    "Name.Function": "ansiblue",
    "Name.Attribute": "ansimagenta",
    "Name.Variable": "ansigreen",
    "Literal.Number": "ansiyellow",
    "Literal.String": "ansiyellow",
    "Operator.Word": "ansired",
}


def prompt_session(session: Session) -> PromptSession[str]:
    """Give the prompt for a session on a terminal."""
    return PromptSession(
        history=_history(),
        lexer=_LineLexer(),
        completer=_Completer(session),
        complete_while_typing=False,
        auto_suggest=AutoSuggestFromHistory(),
        input_processors=[HighlightMatchingBracketProcessor(chars="()")],
        key_bindings=_keys(),
        multiline=True,
        prompt_continuation=lambda width, _line, _wrapped: "." * max(width - 1, 0) + " ",
    )


def is_open(text: str) -> bool:
    """Tell whether a parenthesis or a string has yet to be closed, so that Enter goes on."""
    depth, quoted, escaped = 0, False, False
    for letter in text:
        if quoted:
            quoted = escaped or letter != '"'
            escaped = letter == "\\" and not escaped
        elif letter == '"':
            quoted = True
        elif letter in "()":
            depth += 1 if letter == "(" else -1
    return quoted or depth > 0


def _keys() -> KeyBindings:
    keys = KeyBindings()

    @Condition
    def is_whole() -> bool:
        return not is_open(get_app().current_buffer.text)

    @keys.add("enter", filter=is_whole)
    def _(event: KeyPressEvent) -> None:
        event.current_buffer.validate_and_handle()

    return keys


def _history() -> History:
    """Keep what was typed where the desktop wants state to be kept, if that can be written."""
    folder = Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state") / "icarus"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "history").touch()
    except (OSError, RuntimeError):
        return InMemoryHistory()
    return FileHistory(str(folder / "history"))


class _LineLexer(Lexer):
    """Colours a command and the pattern after it."""

    def lex_document(self, document: Document) -> object:  # type: ignore[override]
        """Give what colours line number n."""
        lines = document.lines
        icarus = IcarusLexer()

        def coloured(number: int) -> StyleAndTextTuples:
            line = lines[number]
            start = line.find("(")
            head, rest = (line, "") if start < 0 else (line[:start], line[start:])
            known = COMMANDS.get(head.split(" ")[0]) is not None
            found: StyleAndTextTuples = [("bold" if known else "", head)] if head else []
            if rest:
                found += [
                    (_colour(kind), text.rstrip("\n")) for kind, text in icarus.get_tokens(rest)
                ]
            return found

        return coloured


def _colour(kind: object) -> str:
    name = str(kind).removeprefix(f"{Token}.")
    return next((c for start, c in _COLOURS.items() if name.startswith(start)), "")


class _Completer(Completer):
    def __init__(self, session: Session) -> None:
        self._session = session

    def get_completions(
        self,
        document: Document,
        complete_event: CompleteEvent,  # noqa: ARG002 - the protocol's
    ) -> Iterable[Completion]:
        """Complete what stands before the cursor."""
        return self._completions(document.text_before_cursor)

    def _completions(self, text: str) -> Iterator[Completion]:
        for word, typed, meta in proposals(text, self._session):
            yield Completion(word, start_position=-len(typed), display_meta=meta)
