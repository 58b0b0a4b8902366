"""What an edited domain has that it had not, and the other way round."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

from icarus_lite.language.syntax import Domain


def domain_changes(before: Domain, after: Domain) -> Iterator[str]:
    """Say which clauses were added, changed or removed; where they stand does not count.

    A clause counts as changed if one of its head was removed while another was added.
    """
    for what, old, new in (
        ("percept type", _heads(before.percepts), _heads(after.percepts)),
        ("concept", _heads(before.concepts), _heads(after.concepts)),
        ("skill", _heads(before.skills), _heads(after.skills)),
        ("attachment", _heads(before.attachments), _heads(after.attachments)),
        ("contradiction", _heads(before.contradictions), _heads(after.contradictions)),
        ("task", _heads(before.tasks), _heads(after.tasks)),
    ):
        gone = Counter(old) - Counter(new)
        come = Counter(new) - Counter(old)
        names = dict.fromkeys(name for name, _ in (*old, *new))
        for name in names:
            removed = sum(count for (head, _), count in gone.items() if head == name)
            added = sum(count for (head, _), count in come.items() if head == name)
            changed = min(removed, added)
            yield from [f"changed: {what} {name}"] * changed
            yield from [f"added: {what} {name}"] * (added - changed)
            yield from [f"removed: {what} {name}"] * (removed - changed)


def _heads(parts: Sequence[object]) -> list[tuple[str, object]]:
    return [(_name(part), part) for part in parts]


def _name(part: object) -> str:
    for attribute in ("head", "name", "attach"):
        found = getattr(part, attribute, None)
        if found is not None:
            return str(found)
    raise AssertionError(f"a part of a domain has a name: {part!r}")
