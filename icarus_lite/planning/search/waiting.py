"""What both searches keep books with: steps that wait to be tried, and where states came from."""

from __future__ import annotations

from collections import deque
from heapq import heappop, heappush


class Waiting:
    """Steps that wait to be tried: those of the least rank first, the oldest of them first.

    A state waits once for all its steps, which are then given out one after the other; so putting
    a thousand steps in line costs no more than one.
    """

    __slots__ = ("_lines", "_ranks", "turns")

    def __init__(self) -> None:
        self._lines: dict[int, deque[tuple[int, list[int]]]] = {}
        self._ranks: list[int] = []
        self.turns = 0

    def push(self, rank: int, node: int, steps: list[int]) -> None:
        """Put the steps from a node in line. The list is used up."""
        if steps:
            steps.reverse()
            if rank in self._lines:
                self._lines[rank].append((node, steps))
            else:
                self._lines[rank] = deque([(node, steps)])
                heappush(self._ranks, rank)

    def pop(self) -> tuple[int, int]:
        """Take the first step out of the line, with the node that it starts from."""
        rank = self._ranks[0]
        line = self._lines[rank]
        node, steps = line[0]
        step = steps.pop()
        if not steps:
            line.popleft()
            if not line:
                heappop(self._ranks)
                del self._lines[rank]
        self.turns += 1
        return node, step

    def __bool__(self) -> bool:
        return bool(self._ranks)


def way(origins: list[tuple[int, int]], node: int) -> tuple[int, ...]:
    """Give the steps that led to a node, from the node and step that each node came from."""
    steps = []
    while node > 0:
        node, step = origins[node]
        steps.append(step)
    return tuple(reversed(steps))
