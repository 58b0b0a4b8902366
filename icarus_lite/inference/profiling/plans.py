"""How a clause is compiled, in words: what is looked up first and how, and where tests are asked.

Two sorts of joins are told: the one that finds every row of a clause at once, and for each
condition the one that is run when a row of it comes or goes. From cycle to cycle the network runs
only the latter.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from icarus_lite.inference.network.bodies import Body, Literal
from icarus_lite.inference.network.compiled import CompiledDomain
from icarus_lite.inference.network.design import Design, Head, Keeping, place_of
from icarus_lite.inference.network.ordering import Absent, Access, Ask, Find, Step, arrange
from icarus_lite.inference.network.relations import Facts, Pairs, Relation, View
from icarus_lite.language.syntax import Atom, Call, ConceptClause, Term
from icarus_lite.records import dataclass

KEPT: Final = {
    Keeping.PAIRS: "a numeric kernel keeps its pairs; a moved object has its row and column tried",
    Keeping.UNIQUE: "each belief has at most one derivation: it is there or not",
    Keeping.COUNTED: "the derivations of each belief are counted",
    Keeping.ATTRIBUTED: "the derivations of each belief are kept with the attributes they give",
    Keeping.RECURSIVE: "recursive: what rested on something that went is taken back, then proved "
    "again by another way if there is one",
    Keeping.RECOMPUTED: "recursive and with attributes: worked out anew when anything changes that "
    "it rests on",
}
"""How the beliefs of a concept are kept up to date, in words."""


@dataclass(frozen=True, slots=True)
class PlannedStep:
    """One step of a clause's join.

    Args:
        what: The condition or the test, as the domain states it; of pairs only who they are.
        how: How its facts are found, or where the test is asked.
        why: Why it stands where it does.
        expected: How many rows the compiler expects for each that comes in; None for a test.
        atoms: The patterns that are matched in this step.
        tests: The tests that are asked in it.
        negated: Whether it asks that nothing matches.
    """

    what: str
    how: str
    why: str
    expected: float | None
    atoms: tuple[Atom, ...]
    tests: tuple[Call, ...]
    negated: bool = False


@dataclass(frozen=True, slots=True)
class UpdatePlan:
    """What is joined when something that matches one condition comes or goes.

    Args:
        lead: That condition.
        steps: The join of the others with it.
    """

    lead: str
    steps: tuple[PlannedStep, ...]


@dataclass(frozen=True, slots=True)
class RulePlan:
    """The compiled form of one clause.

    Args:
        clause: The clause.
        number: Its place among all clauses of the domain, from 0.
        place: Where it stands: `domains/cell.icr:31`.
        kept: How the beliefs of its concept are kept up to date, in words.
        steps: The join that finds all its rows.
        updates: The joins for changes; none where a kernel keeps the beliefs, or where they are
            worked out anew.
        kernel: How its numeric kernel works, in words; empty if it has none of its own.
    """

    clause: ConceptClause
    number: int
    place: str
    kept: str
    steps: tuple[PlannedStep, ...]
    updates: tuple[UpdatePlan, ...] = ()
    kernel: str = ""


def rule_plans(compiled: CompiledDomain) -> tuple[RulePlan, ...]:
    """Give the plan of every clause of a domain, as written."""
    form = compiled.form(frozenset())
    design, joins = form.design, form.module.wiring.plans
    heads = {body.number: head for head in design.heads for body in head.bodies}
    return tuple(
        _plan(body, heads[body.number], design, joins[body.number]) for body in design.bodies
    )


def _plan(
    body: Body, head: Head, design: Design, joins: Mapping[str, tuple[Step, ...]]
) -> RulePlan:
    wording = _Wording(body)
    return RulePlan(
        body.clause,
        body.number,
        place_of(body.clause, design.domain),
        KEPT[head.keeping],
        tuple(wording.steps(arrange(body, design.sizes))),
        tuple(wording.updates(joins)),
        wording.kernel,
    )


class _Wording:
    """Puts the steps of one body into words."""

    def __init__(self, body: Body) -> None:
        self._body = body
        self._positive = [c.atom for c in body.clause.elements if not c.negated]

    @property
    def kernel(self) -> str:
        """How the kernel works that stands for the first two conditions, if one does."""
        for literal in self._body.literals:
            if isinstance(literal.relation, Pairs) and len(literal.places) == 2:
                return literal.relation.kernel.summary
        return ""

    def updates(self, joins: Mapping[str, tuple[Step, ...]]) -> Iterator[UpdatePlan]:
        """Give the joins for changes; those of negated conditions come last."""
        for key, steps in joins.items():
            if key.isdigit():
                lead = _named_atoms(self._atoms(self._body.literals[int(key)]))
            elif key.startswith("not "):
                lead = f"(not {self._body.negations[int(key[4:])].atom})"
            else:
                continue
            yield UpdatePlan(lead, tuple(self.steps(steps, begins=False)))

    def steps(self, steps: Sequence[Step], *, begins: bool = True) -> Iterator[PlannedStep]:
        """Give the steps of a join; one that does not begin it has rows coming in."""
        first = begins
        for step in steps:
            if isinstance(step, Find):
                yield self._find(step, first=first)
                first = False
            elif isinstance(step, Ask):
                after = "as soon as its variables are bound"
                if step.test.after:
                    after = "once the conditions before it have been met, which may protect it"
                yield PlannedStep(str(step.test.call), "asked", after, None, (), (step.test.call,))
            else:
                yield self._absent(step)

    def _find(self, step: Find, *, first: bool) -> PlannedStep:
        literal = step.literal
        atoms = self._atoms(literal)
        tests = _tests(literal, atoms)
        what = _named_atoms(atoms)
        if step.access in (Access.MEMBER, Access.GET):
            why = "it can only lose rows"
        elif first:
            why = "fewest rows to begin with"
        else:
            why = "fewest further rows"
        return PlannedStep(what, _how(step), why, step.estimate, atoms, tests)

    def _atoms(self, literal: Literal) -> tuple[Atom, ...]:
        """Give the conditions that a literal stands for, or the attributes it adds to one."""
        if literal.places:
            return tuple(self._positive[place] for place in sorted(literal.places))
        assert isinstance(literal.relation, View)
        name, *values = literal.terms
        attributes = tuple(zip(literal.relation.cells, values, strict=True))
        return (Atom(literal.relation.type, (name,), attributes),)

    def _absent(self, step: Absent) -> PlannedStep:
        atom = step.negation.atom
        relation, terms = step.negation.relation, step.negation.terms
        how = _access(step.access, step.bound, relation, terms)
        why = "as soon as its variables are bound"
        return PlannedStep(f"(not {atom})", how, why, None, (atom,), (), negated=True)


def _named_atoms(atoms: Sequence[Atom]) -> str:
    """Write a condition as it stands; of two that a kernel joins only whose pairs they are."""
    if len(atoms) == 1:
        return str(atoms[0])
    return "pairs of " + " and ".join(str(Atom(each.predicate, each.args)) for each in atoms)


def _tests(literal: Literal, atoms: Sequence[Atom]) -> tuple[Call, ...]:
    """Give the tests that a relation has taken over from its clause."""
    relation = literal.relation
    if isinstance(relation, View):
        return relation.tests
    if isinstance(relation, Pairs) and len(atoms) == 2:  # else they are those of another clause
        apart = (Call("/=", literal.terms),) if relation.distinct else ()
        return (*apart, *relation.left.tests, *relation.right.tests, *relation.tests)
    return ()


def _how(step: Find) -> str:
    literal = step.literal
    if isinstance(literal.relation, Pairs):
        match step.access:
            case Access.SCAN:
                return "all pairs in its numeric kernel"
            case Access.MEMBER:
                return "is the pair in its numeric kernel?"
            case _:
                by = _named(step.bound, literal.terms)
                return f"by {by}, a row or column of its numeric kernel"
    if not literal.places:
        return f"further attributes of {literal.terms[0]}, by its name"
    return _access(step.access, step.bound, literal.relation, literal.terms)


def _access(access: Access, bound: Sequence[int], relation: Relation, terms: Sequence[Term]) -> str:
    match access:
        case Access.SCAN:
            return "all of them"
        case Access.MEMBER:
            return "is it there? Looked up whole"
        case Access.GET:
            return f"by {_named(bound[: relation.keys], terms)}: at most one"
        case Access.INDEX:
            cells = " and ".join(_cell(cell, relation) for cell in bound)
            return f"by {_named(bound, terms)}, through a hash index on {cells}"


def _named(bound: Sequence[int], terms: Sequence[Term]) -> str:
    return " and ".join(str(terms[cell]) for cell in bound)


def _cell(cell: int, relation: Relation) -> str:
    if isinstance(relation, Facts) and cell < relation.arity:
        return f"argument {cell + 1}"
    if isinstance(relation, Pairs):
        return f"argument {cell + 1}"
    if cell < relation.keys:
        return "the name"
    return f"^{relation.cells[cell - relation.keys]}"
