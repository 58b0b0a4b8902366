"""Domain files: read, parsed and checked in one go."""

from __future__ import annotations

from pathlib import Path

from icarus_lite.language.checker import check_domain
from icarus_lite.language.diagnostics import (
    Diagnostic,
    DomainError,
    Severity,
    has_errors,
    in_order,
)
from icarus_lite.language.functions import PythonFunctions
from icarus_lite.language.reader import decode, parse_domain
from icarus_lite.language.syntax import NOWHERE, Domain, Source


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
    path: str | Path, *, functions: PythonFunctions | None = None
) -> tuple[Domain | None, Source, tuple[Diagnostic, ...]]:
    """Read a domain file and find everything there is to say about it, without raising.

    Returns:
        The domain, or None if there are errors; the text, to render the diagnostics with; and the
        diagnostics in the order of the text.
    """
    shown = str(path)
    try:
        source = decode(Path(path).read_bytes(), shown)
    except OSError as error:
        return None, Source(shown, ""), (_unreadable(shown, error),)
    except DomainError as error:
        return None, error.source, error.diagnostics
    domain, diagnostics = parse_domain(source.text, shown)
    if domain is not None:
        diagnostics = in_order((*diagnostics, *check_domain(domain, functions)))
    return (None if has_errors(diagnostics) else domain), source, diagnostics


def _unreadable(path: str, error: OSError) -> Diagnostic:
    reason = (error.strerror or type(error).__name__).lower()
    hint = "" if not isinstance(error, FileNotFoundError) else "check the name and the folder"
    message = f"the file cannot be read: {reason}"
    return Diagnostic(path, NOWHERE, Severity.ERROR, "ICR001", message, hint)
