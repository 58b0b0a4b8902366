"""The smallest trial that still fails: clauses, conditions, cycles and facts left out in turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TypeVar

from engine_trials.comparing import Failure
from engine_trials.histories import Change
from engine_trials.trial import Trial, failure_of
from icarus_lite.language.syntax import ConceptClause

_T = TypeVar("_T")


def shrunk(
    trial: Trial,
    failure: Failure,
    judge: Callable[[Trial], Failure | None] = failure_of,
    most: int = 600,
) -> tuple[Trial, Failure]:
    """Leave things out of a failing trial as long as it goes on failing in the same way.

    Args:
        trial: Fails.
        failure: How.
        judge: Runs a trial.
        most: How many trials to run at most.

    Returns:
        The smallest trial found, and its failure.
    """
    left = most
    smaller = True
    while smaller and left > 0:
        smaller = False
        for candidate in _smaller(trial):
            left -= 1
            if left <= 0:
                break
            try:
                found = judge(candidate)
            except ValueError:  # what is left is no legal domain
                continue
            if found is not None and found.kind == failure.kind:
                trial, failure, smaller = candidate, found, True
                break
    return trial, failure


def _smaller(trial: Trial) -> Iterator[Trial]:
    """Give trials with something left out, the greatest parts first."""
    for history in _without(trial.history, keep=1):
        yield replace(trial, history=tuple(history))
    for place in range(1, len(trial.history)):  # two cycles told as one
        yield replace(trial, history=_joined(trial.history, place))
    for clauses in _without(trial.clauses, keep=1):
        yield replace(trial, clauses=tuple(clauses))
    for place, change in enumerate(trial.history):
        for simpler in _simpler_change(change):
            history = (*trial.history[:place], simpler, *trial.history[place + 1 :])
            yield replace(trial, history=history)
    for place, clause in enumerate(trial.clauses):
        for simple in _simpler_clause(clause):
            clauses_now = (*trial.clauses[:place], simple, *trial.clauses[place + 1 :])
            yield replace(trial, clauses=clauses_now)


def _without(items: Sequence[_T], keep: int = 0) -> Iterator[list[_T]]:
    """Leave out halves, quarters, … and at last single items."""
    size = len(items) // 2
    while size:
        for start in range(0, len(items), size):
            rest = [*items[:start], *items[start + size :]]
            if len(rest) >= keep:
                yield rest
        size //= 2
    if len(items) == 1 and keep == 0:
        yield []


def _joined(history: tuple[Change, ...], place: int) -> tuple[Change, ...]:
    first, second = history[place - 1], history[place]
    percepts = {(p.type, p.name): p for p in first.percepts if (p.type, p.name) not in second.gone}
    percepts |= {(p.type, p.name): p for p in second.percepts}
    gone = tuple(key for key in dict.fromkeys((*first.gone, *second.gone)) if key not in percepts)
    asserted = [each for each in first.asserted if each not in second.withdrawn]
    asserted = [each for each in asserted if each not in second.asserted]
    both = Change(
        tuple(percepts.values()),
        gone,
        (*asserted, *second.asserted),
        tuple(dict.fromkeys((*first.withdrawn, *second.withdrawn))),
    )
    return (*history[: place - 1], both, *history[place + 1 :])


def _simpler_change(change: Change) -> Iterator[Change]:
    for percepts in _without(change.percepts):
        yield replace(change, percepts=tuple(percepts))
    for gone in _without(change.gone):
        yield replace(change, gone=tuple(gone))
    for asserted in _without(change.asserted):
        yield replace(change, asserted=tuple(asserted))
    for withdrawn in _without(change.withdrawn):
        yield replace(change, withdrawn=tuple(withdrawn))


def _simpler_clause(clause: ConceptClause) -> Iterator[ConceptClause]:
    for elements in _without(clause.elements):
        yield replace(clause, elements=tuple(elements))
    for tests in _without(clause.tests):
        yield replace(clause, tests=tuple(tests))
    for place, condition in enumerate(clause.elements):
        for attributes in _without(condition.atom.attributes):
            atom = replace(condition.atom, attributes=tuple(attributes))
            simpler = replace(condition, atom=atom)
            elements_now = (*clause.elements[:place], simpler, *clause.elements[place + 1 :])
            yield replace(clause, elements=elements_now)
