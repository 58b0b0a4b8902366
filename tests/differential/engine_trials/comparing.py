"""What a trial compares, and how it says what is different."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from engine_trials.scratch import Row
from icarus_lite import Belief
from icarus_lite.symbols import Value


@dataclass(frozen=True, slots=True)
class Failure:
    """Where a trial went wrong.

    Args:
        kind: What was asked: beliefs, attributes, changes, supports, proof, log, copy, error …
        cycle: In which cycle.
        message: What was expected and what came.
    """

    kind: str
    cycle: int
    message: str


def compared(who: str, cycle: int, wanted: frozenset[str], got: frozenset[str]) -> Failure | None:
    """Compare beliefs as they are written."""
    if wanted == got:
        return None
    message = f"missing {sorted(wanted - got)}\nsurplus {sorted(got - wanted)}"
    return Failure(who, cycle, message)


def differing(
    who: str, cycle: int, wanted: frozenset[Row], got: frozenset[Row]
) -> Iterator[Failure]:
    """Say what is different between two sets of beliefs, if anything."""
    if wanted == got:
        return
    kind = "attributes" if all_named(wanted) == all_named(got) else "beliefs"
    missing, surplus = sorted(map(str, wanted - got)), sorted(map(str, got - wanted))
    yield Failure(f"{kind} of {who}", cycle, f"missing {missing}\nsurplus {surplus}")


def changed_rows(before: frozenset[Row], now: frozenset[Row]) -> tuple[frozenset[str], ...]:
    """Give the names of what came, what went, and what has other attributes."""
    added, removed = all_named(now) - all_named(before), all_named(before) - all_named(now)
    return added, removed, all_named(now - before) - added


def stretches(held: Sequence[bool]) -> list[tuple[int, int | None]]:
    """Give the stretches of cycles in which something held, as a network tells them."""
    spans: list[tuple[int, int | None]] = []
    for cycle, (before, now) in enumerate(zip([False, *held], held, strict=False)):
        if now and not before:
            spans.append((cycle, None))
        elif before and not now:
            spans[-1] = (spans[-1][0], cycle)
    return spans


def named(belief: Row) -> str:
    """Write a belief by its name and arguments."""
    return str(Belief(belief[0], belief[1]))


def all_named(beliefs: Iterable[Row]) -> frozenset[str]:
    """Write beliefs by their names and arguments."""
    return frozenset(map(named, beliefs))


def texts(beliefs: Iterable[Belief]) -> frozenset[str]:
    """Write beliefs as they are written in a domain."""
    return frozenset(map(str, beliefs))


def in_order(bindings: Mapping[str, Value]) -> str:
    """Write bindings so that equal ones are written alike."""
    return str(sorted(bindings.items()))
