"""A second opinion on inference: try every binding over every constant, stratum by stratum.

Slow and obviously right; shares nothing with the engine but the syntax tree.
"""

from __future__ import annotations

from itertools import product

from icarus_lite.language.syntax import Atom, ConceptClause, Constant


def model(clauses: list[ConceptClause], facts: set[tuple]) -> set[tuple]:
    """Give the stratified least model of facts `(predicate, arg, …)` under the clauses."""
    constants = sorted(
        {value for fact in facts for value in fact[1:]}
        | {t.value for c in clauses for a in _atoms(c) for t in a.args if isinstance(t, Constant)},
        key=str,
    )
    level = _levels(clauses)
    true = set(facts)
    for height in sorted(set(level.values())):
        layer = [c for c in clauses if level[c.head.predicate] == height]
        while True:
            new = {head for c in layer for head in _heads(c, constants, true)} - true
            if not new:
                break
            true |= new
    return true


def _atoms(clause: ConceptClause) -> list[Atom]:
    return [clause.head, *(c.atom for c in clause.elements)]


def _levels(clauses: list[ConceptClause]) -> dict[str, int]:
    level = {c.head.predicate: 0 for c in clauses}
    for _ in range(len(level) + 1):
        for c in clauses:
            for e in c.elements:
                below = level.get(e.atom.predicate, 0) + e.negated
                level[c.head.predicate] = max(level[c.head.predicate], below)
    return level


def _heads(clause: ConceptClause, constants: list, true: set[tuple]) -> set[tuple]:
    positive = [e.atom for e in clause.elements if not e.negated]
    negative = [e.atom for e in clause.elements if e.negated]
    names = sorted({v for atom in positive for v in atom.variables})
    heads = set()
    for values in product(constants, repeat=len(names)):
        bound = dict(zip(names, values, strict=True))
        if all(_ground(a, bound) in true for a in positive) and not any(
            _some(a, bound, constants, true) for a in negative
        ):
            heads.add(_ground(clause.head, bound))
    return heads


def _some(atom: Atom, bound: dict, constants: list, true: set[tuple]) -> bool:
    free = sorted({v for v in atom.variables if v not in bound})
    return any(
        _ground(atom, {**bound, **dict(zip(free, values, strict=True))}) in true
        for values in product(constants, repeat=len(free))
    )


def _ground(atom: Atom, bound: dict) -> tuple:
    return (
        atom.predicate,
        *(t.value if isinstance(t, Constant) else bound[t.name] for t in atom.args),
    )
