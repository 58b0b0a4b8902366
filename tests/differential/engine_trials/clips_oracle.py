"""Beliefs as CLIPS has them: each clause a rule whose conclusions stand as long as its conditions.

CLIPS withdraws a fact when its `logical` conditions fail, which is right for domains without
recursion: facts that support one another in a circle would never go. Where there is recursion,
each cycle begins afresh.

Only for domains whose concepts have no attributes, on whole numbers and symbols.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import clips

from engine_trials.comparing import Failure, compared
from engine_trials.histories import World
from engine_trials.trial import Trial, told_to_network
from icarus_lite.language import strata
from icarus_lite.language.checking.stratification import recursive_concepts
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import (
    Atom,
    Bind,
    Call,
    ConceptClause,
    Domain,
    Expression,
    Variable,
)

_GIVEN = "given-"
_NAMES = {"=": "eq", "/=": "neq"}


class ClipsOracle:
    """Keeps the beliefs of a domain in CLIPS."""

    def __init__(self, domain: Domain) -> None:
        self._lineages = lineages(domain.percepts)
        self._afresh = bool(recursive_concepts(domain.concepts))
        self._perceived = {each.name for each in domain.percepts}
        self._rules = [_given_rule(name, size) for name, size in sorted(_arities(domain))]
        turns = {name: i for i, group in enumerate(strata(domain.concepts)) for name in group}
        for number, clause in enumerate(domain.concepts):
            self._rules.append(_rule(number, clause, -turns[clause.head.predicate]))
        self._facts: dict[str, int] = {}
        self._begin()

    def beliefs(self, world: World) -> frozenset[str]:
        """Bring CLIPS to a world; give all derived and asserted beliefs as they are written."""
        wanted = dict.fromkeys(["(cycle)", *self._given(world)])
        if self._afresh:
            self._begin()
        for text in [each for each in self._facts if each not in wanted]:
            self._environment.eval(f"(retract {self._facts.pop(text)})")
        for text in wanted:
            if text not in self._facts:
                # A fact that Python holds on to when it is retracted is never freed.
                self._facts[text] = self._environment.assert_string(text).index
        self._environment.run()
        return frozenset(self._derived())

    def _begin(self) -> None:
        self._facts.clear()
        self._environment = clips.Environment()
        for rule in self._rules:
            self._environment.build(rule)

    def _given(self, world: World) -> Iterator[str]:
        for percept in world.percepts:
            for kind in self._lineages[percept.type]:
                yield f"({kind} {percept.name})"
                for name, value in percept.attributes.items():
                    yield f"({kind}-{name} {percept.name} {value})"
        for belief in world.asserted:
            assert not belief.attributes
            yield f"({' '.join([_GIVEN + belief.predicate, *map(str, belief.args)])})"

    def _derived(self) -> Iterator[str]:
        for fact in self._environment.facts():
            name = fact.template.name
            if name.startswith(_GIVEN) or name == "cycle":
                continue
            if name not in self._perceived and name.partition("-")[0] not in self._perceived:
                yield f"({' '.join([name, *map(str, fact)])})"


def clips_failure(trial: Trial) -> Failure | None:
    """Run a trial through the network and CLIPS; give the first difference, if any."""
    oracle = ClipsOracle(trial.domain())
    for cycle, (world, names) in enumerate(told_to_network(trial)):
        failure = compared("network and CLIPS", cycle, oracle.beliefs(world), names)
        if failure is not None:
            return failure
    return None


def _arities(domain: Domain) -> set[tuple[str, int]]:
    heads = [clause.head for clause in domain.concepts]
    effects = [condition.atom for skill in domain.skills for condition in skill.effects]
    return {(atom.predicate, len(atom.args)) for atom in (*heads, *effects)}


def _given_rule(name: str, size: int) -> str:
    """Write that what is given holds; apart from what is derived, so that each can go alone."""
    args = [f"?a{i}" for i in range(size)]
    given, held = _tuple(_GIVEN + name, args), _tuple(name, args)
    return f"(defrule {_GIVEN}{name} (declare (salience 1)) (logical {given}) => (assert {held}))"


def _rule(number: int, clause: ConceptClause, salience: int) -> str:
    """Write a clause; lower strata have their say first, so that a `not` is asked of all there is.

    A conclusion drawn too early would be withdrawn, but not what has begun to support itself.
    """
    positive = [_pattern(c.atom) for c in clause.elements if not c.negated]
    negative = [f"(not (and {_pattern(c.atom)}))" for c in clause.elements if c.negated]
    tests = [f"(test {_expression(test)})" for test in clause.tests]
    body = " ".join(["(cycle)", *positive, *negative, *tests])
    computed = {bind.variable.name: bind for bind in clause.binds}
    head = _tuple(clause.head.predicate, [_expression(t, computed) for t in clause.head.args])
    declared = f"(declare (salience {salience}))"
    return f"(defrule rule-{number} {declared} (logical {body}) => (assert {head}))"


def _pattern(atom: Atom) -> str:
    args = [str(term) for term in atom.args]
    parts = [_tuple(atom.predicate, args)]
    parts += [_tuple(f"{atom.predicate}-{name}", [*args, str(t)]) for name, t in atom.attributes]
    return " ".join(parts)


def _tuple(name: str, args: list[str]) -> str:
    return f"({' '.join([name, *args])})"


def _expression(expression: Expression, computed: dict[str, Bind] | None = None) -> str:
    if isinstance(expression, Variable):
        bind = (computed or {}).get(expression.name)
        return str(expression) if bind is None else _expression(bind.expression)
    if not isinstance(expression, Call):
        return str(expression)
    sides = [_expression(each) for each in expression.args]
    if expression.function == "/=":  # CLIPS asks only whether the first differs from the others
        pairs = [f"(neq {a} {b})" for a, b in combinations(sides, 2)]
        return pairs[0] if len(pairs) == 1 else f"(and {' '.join(pairs)})"
    return _tuple(_NAMES.get(expression.function, expression.function), sides)
