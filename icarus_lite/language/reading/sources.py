"""Files into text: what can go wrong before there is anything to parse."""

from __future__ import annotations

import codecs

from icarus_lite.language.syntax import NOWHERE, Source, Span

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pathlib import Path

    from icarus_lite.language.diagnostics import DomainError

MAX_BYTES = 10_000_000
"""The size of the largest file that is read. A domain of a thousand clauses takes 0.3 MB."""

_OTHER_ENCODINGS = (
    (codecs.BOM_UTF32_LE, "UTF-32"),
    (codecs.BOM_UTF32_BE, "UTF-32"),
    (codecs.BOM_UTF16_LE, "UTF-16"),
    (codecs.BOM_UTF16_BE, "UTF-16"),
)


def read_source(path: Path | str, shown: str) -> Source:
    """Read a file as text.

    Args:
        path: The file.
        shown: What to call it in messages.

    Raises:
        DomainError: It cannot be read, is larger than `MAX_BYTES`, or is not UTF-8.
    """
    try:
        with open(path, "rb") as file:  # noqa: PTH123 - a name does as well
            data = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:  # a NUL or a lone surrogate in the name is a ValueError
        hint = "check the name and the folder" if isinstance(error, FileNotFoundError) else ""
        raise _unreadable(shown, f"the file cannot be read: {reason_of(error)}", hint) from None
    if len(data) > MAX_BYTES:
        size = f"{MAX_BYTES // 1_000_000} MB"
        hint = "split it with (include …), or is it another file that was meant?"
        raise _unreadable(shown, f"the file is larger than {size}", hint)
    return decode(data, shown)


def reason_of(error: OSError | ValueError) -> str:
    """Say why a file cannot be read, as the system says it."""
    if isinstance(error, OSError):
        return (error.strerror or type(error).__name__).lower()
    return "this cannot be the name of a file"


def decode(data: bytes, path: str) -> Source:
    """Turn the bytes of a file into text; a byte order mark and other line ends are fine.

    Raises:
        DomainError: The bytes are not UTF-8; the message names the place of the first bad one.
    """
    data = data.removeprefix(codecs.BOM_UTF8)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        for mark, name in _OTHER_ENCODINGS:
            if data.startswith(mark):
                wrong = f"the file is {name}, not UTF-8"
                raise _unreadable(path, wrong, "save the file as UTF-8") from None
        before = data[: error.start].decode("utf-8", errors="replace")
        line = before.count("\n") + 1
        column = len(before) - (before.rfind("\n") + 1) + 1
        shown = data.decode("utf-8", errors="replace")
        wrong = f"the byte 0x{data[error.start]:02x} is not UTF-8"
        place = Span(line, column, line, column + 1)
        raise _error(Source(path, shown), place, wrong, "save the file as UTF-8") from None
    return Source(path, text.replace("\r\n", "\n").replace("\r", "\n"))


def _unreadable(path: str, message: str, hint: str) -> DomainError:
    return _error(Source(path, ""), NOWHERE, message, hint)


def _error(source: Source, place: Span, message: str, hint: str) -> DomainError:
    from icarus_lite.language.diagnostics import (  # noqa: PLC0415 - mostly nothing is wrong
        Diagnostic,
        DomainError,
        Severity,
    )

    found = Diagnostic(source.path, place, Severity.ERROR, "ICR001", message, hint)
    return DomainError([found], source)
