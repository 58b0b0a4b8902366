"""What planning begins with: the beliefs of now, or those that a task gives."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.inference import (
    Evaluator,
    FactStore,
    Hierarchy,
    given_beliefs,
    given_percepts,
    percept_facts,
)
from icarus_lite.language.percept_types import lineages
from icarus_lite.language.syntax import Atom, Condition, Domain
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Belief, Value


@dataclass(frozen=True, slots=True)
class Beginning:
    """The beliefs of now, as grounding needs them.

    Args:
        percepts: What is perceived, as facts.
        asserted: Persisting effects.
        hierarchy: Who moves with whom.
        facts: All that is believed, percepts and derived beliefs included.
        evaluator: Evaluates the tests of the domain.
    """

    percepts: Sequence[Belief]
    asserted: frozenset[Belief]
    hierarchy: Hierarchy
    facts: FactStore
    evaluator: Evaluator

    def holds(self, goals: Sequence[Condition]) -> bool:
        """Tell whether goals hold now, for some binding of their free variables."""
        return holds(goals, self.facts, evaluator=self.evaluator)


def given_beginning(domain: Domain, init: Iterable[Atom]) -> Beginning:
    """Give what is believed when a task begins, as the first cycle of an engine would.

    For who only plans: there is no memory in which a second cycle could follow.

    Args:
        domain: Says what is a percept, and what follows from what. It must have no
            `contradictions`: what percepts speak against, an engine may withdraw.
        init: The facts of the task, as `Task.init` has them.

    Raises:
        InferenceError: a test or a bind cannot be evaluated; the text has the place.
        ValueError: the domain has contradictions.
    """
    if domain.contradictions:
        raise ValueError("the domain has contradictions, which only an engine can weigh")
    init, evaluator = tuple(init), Evaluator()
    given = given_beliefs(domain, init)
    percepts = tuple(percept_facts(given_percepts(domain, init), lineages(domain.percepts)))
    facts = FactStore(percepts)
    for belief in given.asserted:
        facts.add(belief)
    for pair in given.hierarchy.pairs():
        facts.add(Belief(ATTACHED, pair))
    if domain.concepts:
        from icarus_lite.inference import Closure  # noqa: PLC0415 - else it is not needed

        Closure(domain.concepts, evaluator).derive(facts)
    return Beginning(percepts, frozenset(given.asserted), given.hierarchy, facts, evaluator)


def holds(
    conditions: Sequence[Condition],
    facts: FactStore,
    bindings: dict[str, Value] | None = None,
    evaluator: Evaluator | None = None,
) -> bool:
    """Tell whether a conjunction holds for some binding of its free variables."""
    bound = tuple(bindings or ())
    found = (evaluator or Evaluator()).matcher(conditions, (), bound).matches(facts, bindings)
    return any(True for _ in found)
