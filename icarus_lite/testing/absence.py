"""Why a belief that a test expects is missing: what is near it, and what each clause lacks."""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.inference import Evaluator, FactStore, near_misses, nearest_beliefs
from icarus_lite.language.syntax import Atom, Domain, Span
from icarus_lite.symbols import ATTACHED, Belief, format_value


def why_absent(
    atom: Atom, domain: Domain, facts: FactStore, evaluator: Evaluator
) -> tuple[str, ...]:
    """Give lines that say what is believed instead, and what would have had to hold.

    Args:
        atom: The belief that is missing; variables stand for anything.
        domain: The domain.
        facts: Percepts and beliefs of the cycle.
        evaluator: Evaluates the tests of the domain.

    Raises:
        InferenceError: a test of the domain cannot be evaluated.
    """
    return tuple(_lines(atom, domain, facts, evaluator))


def _lines(atom: Atom, domain: Domain, facts: FactStore, evaluator: Evaluator) -> Iterator[str]:
    near = nearest_beliefs(atom, facts)
    if near:
        yield f"nearest: {', '.join(map(_in_full, near))}"
    else:
        yield f"nothing at all is believed of `{atom.predicate}`"
    for miss in near_misses(atom, domain.concepts, facts, evaluator):
        yield str(miss)
    if any(clause.head.predicate == atom.predicate for clause in domain.concepts):
        return  # where concepts define it, no effect asserts it
    for span, action in _sources(atom, domain):
        place = f"{span.in_line}, " if span.line else ""
        yield f"{place}the success of {action} would assert it"


def _sources(atom: Atom, domain: Domain) -> Iterator[tuple[Span, Atom]]:
    """Give each action that asserts such a belief when it has succeeded, and where it says so."""
    if atom.predicate == ATTACHED:
        for rule in domain.attachments:
            yield rule.span, rule.attach
    for clause in domain.skills:
        for effect in clause.effects:
            if not effect.negated and effect.atom.predicate == atom.predicate:
                yield clause.span, clause.head
                break


def _in_full(belief: Belief) -> str:
    """Write a belief with its attributes, by which it may differ from what was expected."""
    attributes = [f" ^{name} {format_value(value)}" for name, value in belief.attributes.items()]
    return f"{str(belief)[:-1]}{''.join(attributes)})"
