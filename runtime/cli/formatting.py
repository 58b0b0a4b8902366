"""`icarus fmt`."""

from __future__ import annotations

import difflib
import io
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.app import BAD_INPUT, DOES_NOT_HOLD, HOLDS, app

_STANDARD_INPUT = "-"


@app.command(
    name="fmt",
    epilog="Example: icarus fmt domains/gearbox.icr --check",
)
def fmt(
    files: Annotated[
        list[Path],
        typer.Argument(
            help="Domain files; - reads standard input and writes standard output.",
            metavar="FILE…",
        ),
    ],
    *,
    check: Annotated[
        bool, typer.Option("--check", help="Write nothing; tell which files would change.")
    ] = False,
    diff: Annotated[
        bool, typer.Option("--diff", help="Write nothing; show what would change.")
    ] = False,
    modernize: Annotated[
        bool, typer.Option("--modernize", help="Write older forms and fields the modern way.")
    ] = False,
) -> None:
    """Lay domain files out canonically, in place; comments and meaning stay.

    With --check or --diff, the status is 1 if a file would change. A file with syntax errors is
    left as it is: they are shown, and the status is 2.
    """
    done = [_format(str(file), modernize=modernize) for file in files]
    writes = not (check or diff)
    failed = False
    for result in done:
        if result is None:
            failed = True
        elif diff:
            typer.echo(_difference(result), nl=False)
        elif writes and result.path == _STANDARD_INPUT:
            typer.echo(result.after, nl=False)
        elif writes and result.changes:
            failed |= not _write(result)
        elif check and result.changes:
            typer.echo(f"would reformat {result.shown}")
    changed = sum(result is not None and result.changes for result in done)
    if failed:
        raise typer.Exit(BAD_INPUT)
    # What is read from standard output must be the text, or the difference, and nothing else.
    is_read = diff or _STANDARD_INPUT in map(str, files)
    typer.echo(_summary(changed, len(done) - changed, writes=writes), err=is_read)
    raise typer.Exit(DOES_NOT_HOLD if changed and not writes else HOLDS)


@dataclass(frozen=True, slots=True)
class _Formatted:
    """A file before and after; `raw` is what lies on disk."""

    path: str
    shown: str
    raw: bytes
    after: str

    @property
    def changes(self) -> bool:
        return self.raw != self.after.encode()


def _format(path: str, *, modernize: bool) -> _Formatted | None:
    """Format one file, or show what is wrong with it."""
    from icarus_lite.language import DomainError, render
    from icarus_lite.language.formatting.formatter import format_text
    from icarus_lite.language.reading.reader import read_forms
    from icarus_lite.language.reading.sources import decode, reason_of

    shown = "<stdin>" if path == _STANDARD_INPUT else path
    try:
        raw = sys.stdin.buffer.read() if path == _STANDARD_INPUT else Path(path).read_bytes()
        source = decode(raw, shown)
    except (OSError, ValueError) as error:
        if isinstance(error, DomainError):
            typer.echo(str(error), err=True)
        else:
            typer.echo(f"{shown}: the file cannot be read: {reason_of(error)}", err=True)
        return None
    problems = read_forms(source).problems
    for found in problems:
        typer.echo(render(found, source), err=True)
    if problems:
        return None
    return _Formatted(path, shown, raw, format_text(source.text, modernize=modernize))


def _write(result: _Formatted) -> bool:
    """Write a file back and say so, or say why it cannot be written."""
    try:
        _replace(Path(result.path).resolve(), result.after.encode())
    except OSError as error:
        reason = (error.strerror or type(error).__name__).lower()
        typer.echo(f"{result.path}: the file cannot be written: {reason}", err=True)
        return False
    typer.echo(f"reformatted {result.shown}")
    return True


def _replace(path: Path, content: bytes) -> None:
    """Write a file so that it is never seen half written, keeping its permissions."""
    beside = path.with_name(f".{path.name}.icarus-fmt")
    try:
        beside.write_bytes(content)
        beside.chmod(path.stat().st_mode)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def _difference(result: _Formatted) -> str:
    """Show what would change, as `patch` and people read it."""
    before, after = _lines(result.raw.decode()), _lines(result.after)
    lines = difflib.unified_diff(before, after, result.shown, f"{result.shown} (formatted)")
    missing = "\n\\ No newline at end of file\n"
    return "".join(line if line.endswith("\n") else line + missing for line in lines)


def _lines(text: str) -> list[str]:
    """Split a text at LF only, as its line ends may be what changes."""
    return list(io.StringIO(text, newline="\n"))


def _summary(changed: int, unchanged: int, *, writes: bool) -> str:
    what = "reformatted" if writes else "would be reformatted"
    parts = [f"{changed} file{'s' * (changed != 1)} {what}"] if changed else []
    if unchanged:
        parts.append(f"{unchanged} file{'s' * (unchanged != 1)} already formatted")
    return ", ".join(parts)
