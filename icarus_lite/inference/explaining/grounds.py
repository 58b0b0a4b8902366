"""Which beliefs can be established without a given one, and how.

In a recursive concept two beliefs may support each other. A derivation of the one from the other
is true, but as a reason it presupposes what it is to show. So an alternative counts only if all
that it rests on follows from percepts and assertions by some way that leaves the belief out.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence

from icarus_lite.inference.supports import Derivation, Support
from icarus_lite.symbols import Belief


def well_founded(
    roots: Iterable[Belief],
    supports: Mapping[Belief, Sequence[Support]],
    without: Belief | None = None,
) -> dict[Belief, Support]:
    """Give each belief that can be established, without another one if so asked, and how.

    Args:
        roots: The beliefs in question; whatever they may rest on is looked at as well.
        supports: All supports of each belief. What has none is taken to be perceived.
        without: The belief to leave out.

    Returns:
        The support to follow for each. Followed from any of them, supports never come back to
        where they began, nor to the belief left out.
    """
    ways = _collect(roots, supports, without)
    users: dict[Belief, list[int]] = {}
    for number, (_, support) in enumerate(ways):
        for premise in _premises(support):
            users.setdefault(premise, []).append(number)
    lacking = [len(_premises(support)) for _, support in ways]
    chosen: dict[Belief, Support] = {}
    ready = deque(number for number, count in enumerate(lacking) if not count)
    perceived = (each for each in users if each != without and not supports.get(each))
    queue = deque(perceived)
    while ready or queue:
        while queue:
            for number in users.get(queue.popleft(), ()):
                lacking[number] -= 1
                if not lacking[number]:
                    ready.append(number)
        if ready:
            belief, support = ways[ready.popleft()]
            if belief not in chosen:
                chosen[belief] = support
                queue.append(belief)
    return chosen


def _collect(
    roots: Iterable[Belief], supports: Mapping[Belief, Sequence[Support]], without: Belief | None
) -> list[tuple[Belief, Support]]:
    """Give every way to establish the roots and what they may rest on, those left out aside."""
    ways: list[tuple[Belief, Support]] = []
    seen, waiting = {without}, deque(roots)
    while waiting:
        belief = waiting.popleft()
        if belief in seen:
            continue
        seen.add(belief)
        for support in supports.get(belief, ()):
            ways.append((belief, support))
            waiting += _premises(support)
    return ways


def _premises(support: Support) -> tuple[Belief, ...]:
    """Give what a support rests on, each belief once."""
    return tuple(dict.fromkeys(support.matched)) if isinstance(support, Derivation) else ()
