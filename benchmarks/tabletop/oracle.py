"""What is true in a frame, worked out with matrices: shares nothing with any engine.

Each predicate is a vector or a matrix of truth values over the things; joins are logical
operations on whole matrices; `connected` is walked.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from tabletop.scene import State

Truth: TypeAlias = NDArray[np.bool_]
"""(n,) for a predicate of one thing, (n, n) for one of two."""

Facts: TypeAlias = frozenset[tuple[str | float, ...]]
"""Predicate and the numbers of the things."""

UNARY = ("covered", "clear", "linked", "reachable", "graspable", "has-candidate", "loose")
BINARY = ("left-of", "near", "on", "connected", "adjacent", "candidate", "assembly")
PREDICATES = (*UNARY, *BINARY)
_NEAR_MM2 = 300 * 300
_TOLERANCE_MM = 5


def truth(state: State, base: tuple[int, int, int]) -> dict[str, Truth]:
    """Give all fourteen predicates of a frame.

    Args:
        state: What is given.
        base: Where the arm stands, x and y, and the square of its reach.
    """
    count = len(state.things)
    x, y, z, w, d, h = np.array(
        [(t.x, t.y, t.z, t.w, t.d, t.h) for t in state.things], dtype=np.int64
    ).T
    other = ~np.eye(count, dtype=bool)
    holding = np.zeros(count, dtype=bool)
    holding[list(state.holding)] = True
    fixed = np.zeros((count, count), dtype=bool)
    for one, another in state.fixed:
        fixed[one, another] = True
    dx, dy, dz = (each[:, None] - each[None, :] for each in (x, y, z))
    left = other & ((2 * x + w)[:, None] <= (2 * x - w)[None, :])
    near = other & (dx**2 + dy**2 + dz**2 < _NEAR_MM2)
    stacked = np.abs(z[:, None] - (z + h)[None, :]) <= _TOLERANCE_MM
    within = (2 * np.abs(dx) < w[None, :]) & (2 * np.abs(dy) < d[None, :])
    on = other & stacked & within & ~holding[:, None]
    covered = on.any(axis=0)
    connected = _closure(fixed)
    linked = connected.any(axis=1)
    reachable = (x - base[0]) ** 2 + (y - base[1]) ** 2 + z**2 <= base[2]
    graspable = ~covered & reachable & ~holding
    adjacent = left & near
    candidate = adjacent & graspable[:, None] & ~covered[None, :]
    has_candidate = candidate.any(axis=1)
    loose = has_candidate & ~linked
    kinds = np.array([t.type for t in state.things])
    fits = (kinds == "peg")[:, None] & (kinds == "hole")[None, :]
    assembly = adjacent & loose[:, None] & loose[None, :] & fits
    return {
        "left-of": left, "near": near, "on": on, "covered": covered, "clear": ~covered,
        "connected": connected, "linked": linked, "reachable": reachable, "graspable": graspable,
        "adjacent": adjacent, "candidate": candidate, "has-candidate": has_candidate,
        "loose": loose, "assembly": assembly,
    }  # fmt: skip


def _closure(relation: Truth) -> Truth:
    """Give the transitive closure, by walking from each thing wherever it leads."""
    follows: dict[int, list[int]] = {}
    for one, another in np.argwhere(relation).tolist():
        follows.setdefault(one, []).append(another)
    closed = np.zeros_like(relation)
    for start in follows:
        seen: set[int] = set()
        pending = [start]
        while pending:
            fresh = [each for each in follows.get(pending.pop(), ()) if each not in seen]
            seen.update(fresh)
            pending += fresh
        closed[start, list(seen)] = True
    return closed


def facts(true: Mapping[str, Truth], names: Iterable[str] = PREDICATES) -> Facts:
    """Give truth values as a set of facts."""
    return frozenset(
        (name, *map(int, place)) for name in names for place in np.argwhere(true[name])
    )


def difference(before: Mapping[str, Truth], now: Mapping[str, Truth]) -> tuple[Facts, Facts]:
    """Give the facts that have become true, and those that are true no longer."""
    return (
        facts({name: now[name] & ~before[name] for name in now}),
        facts({name: before[name] & ~now[name] for name in now}),
    )


def total(true: Mapping[str, Truth]) -> int:
    """Count all facts."""
    return int(sum(int(each.sum()) for each in true.values()))
