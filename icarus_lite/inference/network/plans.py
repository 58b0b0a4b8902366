"""Plans: how the network joins each clause, as data for those who want to see it."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.inference.network.bodies import Body
from icarus_lite.inference.network.design import Design, Head, place_of
from icarus_lite.inference.network.generation.rules import Wiring
from icarus_lite.inference.network.ordering import Absent, Ask, Step, selectivity
from icarus_lite.inference.network.relations import Facts, Pairs, Relation
from icarus_lite.language.syntax import Call, ConceptClause, Term
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class StepPlan:
    """One step of a join.

    Args:
        kind: `find` rows, `ask` a test, or see that a row is `absent`.
        text: What is found or asked, as a pattern or test.
        access: How rows are found: `member`, `get`, `index` or `scan`; empty for a test.
        by: The terms that are known beforehand and looked up by.
        estimate: How many rows are expected for each that comes in.
        kernel: Where a numeric kernel keeps the rows, how it does; else None.
        conditions: The positive conditions that it stands for, numbered as written.
        call: The test, where it is one.
    """

    kind: str
    text: str
    access: str
    by: tuple[str, ...]
    estimate: float
    kernel: str | None
    conditions: tuple[int, ...] = ()
    call: Call | None = None


@dataclass(frozen=True, slots=True)
class UpdatePlan:
    """How a clause is joined when a row of one of its conditions comes or goes.

    Args:
        lead: That condition; a negated one begins with `not`.
        steps: The steps.
    """

    lead: str
    steps: tuple[StepPlan, ...]


@dataclass(frozen=True, slots=True)
class ClausePlan:
    """How one clause is joined.

    Args:
        number: Its place among all clauses, as written.
        clause: The clause.
        place: Where it stands: file and line.
        keeping: How the beliefs of its concept are kept: see `Keeping`.
        component: Concepts with the same number are inferred together.
        steps: The join from scratch.
        updates: The joins for changes; none where a kernel keeps the beliefs, or where they are
            derived from scratch.
    """

    number: int
    clause: ConceptClause
    place: str
    keeping: str
    component: int
    steps: tuple[StepPlan, ...]
    updates: tuple[UpdatePlan, ...]


def plans_of(design: Design, wiring: Wiring) -> tuple[ClausePlan, ...]:
    """Give the plan of each clause, in the order of the text."""
    heads = {body.number: head for head in design.heads for body in head.bodies}
    return tuple(_plan(design, heads[body.number], body, wiring) for body in design.bodies)


def _plan(design: Design, head: Head, body: Body, wiring: Wiring) -> ClausePlan:
    joins = wiring.plans[body.number]
    updates = []
    for key, steps in joins.items():
        if key.startswith("not "):
            negation = body.negations[int(key[4:])]
            updates.append(UpdatePlan(f"not {negation.atom}", _steps(steps)))
        elif key.isdigit():
            literal = body.literals[int(key)]
            text = _pattern(literal.relation, literal.terms)
            updates.append(UpdatePlan(text, _steps(steps)))
    return ClausePlan(
        body.number,
        body.clause,
        place_of(body.clause, design.domain),
        str(head.keeping),
        head.component,
        _steps(joins["all"]),
        tuple(updates),
    )


def _steps(steps: Sequence[Step]) -> tuple[StepPlan, ...]:
    return tuple(_step(step) for step in steps)


def _step(step: Step) -> StepPlan:
    if isinstance(step, Ask):
        call = step.test.call
        return StepPlan("ask", str(call), "", (), selectivity(call), None, (), call)
    if isinstance(step, Absent):
        by = tuple(str(step.negation.terms[cell]) for cell in step.bound)
        text = str(step.negation.atom)
        return StepPlan("absent", text, str(step.access), by, 0.5, None)
    literal = step.literal
    kernel = None
    if isinstance(literal.relation, Pairs):
        kernel = literal.relation.kernel.summary
    return StepPlan(
        "find",
        _pattern(literal.relation, literal.terms),
        str(step.access),
        tuple(str(literal.terms[cell]) for cell in step.bound),
        step.estimate,
        kernel,
        tuple(sorted(literal.places)),
    )


def _pattern(relation: Relation, terms: Sequence[Term]) -> str:
    """Write a relation with its terms as a pattern."""
    if isinstance(relation, Pairs):
        left, right = terms
        tests = " ".join(map(str, relation.tests))
        return f"({relation.left.type} {left}) ({relation.right.type} {right}) {tests}"
    words = [relation.predicate if isinstance(relation, Facts) else relation.type]
    words += [str(term) for term in terms[: relation.keys]]
    cells = relation.cells
    words += [f"^{n} {t}" for n, t in zip(cells, terms[relation.keys :], strict=True)]
    return f"({' '.join(words)})"
