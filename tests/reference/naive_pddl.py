"""PDDL by its definition: ground everything, derive to a fixpoint, search breadth first.

A reference for small problems. It shares nothing with the engine or the planner under test; only
the syntax tree of PDDL is theirs.
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.language.pddl.syntax import (
    And,
    Equal,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    PddlAction,
    PddlDomain,
    PddlProblem,
    Typed,
    is_a,
    parents,
)

Ground = tuple[str, ...]
State = frozenset[Ground]
Step = tuple[str, tuple[str, ...]]


class World:
    """A domain and a problem, ready to be run."""

    def __init__(self, domain: PddlDomain, problem: PddlProblem) -> None:
        self.domain = domain
        self.problem = problem
        self.was_cut = False
        self.start: State = frozenset((fact.predicate, *fact.args) for fact in problem.init)
        types = parents(domain.types)
        things = (*domain.constants, *problem.objects)
        names = {"object", *types}
        self.of_type = {
            kind: [each.name for each in things if is_a(types, each.type, kind)] for kind in names
        }

    def groundings(self, variables: Sequence[Typed]) -> Iterator[dict[str, str]]:
        names = [variable.name for variable in variables]
        for row in itertools.product(*[self.of_type[variable.type] for variable in variables]):
            yield dict(zip(names, row, strict=True))

    def closed(self, state: State) -> State:
        """Derive, layer by layer: a negated predicate must be complete before it is asked."""
        full = set(state)
        for layer in self._layers():
            before = -1
            while before != len(full):
                before = len(full)
                for rule in self.domain.rules:
                    if rule.predicate in layer:
                        for bound in self.groundings(rule.parameters):
                            if self.holds(rule.body, full, bound):
                                full.add(
                                    (rule.predicate, *(bound[p.name] for p in rule.parameters))
                                )
        return frozenset(full)

    def _layers(self) -> list[set[str]]:
        level = dict.fromkeys(self.domain.derived, 0)
        for _ in range(len(level) ** 2 + 1):
            for rule in self.domain.rules:
                for name, negated in _uses(rule.body, negated=False):
                    if name in level:
                        level[rule.predicate] = max(level[rule.predicate], level[name] + negated)
        return [
            {n for n, at in level.items() if at == i}
            for i in range(max(level.values(), default=0) + 1)
        ]

    def holds(self, formula: Formula, facts: set[Ground] | State, bound: Mapping[str, str]) -> bool:
        match formula:
            case Fact(predicate, args):
                return (predicate, *(bound.get(a, a) for a in args)) in facts
            case Equal(left, right):
                return bound.get(left, left) == bound.get(right, right)
            case Not(part):
                return not self.holds(part, facts, bound)
            case And(parts):
                return all(self.holds(part, facts, bound) for part in parts)
            case Or(parts):
                return any(self.holds(part, facts, bound) for part in parts)
            case Exists(variables, part):
                return any(
                    self.holds(part, facts, {**bound, **more})
                    for more in self.groundings(variables)
                )

    def after(self, state: State, action: PddlAction, bound: Mapping[str, str]) -> State:
        added: set[Ground] = set()
        removed: set[Ground] = set()
        for effect in action.effects:
            for more in self.groundings(effect.every):
                names = {**bound, **more}
                ground = (effect.fact.predicate, *(names.get(a, a) for a in effect.fact.args))
                (removed if effect.negated else added).add(ground)
        return (state - removed) | added

    def shortest(self, limit: int = 100_000) -> list[Step] | None:
        """Give a shortest plan, or None if there is none; `was_cut` says that there may be one."""
        self.was_cut = False
        frontier: deque[tuple[State, list[Step]]] = deque([(self.start, [])])
        seen = {self.start}
        while frontier:
            if len(seen) >= limit:
                self.was_cut = True
                return None
            state, steps = frontier.popleft()
            facts = self.closed(state)
            if self.holds(self.problem.goal, facts, {}):
                return steps
            for action in self.domain.actions:
                for bound in self.groundings(action.parameters):
                    if self.holds(action.precondition, facts, bound):
                        following = self.after(state, action, bound)
                        if following not in seen:
                            seen.add(following)
                            step = (action.name, tuple(bound[p.name] for p in action.parameters))
                            frontier.append((following, [*steps, step]))
        return None

    def is_valid(self, steps: Sequence[Step]) -> bool:
        """Tell whether a plan can be carried out and reaches the goal."""
        state = self.start
        for name, arguments in steps:
            action = next(each for each in self.domain.actions if each.name == name)
            bound = dict(zip((p.name for p in action.parameters), arguments, strict=True))
            typed = all(bound[p.name] in self.of_type[p.type] for p in action.parameters)
            if not typed or not self.holds(action.precondition, self.closed(state), bound):
                return False
            state = self.after(state, action, bound)
        return self.holds(self.problem.goal, self.closed(state), {})


def _uses(formula: Formula, *, negated: bool) -> Iterator[tuple[str, bool]]:
    match formula:
        case Fact(predicate):
            yield predicate, negated
        case Not(part):
            yield from _uses(part, negated=not negated)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _uses(part, negated=negated)
        case Exists(_, part):
            yield from _uses(part, negated=negated)
