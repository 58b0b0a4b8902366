"""The design of a network: every clause taken apart, every predicate with its way to be kept."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from enum import StrEnum

from icarus_lite.errors import InferenceError
from icarus_lite.inference.network.bodies import Body, Literal, Negation, body_of
from icarus_lite.inference.network.generation.naming import Names, identifier
from icarus_lite.inference.network.ordering import Access, access_to, bound_cells, expected_sizes
from icarus_lite.inference.network.relations import Facts, Pairs, Relation
from icarus_lite.inference.network.vocabulary import Vocabulary
from icarus_lite.language.syntax import ConceptClause, Domain, Variable, variables_of
from icarus_lite.records import dataclass, replace


class Keeping(StrEnum):
    """How the beliefs of a concept are kept up to date."""

    PAIRS = "pairs"  # a numeric kernel is its store
    UNIQUE = "unique"  # each belief has at most one derivation: it is there or not
    COUNTED = "counted"  # the number of derivations of each belief
    ATTRIBUTED = "attributed"  # derivations by the attributes they give, and the one that decides
    RECURSIVE = "recursive"  # delete and prove again
    RECOMPUTED = "recomputed"  # recursion that computes attributes: from scratch when touched


@dataclass(frozen=True, slots=True)
class Head:
    """A concept, with one number of arguments, and how it is kept.

    Args:
        number: Its place among all heads, bottom first.
        facts: Its relation.
        keeping: How its beliefs are kept.
        bodies: Its clauses, taken apart.
        component: The number of the group of heads that are inferred together.
        relation: What holds its rows: `facts`, or the pairs of a kernel.
    """

    number: int
    facts: Facts
    keeping: Keeping
    bodies: tuple[Body, ...]
    component: int
    relation: Relation

    @property
    def attributes(self) -> tuple[str, ...]:
        """The names of the attributes that some clause gives."""
        names = (name for body in self.bodies for name, _ in body.clause.head.attributes)
        return tuple(dict.fromkeys(names))


@dataclass(frozen=True, slots=True)
class Design:
    """What is generated from.

    Args:
        domain: The domain.
        vocabulary: Its predicates.
        bodies: All clauses taken apart, as written.
        heads: The concepts, bottom first.
        relations: Every relation that is looked up in, each with its identifier.
        sizes: How many rows each is expected to have.
    """

    domain: Domain
    vocabulary: Vocabulary
    bodies: tuple[Body, ...]
    heads: tuple[Head, ...]
    relations: tuple[Relation, ...]
    sizes: Mapping[Relation, float]


def design_of(domain: Domain, vocabulary: Vocabulary) -> Design:
    """Design the network of a domain.

    Raises:
        InferenceError: a variable of a head is never bound.
    """
    for clause in domain.concepts:
        _check_head(clause)
    bodies = tuple(
        body_of(clause, number, vocabulary) for number, clause in enumerate(domain.concepts)
    )
    backing = _backing(bodies, vocabulary)
    bodies = tuple(_with_backing(body, backing) for body in bodies)
    named = _Naming(domain)
    bodies = tuple(_named(body, named) for body in bodies)
    heads = _heads(bodies, vocabulary, backing, named)
    levels = {body.number: head.number for head in heads for body in head.bodies}
    ascending = sorted(bodies, key=lambda body: levels[body.number])
    return Design(domain, vocabulary, bodies, heads, named.relations(), expected_sizes(ascending))


def place_of(clause: ConceptClause, domain: Domain) -> str:
    """Say where a clause stands: `domains/cell.icr:31`."""
    path = clause.span.path or domain.source.path
    return f"{path}:{clause.span.line}" if clause.span.line else path


def _check_head(clause: ConceptClause) -> None:
    bound = {v for c in clause.elements if not c.negated for v in c.atom.variables}
    bound |= {bind.variable.name for bind in clause.binds}
    if not bound.issuperset(clause.head.variables):
        raise InferenceError(f"a variable of the head {clause.head} is never bound")


def _backing(bodies: Sequence[Body], vocabulary: Vocabulary) -> dict[Facts, Pairs]:
    """Find the concepts that are nothing but a numeric pair rule: its kernel is their store.

    Not so where a clause looks at the relation twice, or asks that there be no pair with some
    object: then changes must be shown one by one, which takes a store of its own.
    """
    by_head: dict[Facts, list[Body]] = {}
    for body in bodies:
        head = body.clause.head
        by_head.setdefault(Facts(head.predicate, len(head.args)), []).append(body)
    backing = {}
    for facts, (body, *others) in by_head.items():
        clause = body.clause
        literal = body.literals[0] if len(body.literals) == 1 else None
        if (
            not others
            and literal is not None
            and isinstance(literal.relation, Pairs)
            and not (body.negations or body.tests or clause.binds)
            and clause.head.args == literal.terms
            and not vocabulary.is_attributed(clause.head.predicate)
        ):
            backing[facts] = literal.relation
    while True:
        changed = {relation for body in bodies for relation in _unsuitable(body, backing)}
        if not changed:
            return backing
        backing = {f: pairs for f, pairs in backing.items() if pairs not in changed}


def _unsuitable(body: Body, backing: Mapping[Facts, Pairs]) -> set[Pairs]:
    counts: Counter[Pairs] = Counter()
    found: set[Pairs] = set()
    positive = {v for each in body.literals for t in each.terms for v in variables_of(t)}
    conditions: list[Literal | Negation] = [*body.literals, *body.negations]
    for each in conditions:
        pairs = _backed(each.relation, backing)
        if not isinstance(pairs, Pairs):
            continue
        counts[pairs] += 1
        if isinstance(each, Negation):
            bound = bound_cells(each.terms, positive)
            if access_to(pairs, bound) is not Access.MEMBER:
                found.add(pairs)
    return found | {pairs for pairs, count in counts.items() if count > 1}


def _backed(relation: Relation, backing: Mapping[Facts, Pairs]) -> Relation:
    return backing.get(relation, relation) if isinstance(relation, Facts) else relation


def _with_backing(body: Body, backing: Mapping[Facts, Pairs]) -> Body:
    literals = tuple(replace(e, relation=_backed(e.relation, backing)) for e in body.literals)
    negations = tuple(replace(e, relation=_backed(e.relation, backing)) for e in body.negations)
    return replace(body, literals=literals, negations=negations)


def _named(body: Body, named: _Naming) -> Body:
    head = body.clause.head.predicate
    return replace(
        body,
        literals=tuple(replace(e, relation=named(e.relation, head)) for e in body.literals),
        negations=tuple(replace(e, relation=named(e.relation, head)) for e in body.negations),
    )


class _Naming:
    """Gives each relation its identifier, the same for equal ones."""

    def __init__(self, domain: Domain) -> None:
        variables = {
            identifier(name)
            for clause in domain.concepts
            for atom in (clause.head, *(c.atom for c in clause.elements))
            for name in atom.variables
        }
        self._names = Names(variables)
        self._known: dict[Relation, Relation] = {}

    def __call__(self, relation: Relation, head: str = "") -> Relation:
        known = self._known.get(relation)
        if known is None:
            known = replace(relation, name=self._names.fresh(_wanted(relation, head)))
            self._known[relation] = known
        return known

    def relations(self) -> tuple[Relation, ...]:
        return tuple(self._known.values())


def _wanted(relation: Relation, head: str) -> str:
    if isinstance(relation, Pairs):
        return f"{identifier(head)}_pairs"
    if isinstance(relation, Facts):
        return "_".join(map(identifier, (relation.predicate, *relation.cells)))
    words = [relation.type, *relation.cells]
    words += [str(value) for _, value in relation.constants]
    if relation.tests:
        words.append(f"for_{head}")
    return "_".join(map(identifier, (*words, *relation.required))) + "_seen"


def _heads(
    bodies: Iterable[Body],
    vocabulary: Vocabulary,
    backing: Mapping[Facts, Pairs],
    named: _Naming,
) -> tuple[Head, ...]:
    by_concept: dict[str, dict[Facts, list[Body]]] = {}
    for body in bodies:
        head = body.clause.head
        facts = Facts(head.predicate, len(head.args))
        by_concept.setdefault(head.predicate, {}).setdefault(facts, []).append(body)
    heads: list[Head] = []
    for component, layer in enumerate(vocabulary.layers):
        attributed = any(vocabulary.is_attributed(concept) for concept in layer)
        for concept in layer:
            for facts, own in by_concept[concept].items():
                if facts in backing:
                    keeping, relation = Keeping.PAIRS, named(backing[facts])
                else:
                    keeping = _keeping(concept, own, vocabulary, attributed=attributed)
                    relation = named(facts)
                heads.append(
                    Head(len(heads), named(facts), keeping, tuple(own), component, relation)  # type: ignore[arg-type] # the same kind comes back
                )
    return tuple(heads)


def _keeping(
    concept: str, bodies: Sequence[Body], vocabulary: Vocabulary, *, attributed: bool
) -> Keeping:
    if concept in vocabulary.recursive:
        return Keeping.RECOMPUTED if attributed else Keeping.RECURSIVE
    if vocabulary.is_attributed(concept):
        return Keeping.ATTRIBUTED
    alone = len(bodies) == 1 and _is_unique(bodies[0])
    return Keeping.UNIQUE if alone else Keeping.COUNTED


def _is_unique(body: Body) -> bool:
    """Tell whether a belief determines the rows that it was derived from."""
    binds = {bind.variable.name for bind in body.clause.binds}
    known = {t.name for t in body.clause.head.args if isinstance(t, Variable)} - binds
    waiting: list[Literal] = list(body.literals)
    while waiting:
        settled = [
            each
            for each in waiting
            if all(v in known for t in each.terms[: each.relation.keys] for v in variables_of(t))
        ]
        if not settled:
            return False
        for each in settled:
            waiting.remove(each)
            known.update(v for t in each.terms for v in variables_of(t))
    return True
