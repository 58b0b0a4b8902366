"""How the answers of the REPL look: one place for colours, so that all of them agree."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from rich.text import Text

_ATOM = re.compile(r"\((?:[^()]|\([^()]*\))*\)")


def line(text: str, style: str = "") -> Text:
    """Give a line with what stands in parentheses set off."""
    shown = Text(text, style=style)
    if not style:
        shown.highlight_regex(_ATOM, "cyan")
        shown.highlight_regex(r"^\s*[-] .*", "red")
        shown.highlight_regex(r"^\s*[+] .*", "green")
        shown.highlight_regex(r"\^[\w-]+", "magenta")
    return shown


def lines(texts: Iterable[str]) -> Text:
    """Give several lines as one answer."""
    return Text("\n").join(line(text) for each in texts for text in each.splitlines() or [""])


def heading(text: str) -> Text:
    """Give a heading."""
    return Text(text, style="bold")


def summary(record: Mapping[str, object]) -> Text:
    """Tell a cycle in a few lines: what was reported, what changed, what was decided."""
    told = [f"cycle {record['cycle']}"]
    told += [f"  {_outcome(row)}" for row in rows(record, "outcomes")]
    told += [f"  - {belief}" for belief in texts(record, "removed")]
    told += [f"  + {row['belief']}" for row in rows(record, "added")]
    told += [f"  note: {note}" for note in texts(record, "notes")]
    told.append(f"  {decided(record)}")
    return lines(told)


def decided(record: Mapping[str, object]) -> str:
    """Say in a line what was decided in a cycle, and why."""
    decision = record.get("decision")
    if not isinstance(decision, dict):
        return "no decision is on record"
    kind, action, reason = (decision.get(key) for key in ("kind", "action", "reason"))
    what = f"{kind} {action}" if action else str(kind)
    return f"{what}: {reason}" if reason else what


def _outcome(row: Mapping[str, object]) -> str:
    args = row.get("args")
    action = " ".join(map(str, (row["name"], *(args if isinstance(args, list) else ()))))
    reason = f": {row['reason']}" if row.get("reason") else ""
    return f"({action}) {row['status']}{reason}"


def rows(record: Mapping[str, object], key: str) -> Sequence[Mapping[str, object]]:
    """Give the rows of a key of a line, none where it is missing or something else."""
    found = record.get(key)
    return [row for row in found if isinstance(row, dict)] if isinstance(found, list) else []


def texts(record: Mapping[str, object], key: str) -> Sequence[str]:
    """Give the texts of a key of a line, none where it is missing or something else."""
    found = record.get(key)
    return [row for row in found if isinstance(row, str)] if isinstance(found, list) else []
