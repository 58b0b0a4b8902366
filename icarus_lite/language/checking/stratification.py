"""The order in which concepts must be inferred, so that `not` means "there is none".

A concept that uses another positively may be inferred together with it, one that uses another
inside `not` only after it is complete. That order exists unless a concept depends on its own
negation; then the rules have no least model to agree on (Apt, Blair and Walker 1988).
"""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Iterable, Mapping, Sequence

from icarus_lite.errors import IcarusError
from icarus_lite.language.syntax import ConceptClause, Condition
from icarus_lite.records import dataclass

_LONGEST_PATH = 12
_MOST_CYCLES = 10


@dataclass(frozen=True, slots=True)
class NegationCycle:
    """A concept that depends on its own negation.

    Args:
        clause: The clause that holds the negated literal.
        condition: The negated literal.
        path: The predicates from the literal's back to the clause's head, both included.
    """

    clause: ConceptClause
    condition: Condition
    path: tuple[str, ...]

    def __str__(self) -> str:
        path = self.path
        if len(path) > _LONGEST_PATH:
            path = (*path[: _LONGEST_PATH // 2], "…", *path[-_LONGEST_PATH // 2 :])
        return f"{self.clause.head.predicate} -> not {' -> '.join(path)}"


class NotStratifiedError(IcarusError, ValueError):
    """The concepts cannot be ordered; `cycle` says why."""

    def __init__(self, cycle: NegationCycle) -> None:
        self.cycle = cycle
        super().__init__(f"a concept depends on its own negation: {cycle}")


def strata(clauses: Sequence[ConceptClause]) -> tuple[tuple[str, ...], ...]:
    """Group the concepts' predicates in the order of inference, bottom first.

    Each group is a set of predicates that depend on one another (mostly a single one), listed in
    the order of their definition. A group depends on earlier groups only.

    Raises:
        NotStratifiedError: A concept depends on its own negation.
    """
    cycles = negation_cycles(clauses)
    if cycles:
        raise NotStratifiedError(cycles[0])
    return _groups(_dependencies(clauses))


def negation_cycles(clauses: Sequence[ConceptClause]) -> tuple[NegationCycle, ...]:
    """Find the negated literals through which a concept depends on its own negation.

    Of concepts that all depend on one another, ten such literals are enough to start with.
    """
    dependencies = _dependencies(clauses)
    group_of = {
        predicate: number
        for number, group in enumerate(_groups(dependencies))
        for predicate in group
    }
    cycles: list[NegationCycle] = []
    found: Counter[int] = Counter()
    for clause in clauses:
        head = clause.head.predicate
        for condition in clause.elements:
            used = condition.atom.predicate
            group = group_of[head]
            if not condition.negated or group_of.get(used) != group:
                continue
            found[group] += 1
            if found[group] <= _MOST_CYCLES:
                path = _shortest_path(dependencies, used, head)
                cycles.append(NegationCycle(clause, condition, path))
    return tuple(cycles)


def recursive_concepts(clauses: Sequence[ConceptClause]) -> frozenset[str]:
    """Give the concepts that are, directly or through others, used in their own definition."""
    dependencies = _dependencies(clauses)
    return frozenset(
        predicate
        for group in _groups(dependencies)
        for predicate in group
        if len(group) > 1 or predicate in dependencies[predicate]
    )


def _dependencies(clauses: Iterable[ConceptClause]) -> dict[str, dict[str, None]]:
    """Map each concept to the concepts its clauses use, both in the order of the text."""
    uses: dict[str, dict[str, None]] = {clause.head.predicate: {} for clause in clauses}
    for clause in clauses:
        for condition in clause.elements:
            if condition.atom.predicate in uses:
                uses[clause.head.predicate][condition.atom.predicate] = None
    return uses


def _groups(dependencies: Mapping[str, Iterable[str]]) -> tuple[tuple[str, ...], ...]:
    """Give the strongly connected components, dependencies first (Tarjan 1972).

    The stack is explicit, so that a long chain of concepts cannot exhaust the call stack.
    """
    position = {predicate: number for number, predicate in enumerate(dependencies)}
    index: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_predicates: list[str] = []
    is_open: set[str] = set()
    groups: list[tuple[str, ...]] = []
    for root in dependencies:
        if root in index:
            continue
        work = [(root, iter(dependencies[root]))]
        index[root] = lowest[root] = len(index)
        open_predicates.append(root)
        is_open.add(root)
        while work:
            predicate, remaining = work[-1]
            used = next(remaining, None)
            if used is None:
                work.pop()
                if work:
                    caller = work[-1][0]
                    lowest[caller] = min(lowest[caller], lowest[predicate])
                if lowest[predicate] == index[predicate]:
                    group = [open_predicates.pop()]
                    while group[-1] != predicate:
                        group.append(open_predicates.pop())
                    is_open.difference_update(group)
                    groups.append(tuple(sorted(group, key=position.__getitem__)))
            elif used not in index:
                index[used] = lowest[used] = len(index)
                open_predicates.append(used)
                is_open.add(used)
                work.append((used, iter(dependencies[used])))
            elif used in is_open:
                lowest[predicate] = min(lowest[predicate], index[used])
    return tuple(groups)


def _shortest_path(
    dependencies: Mapping[str, Iterable[str]], start: str, goal: str
) -> tuple[str, ...]:
    """Give the shortest chain of uses between two predicates of one group."""
    came_from: dict[str, str] = {start: start}
    queue = deque([start])
    while queue and goal not in came_from:
        predicate = queue.popleft()
        for used in dependencies[predicate]:
            if used not in came_from:
                came_from[used] = predicate
                queue.append(used)
    path = [goal]
    while path[-1] != start:
        path.append(came_from[path[-1]])
    return tuple(reversed(path))
