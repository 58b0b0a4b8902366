"""Files that a domain includes: `(include "parts.icr")` reads them as if their forms stood there.

A name is relative to the folder of the file in which it stands, and may not lead out of the folder
of the domain's own file. A file that is included twice is read once. The (domain …) form of an
included file names that file when it is loaded on its own, and counts for nothing here.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TypeAlias, TypeVar, cast

from icarus_lite.language.diagnostics import Diagnostic, DomainError, Severity
from icarus_lite.language.reading.parts import Form, Outcome, Word
from icarus_lite.language.reading.sources import read_source, reason_of
from icarus_lite.language.syntax import Source, Span
from icarus_lite.records import dataclass, field, replace

MAX_INCLUDES = 30
"""How long a chain of files may be of which each includes the next."""

ReadForms: TypeAlias = Callable[[Source], Outcome]
"""Gives the forms of a text, and what keeps it from being read."""

_Node = TypeVar("_Node")


def includes(forms: Iterable[Form]) -> bool:
    """Tell whether any of the forms is an include."""
    return any(form.keyword.text == "include" for form in forms)


@dataclass(frozen=True, slots=True)
class Expansion:
    """The forms of a domain with those that it includes.

    Args:
        forms: All forms, in the place of the includes where they come from another file.
        source: The text together with those included.
        problems: What is wrong with includes, and in included files.
        mended: The lines of included files in which parentheses were mended, with the file.
        is_whole: Whether the forms of every included file are there.
    """

    forms: tuple[Form, ...]
    source: Source
    problems: tuple[Diagnostic, ...]
    mended: frozenset[tuple[str, int]]
    is_whole: bool


def expand(
    forms: tuple[Form, ...],
    source: Source,
    folder: Path | None,
    read: ReadForms,
    unsaved: Mapping[str, str] = MappingProxyType({}),
) -> Expansion:
    """Put the forms of included files in the place of the includes.

    Args:
        forms: The forms of the domain's own file.
        source: Its text.
        folder: The folder in which it lies; None if it is no file.
        read: What turns a text into forms.
        unsaved: Texts that count instead of what is on the disk, by their real paths.
    """
    inclusion = _Inclusion(read, folder, unsaved)
    own = _File(source.path, folder, ())
    if folder is not None:
        inclusion.open_files.append(os.path.realpath(folder / Path(source.path).name))
    expanded = inclusion.expand(forms, own)
    return Expansion(
        tuple(expanded),
        replace(source, included=tuple(inclusion.sources)),
        tuple(inclusion.problems),
        frozenset(inclusion.mended),
        inclusion.is_whole,
    )


@dataclass(frozen=True, slots=True)
class _File:
    """A file being read: its name in messages, its folder, and the files that led to it."""

    path: str
    folder: Path | None
    chain: tuple[str, ...]


@dataclass(slots=True)
class _Inclusion:
    """The state of one reading with all its includes."""

    read: ReadForms
    root: Path | None
    unsaved: Mapping[str, str]
    sources: list[Source] = field(default_factory=list)
    problems: list[Diagnostic] = field(default_factory=list)
    open_files: list[str] = field(default_factory=list)
    done: set[str] = field(default_factory=set)
    mended: set[tuple[str, int]] = field(default_factory=set)
    is_whole: bool = True

    def expand(self, forms: Iterable[Form], file: _File) -> list[Form]:
        """Give the forms with their includes followed."""
        expanded: list[Form] = []
        for form in forms:
            if form.keyword.text == "include":
                expanded += self._follow(form.words[0], file)
            else:
                expanded.append(form)
        return expanded

    def _follow(self, name: Word, file: _File) -> list[Form]:
        if self.root is None or file.folder is None:
            self._refuse(
                name,
                file,
                "this text is not a file, so there is no folder to include from",
                "save it to a file; an include is looked for in the folder of its own file",
            )
            return []
        path = file.folder / name.text
        shown = os.path.normpath(Path(file.path).parent / name.text)
        try:
            real = os.path.realpath(path)
            inside = Path(real).is_relative_to(os.path.realpath(self.root))
            exists = os.path.lexists(real)
            is_file = real in self.unsaved or Path(real).is_file()
        except (OSError, ValueError) as error:
            self._refuse(name, file, f"{_quoted(name)} cannot be included: {reason_of(error)}", "")
            return []
        refusal = self._refusal(name, file, real, inside=inside)
        if refusal is None and not is_file:
            what = "is not a file" if exists else "does not exist"
            refusal = f"the file {_quoted(name)} {what}", f"it is looked for at {shown}"
        if refusal is not None:
            self._refuse(name, file, *refusal)
            return []
        if real in self.done:
            return []
        return self._read(path, real, shown, file)

    def _refusal(
        self, name: Word, file: _File, real: str, *, inside: bool
    ) -> tuple[str, str] | None:
        """Say why a file may not be included, and what to do; None if it may."""
        chain = (*file.chain, file.path)
        if not inside or Path(name.text).is_absolute():
            return (
                f"{_quoted(name)} lies outside the folder of {chain[0]}",
                "a domain includes files of its own folder and those in it, by a relative name",
            )
        if real in self.open_files:
            circle = [*chain[self.open_files.index(real) :], chain[self.open_files.index(real)]]
            return (
                f"{_quoted(name)} includes itself: {' -> '.join(circle)}",
                "remove one of these includes; move what both files need to a third",
            )
        if len(chain) > MAX_INCLUDES:
            return f"files are included more than {MAX_INCLUDES} deep", "include fewer, larger ones"
        return None

    def _read(self, path: Path, real: str, shown: str, file: _File) -> list[Form]:
        self.done.add(real)
        try:
            text = self.unsaved.get(real)
            source = read_source(path, shown) if text is None else Source(shown, text)
        except DomainError as error:
            self.sources.append(error.source)
            self.problems.extend(error.diagnostics)
            self.is_whole = False
            return []
        self.sources.append(source)
        outcome = self.read(source)
        self.problems.extend(outcome.problems)
        self.mended |= {(shown, line) for line in outcome.mended}
        self.is_whole &= outcome.is_whole
        own = [relocate(form, shown) for form in outcome.forms if form.keyword.text != "domain"]
        self.open_files.append(real)
        expanded = self.expand(own, _File(shown, path.parent, (*file.chain, file.path)))
        self.open_files.pop()
        return expanded

    def _refuse(self, name: Word, file: _File, message: str, hint: str) -> None:
        self.is_whole = False
        found = Diagnostic(file.path, name.span, Severity.ERROR, "ICR036", message, hint)
        self.problems.append(found)


def relocate(node: _Node, path: str) -> _Node:
    """Give a part of a tree with the path of its file in every span."""
    return cast("_Node", _relocated(node, path))


def _relocated(node: object, path: str) -> object:
    if isinstance(node, Span):
        return replace(node, path=path)
    if isinstance(node, tuple):
        return tuple([_relocated(each, path) for each in node])
    import dataclasses  # noqa: PLC0415 - few files include others

    if dataclasses.is_dataclass(node) and not isinstance(node, type):
        values = {
            each.name: _relocated(getattr(node, each.name), path)
            for each in dataclasses.fields(node)
        }
        return type(node)(**values)
    return node


def _quoted(name: Word) -> str:
    return f"`{name.text}`"
