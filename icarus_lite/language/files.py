"""Domain files: read, parsed and checked in one go."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from icarus_lite.language.checking.checker import check_domain
from icarus_lite.language.diagnostics import (
    Diagnostic,
    DomainError,
    has_errors,
    in_order,
)
from icarus_lite.language.functions import PythonFunctions
from icarus_lite.language.reading.reader import read_domain
from icarus_lite.language.reading.sources import read_source
from icarus_lite.language.syntax import Domain, Source


def load_domain(path: str | Path, *, functions: PythonFunctions | None = None) -> Domain:
    """Read a domain file and check it.

    Args:
        path: The file.
        functions: Python functions that its tests may call, by name.

    Returns:
        The domain; warnings and notes do not keep it from loading.

    Raises:
        DomainError: The file cannot be read, or has errors; it carries all of them.

    Example:
        >>> load_domain("domains/gearbox.icr").name  # doctest: +SKIP
        'gearbox'
    """
    domain, source, diagnostics = diagnose_file(path, functions=functions)
    if domain is None:
        raise DomainError(diagnostics, source)
    return domain


def diagnose_file(
    path: str | Path, *, functions: PythonFunctions | None = None, thorough: bool = False
) -> tuple[Domain | None, Source, tuple[Diagnostic, ...]]:
    """Read a domain file and find everything there is to say about it, without raising.

    Args:
        path: The file.
        functions: Python functions that its tests may call, by name.
        thorough: Whether to tell of what nobody uses as well.

    Returns:
        The domain, or None if there are errors; the text, to render the diagnostics with; and the
        diagnostics in the order of the text.
    """
    file = Path(path)
    try:
        source = read_source(file, str(path))
    except DomainError as error:
        return None, error.source, error.diagnostics
    return _diagnose(source, file.parent, functions, thorough=thorough)


def diagnose_text(
    text: str,
    path: str | Path,
    *,
    functions: PythonFunctions | None = None,
    thorough: bool = False,
    unsaved: Mapping[str, str] = MappingProxyType({}),
) -> tuple[Domain | None, Source, tuple[Diagnostic, ...]]:
    """Do as `diagnose_file` does, with a text that is not saved yet.

    Args:
        text: The text, as an editor has it.
        path: The file that it will be; its includes are read from there.
        functions: Python functions that its tests may call, by name.
        thorough: Whether to tell of what nobody uses as well.
        unsaved: Texts of included files that are not saved yet, by their real paths.
    """
    source = Source(str(path), text)
    return _diagnose(source, Path(path).parent, functions, unsaved, thorough=thorough)


def _diagnose(
    source: Source,
    folder: Path,
    functions: PythonFunctions | None,
    unsaved: Mapping[str, str] = MappingProxyType({}),
    *,
    thorough: bool,
) -> tuple[Domain | None, Source, tuple[Diagnostic, ...]]:
    read = read_domain(source, folder, unsaved)
    diagnostics = read.diagnostics
    if read.domain is not None:
        checked = check_domain(read.domain, functions, thorough=thorough)
        diagnostics = in_order((*diagnostics, *read.credible(checked)))
    return (None if has_errors(diagnostics) else read.domain), read.source, diagnostics
