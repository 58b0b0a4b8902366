"""Derived facts in an order in which each comes after those it rests on."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence


def components(  # noqa: C901 - one algorithm
    uses: Mapping[int, Sequence[int]],
) -> Iterator[tuple[int, ...]]:
    """Give the strongly connected components of a graph, those depended on first (Tarjan 1972).

    Args:
        uses: For each node those that it depends on; what is no key of it is ignored.
    """
    index: dict[int, int] = {}
    lowest: dict[int, int] = {}
    waiting: list[int] = []
    is_waiting: set[int] = set()
    for root in uses:
        if root in index:
            continue
        path = [(root, iter(uses[root]))]
        index[root] = lowest[root] = len(index)
        waiting.append(root)
        is_waiting.add(root)
        while path:
            node, rest = path[-1]
            for used in rest:
                if used not in uses:
                    continue
                if used not in index:
                    index[used] = lowest[used] = len(index)
                    waiting.append(used)
                    is_waiting.add(used)
                    path.append((used, iter(uses[used])))
                    break
                if used in is_waiting:
                    lowest[node] = min(lowest[node], index[used])
            else:
                path.pop()
                if path:
                    lowest[path[-1][0]] = min(lowest[path[-1][0]], lowest[node])
                if lowest[node] == index[node]:
                    component = [waiting.pop()]
                    while component[-1] != node:
                        component.append(waiting.pop())
                    is_waiting.difference_update(component)
                    yield tuple(reversed(component))
