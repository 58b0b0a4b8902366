"""The attachment hierarchy: who moves with whom."""

from __future__ import annotations

from collections.abc import Iterable

from aapa.errors import AnchoringError


def parents_of(attachments: Iterable[tuple[str, str]]) -> dict[str, str]:
    """Give the parent of each attached child.

    Args:
        attachments: (child, parent) pairs, such as the `attached` beliefs of the last cycle.
            The same pair may occur twice.

    Returns:
        Child to parent; following it from any child comes to an end.

    Raises:
        AnchoringError: An entry is not a pair of names, a child has two parents, or the
            attachments run in a circle.

    Source: Liang et al. 2021, algorithm 1: a child has one parent, a parent many children.

    Example:
        >>> parents_of([("plug", "case"), ("case", "hand")])
        {'plug': 'case', 'case': 'hand'}
    """
    parents: dict[str, str] = {}
    for entry in attachments:
        child, parent = _pair(entry)
        if parents.setdefault(child, parent) != parent:
            raise AnchoringError(
                f"{child} is attached to both {parents[child]} and {parent}; "
                "an object has one parent, so detach it from the first"
            )
    _refuse_circles(parents)
    return parents


def _pair(entry: object) -> tuple[str, str]:
    if isinstance(entry, tuple | list) and len(entry) == 2:
        child, parent = entry
        if isinstance(child, str) and isinstance(parent, str) and child and parent:
            return child, parent
    raise AnchoringError(f"attachment {entry!r} is not a pair of names (child, parent)")


def _refuse_circles(parents: dict[str, str]) -> None:
    sound: set[str] = set()
    for start in parents:
        chain: dict[str, None] = {}
        name: str | None = start
        while name is not None and name not in sound:
            if name in chain:
                links = list(chain)
                circle = [*links[links.index(name) :], name]
                raise AnchoringError(
                    f"the attachments run in a circle: {' → '.join(circle)}; "
                    "something in it has to rest on a parent outside"
                )
            chain[name] = None
            name = parents.get(name)
        sound.update(chain)
