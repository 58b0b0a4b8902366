"""What could come next on a line that is being typed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from icarus_lite.errors import IcarusError
from icarus_lite.symbols import format_value
from runtime.repl.book import COMMANDS
from runtime.repl.breakpoints import EVENTS, WORDS
from runtime.repl.command import Takes
from runtime.repl.session import Session

_WORD = re.compile(r"[^\s()\"]*$")


def proposals(text: str, session: Session) -> Iterator[tuple[str, str, str]]:
    """Propose words for the end of a line.

    Args:
        text: The line up to the cursor.
        session: What it is about.

    Returns:
        Each word, the part of it that is typed already, and what it is.
    """
    stripped = text.lstrip()
    found = _WORD.search(stripped)
    typed = found.group() if found else ""
    name, blank, rest = stripped.partition(" ")
    if stripped.startswith("("):
        words = _in_pattern(stripped, session)
    elif not blank:
        words = {command.name: command.help for command in COMMANDS}
    else:
        words = _after(name, rest, session)
    for word, what in words.items():
        if word.startswith(typed) and word != typed:
            yield word, typed, what


def _after(name: str, rest: str, session: Session) -> Mapping[str, str]:
    command = COMMANDS.get(name)
    if command is None:
        return {}
    if command.name == "break" and "(" not in rest:
        return {**dict.fromkeys(EVENTS, "stop at"), **dict.fromkeys(WORDS, "stop when")}
    match command.takes:
        case Takes.PATTERN:
            words = _in_pattern(rest, session)
        case Takes.COMMAND:
            words = {each.name: each.help for each in COMMANDS}
        case Takes.CYCLE:
            words = _cycles(session)
        case Takes.FILE:
            words = _files(rest)
        case Takes.OBJECT:
            words = dict.fromkeys(_names(session), "object")
        case Takes.NOTHING | Takes.TEXT:
            words = {}
    return words


def _in_pattern(text: str, session: Session) -> Mapping[str, str]:
    """Propose predicates after a parenthesis, objects and attributes behind them."""
    inner = text.rpartition("(")[2]
    if "(" not in text:
        return {}
    if not any(letter.isspace() for letter in inner):
        return _predicates(session)
    words = dict.fromkeys(_names(session), "object")
    kinds = {each.name: each for each in session.domain.percepts}
    kind = kinds.get(inner.split()[0]) if inner.split() else None
    if kind is not None:
        words |= {f"^{attribute}": f"of {kind.name}" for attribute in kind.attributes}
    return words


def _predicates(session: Session) -> Mapping[str, str]:
    domain = session.domain
    return {
        **{each.name: "percept" for each in domain.percepts},
        **{each.head.predicate: "concept" for each in domain.concepts},
        **{each.head.predicate: "skill" for each in domain.skills},
        **{
            effect.atom.predicate: "effect"
            for each in domain.skills
            for effect in each.effects
            if not any(c.head.predicate == effect.atom.predicate for c in domain.concepts)
        },
        **({"attached": "attachment"} if domain.attachments else {}),
    }


def _names(session: Session) -> Iterable[str]:
    if not session.has_cycle:
        return ()
    try:
        return sorted(format_value(each.name) for each in session.instant.state.percepts)
    except IcarusError:  # completion never stands in the way of what is being typed
        return ()


def _cycles(session: Session) -> Mapping[str, str]:
    """Propose the cycles in which something was reported, and the ends."""
    recording = session.recording
    if not len(recording):
        return {}
    first, last = recording.cycles[0], recording.cycles[-1]
    told = {str(first): "the first", str(last): "the last"}
    for cycle, outcome in recording.reports(first, last):
        if outcome.status != "running":
            told.setdefault(str(cycle), f"{outcome.action} {outcome.status}")
    return told


def _files(rest: str) -> Mapping[str, str]:
    folder = Path(rest).expanduser()
    folder = folder if rest.endswith("/") else folder.parent
    try:
        entries = sorted(folder.iterdir())
    except OSError:
        return {}
    return {
        f"{'' if str(folder) == '.' else f'{folder}/'}{entry.name}{'/' * entry.is_dir()}": "file"
        for entry in entries
        if entry.is_dir() or entry.suffix in (".icr", ".jsonl")
    }
