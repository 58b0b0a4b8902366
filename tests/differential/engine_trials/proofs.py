"""Whether the reasons given for a belief are reasons: each derivation checked on its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence

from icarus_lite import Belief
from icarus_lite.inference import Derivation, FactStore, Support, match
from icarus_lite.language import evaluate
from icarus_lite.language.syntax import Atom, Domain, Variable
from icarus_lite.symbols import Value

Supports = Callable[[Belief], Sequence[Support]]


def faults(domain: Domain, facts: FactStore, belief: Belief, found: Derivation) -> Iterator[str]:
    """Say what is wrong with a derivation, given everything that holds.

    Args:
        domain: Whose clause it must be.
        facts: Percepts and beliefs of the cycle.
        belief: What is derived.
        found: How.
    """
    if found.clause not in domain.concepts:
        yield f"its clause is none of the domain's: {found.clause.head}"
    yield from _wrong_conditions(facts, found)
    clause, bindings = found.clause, found.bindings
    bound_later = {bind.variable.name for bind in clause.binds}
    computed = {name: value for name, value in bindings.items() if name not in bound_later}
    for test in clause.tests:
        if evaluate(test, computed) is not True:
            yield f"the test {test} does not hold under {computed}"
    for bind in clause.binds:
        value = evaluate(bind.expression, computed)
        if bindings.get(bind.variable.name) != value:
            yield f"{bind.variable} should be {value}"
        assert not isinstance(value, bool)
        computed[bind.variable.name] = value
    if _values(clause.head, computed) != belief.args:
        yield f"it derives {_values(clause.head, computed)}"


def _wrong_conditions(facts: FactStore, found: Derivation) -> Iterator[str]:
    bindings = dict(found.bindings)
    positive = [c.atom for c in found.clause.elements if not c.negated]
    if len(positive) != len(found.matched):
        yield f"{len(found.matched)} facts meet {len(positive)} conditions"
    for atom, fact in zip(positive, found.matched, strict=False):
        entries = facts.rows(fact.predicate).get(fact.args, ())
        if not entries:
            yield f"it rests on {fact}, which does not hold"
        elif match(atom, entries[0][1], bindings) != bindings:
            yield f"{fact} does not meet {atom} under {bindings}"
    for condition in found.clause.elements:
        blocking = facts.matches(condition.atom, bindings) if condition.negated else ()
        for _, fact in blocking:
            yield f"{condition} is blocked by {fact}"


def _values(head: Atom, bindings: Mapping[str, Value]) -> tuple[Value | None, ...]:
    return tuple(
        bindings.get(term.name) if isinstance(term, Variable) else term.value for term in head.args
    )


def circle(belief: Belief, supports: Supports, given: Callable[[Belief], bool]) -> str | None:
    """Follow first derivations down to what is given; say what is wrong with the proof.

    Args:
        belief: What is to be proved.
        supports: All reasons for a belief, the one to tell first in front.
        given: Whether a fact is a percept or asserted, and needs no proof.

    Returns:
        What is wrong, or None for a proof as it should be.
    """
    done: set[Belief] = set()
    open_: list[Belief] = []
    pending: list[tuple[Belief, bool]] = [(belief, False)]
    while pending:
        each, proved = pending.pop()
        if proved:
            open_.remove(each)
            done.add(each)
            continue
        if each in done or given(each):
            continue
        if each in open_:
            return f"the proof of {belief} rests on {each}, which rests on itself"
        reasons = [reason for reason in supports(each) if isinstance(reason, Derivation)]
        if not reasons:
            return f"the proof of {belief} ends at {each}, for which there is no reason"
        open_.append(each)
        pending.append((each, True))
        pending += [(fact, False) for fact in reasons[0].matched]
    return None
