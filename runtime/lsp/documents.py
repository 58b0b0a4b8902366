"""The texts an editor has open, with the files they include."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from operator import is_not
from pathlib import Path

from lsprotocol import types
from pygls import uris
from pygls.workspace import Workspace

from icarus_lite.language import DomainError
from icarus_lite.language.editing import File, Index, Role
from icarus_lite.language.reading.sources import read_source
from runtime.lsp.positions import Positions

_MOST_FILES = 200


@dataclass(frozen=True, slots=True)
class Project:
    """One open text among the files that belong to it.

    Args:
        path: The path of the text.
        index: The text, what it includes, and the open texts that include it.
        uris: The URI of each file by its path.
        encoding: What the columns of positions count.
        unsaved: The texts that are open, by the paths of their files.
    """

    path: str
    index: Index
    uris: dict[str, str]
    encoding: types.PositionEncodingKind | str
    unsaved: Mapping[str, str] = field(default_factory=dict)

    @property
    def text(self) -> str:
        """The open text."""
        return self.index.text(self.path)

    def positions(self, path: str = "") -> Positions:
        """Give the positions of a file, of the open text if none is named."""
        return Positions(self.index.text(path or self.path), self.encoding)

    def offset(self, position: types.Position) -> int:
        """Give the offset of a position in the open text."""
        return self.positions().offset(position)


class Documents:
    """Reads open texts and the files around them; what has not changed is not read again."""

    def __init__(self) -> None:
        self._known: dict[str, File] = {}
        self._indexed: tuple[tuple[File, ...], Index] = ((), Index(()))

    def project(self, workspace: Workspace, uri: str) -> Project:
        """Give an open text with everything that belongs to it."""
        opened = {path_of(each): each for each in workspace.text_documents}
        path = path_of(uri)
        files = {file.path: file for file in self._with_includes(workspace, path, opened)}
        files.setdefault(path, self.file(path, ""))
        for other in opened:
            around = {file.path: file for file in self._with_includes(workspace, other, opened)}
            if path in around:
                files |= around
        links = {each: opened.get(each) or uris.from_fs_path(each) or each for each in files}
        encoding = workspace.position_encoding or types.PositionEncodingKind.Utf16
        index = self._index(tuple(files.values()))
        unsaved = {each: _text(workspace, each, opened) or "" for each in opened}
        return Project(path, index, links, encoding, unsaved)

    def includers(self, workspace: Workspace, uri: str) -> tuple[str, ...]:
        """Give the URIs of the open texts that include a file, directly or through others."""
        opened = {path_of(each): each for each in workspace.text_documents}
        path = path_of(uri)
        return tuple(
            opened[other]
            for other in opened
            if other != path
            and any(file.path == path for file in self._with_includes(workspace, other, opened))
        )

    def everything(self, workspace: Workspace) -> Iterator[tuple[File, str]]:
        """Give each open text and each file that one includes, once, with its URI."""
        opened = {path_of(each): each for each in workspace.text_documents}
        seen: set[str] = set()
        for path in opened:
            for file in self._with_includes(workspace, path, opened):
                if file.path not in seen:
                    seen.add(file.path)
                    yield file, opened.get(file.path) or uris.from_fs_path(file.path) or file.path

    def file(self, path: str, text: str) -> File:
        """Give a text as read, from memory if it is the same as last time."""
        known = self._known.get(path)
        if known is None or known.text != text:
            known = File.read(path, text)
            self._known[path] = known
        return known

    def _index(self, files: tuple[File, ...]) -> Index:
        known, index = self._indexed
        if len(known) != len(files) or any(map(is_not, known, files)):
            index = Index(files)
            self._indexed = (files, index)
        return index

    def forget(self, uri: str) -> None:
        """Free what was read of a text that is no longer open."""
        self._known.pop(path_of(uri), None)

    def _with_includes(
        self, workspace: Workspace, path: str, opened: dict[str, str]
    ) -> Iterator[File]:
        """Give a file and all that it includes, directly or through others."""
        waiting, seen, folder = [path], {path}, Path(os.path.realpath(path)).parent
        while waiting and len(seen) < _MOST_FILES:
            current = waiting.pop(0)
            text = _text(workspace, current, opened)
            if text is None:
                continue
            file = self.file(current, text)
            yield file
            for name in included(file):
                target = os.path.realpath(Path(current).parent / name)
                # As when a domain is loaded: nothing outside its own folder is looked at.
                if Path(target).is_relative_to(folder) and target not in seen:
                    seen.add(target)
                    waiting.append(target)


def included(file: File) -> tuple[str, ...]:
    """Give the names that a file includes, in the order of its text."""
    names = [
        word.name.strip('"')
        for word in file.words
        if word.role is Role.STRING and word.place.form == "include"
    ]
    return tuple(name for name in names if name.isprintable())


def path_of(uri: str) -> str:
    """Give the path of a file's URI, links followed; URIs of unsaved texts stand for themselves."""
    path = uris.to_fs_path(uri)
    return os.path.realpath(path) if path and path.isprintable() else uri


def normal(text: str) -> str:
    """End every line in LF. The protocol's lines end in CRLF and CR as well."""
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _text(workspace: Workspace, path: str, opened: dict[str, str]) -> str | None:
    if path in opened:
        return normal(workspace.text_documents[opened[path]].source)
    try:
        return normal(read_source(Path(path), path).text)
    except DomainError:
        return None  # the diagnostics of the file that includes it say so
