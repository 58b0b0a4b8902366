"""What a skill does to the attachment hierarchy, worked out from its clause and the rules."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from icarus_lite.language.syntax import Atom, Domain, SkillClause, Term, Variable
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED


@dataclass(frozen=True, slots=True)
class Attaching:
    """A child gets a parent."""

    child: Term
    parent: Term


@dataclass(frozen=True, slots=True)
class Detaching:
    """A bond ends; None stands for every child, or whatever parent."""

    child: Term | None
    parent: Term | None


@dataclass(frozen=True, slots=True)
class Unclear:
    """A rule that fits the skill only for some of its arguments."""

    pattern: Atom


def bonds(domain: Domain, clause: SkillClause) -> Iterator[Attaching | Detaching | Unclear]:
    """Give what the attachment rules do when a skill has succeeded, in their order."""
    for rule in domain.attachments:
        found = _unify(rule.attach, clause.head)
        if isinstance(found, Unclear):
            yield found
        elif found is not None:
            yield Attaching(_resolve(rule.child, found), _resolve(rule.parent, found))
        if found is not None or rule.until is None:
            continue
        found = _unify(rule.until, clause.head)
        if isinstance(found, Unclear):
            yield found
        elif found is not None:
            yield Detaching(_free(rule.child, found), _free(rule.parent, found))


def attachings(domain: Domain, clause: SkillClause) -> tuple[Attaching, ...]:
    """Give every bond that a skill makes, by a rule or by an effect."""
    stated = [e.atom for e in clause.effects if not e.negated and e.atom.predicate == ATTACHED]
    explicit = [Attaching(*atom.args) for atom in stated if len(atom.args) == 2]
    made = [each for each in bonds(domain, clause) if isinstance(each, Attaching)]
    return (*explicit, *made)


def _unify(pattern: Atom, head: Atom) -> dict[str, Term] | Unclear | None:
    """Bind the variables of a rule to the terms of a skill's head; None if it never fits."""
    if pattern.predicate != head.predicate or len(pattern.args) != len(head.args):
        return None
    bound: dict[str, Term] = {}
    for ours, theirs in zip(pattern.args, head.args, strict=True):
        known = bound.setdefault(ours.name, theirs) if isinstance(ours, Variable) else ours
        if known == theirs:
            continue
        if isinstance(known, Variable) or isinstance(theirs, Variable):
            return Unclear(pattern)
        return None
    return bound


def _resolve(term: Term, bound: dict[str, Term]) -> Term:
    return bound[term.name] if isinstance(term, Variable) else term


def _free(term: Term, bound: dict[str, Term]) -> Term | None:
    return bound.get(term.name) if isinstance(term, Variable) else term


def may_circle(pairs: Sequence[tuple[object, object]]) -> bool:
    """Tell whether bonds between these children and parents could ever form a circle."""
    above: dict[object, list[object]] = {}
    for child, parent in pairs:
        above.setdefault(child, []).append(parent)
    done: set[object] = set()
    for start, first in above.items():
        trail: list[tuple[object, Iterator[object]]] = [(start, iter(first))]
        on_trail = {start}
        while trail:
            node, rest = trail[-1]
            following = next(rest, None)
            if following is None:
                trail.pop()
                on_trail.discard(node)
                done.add(node)
            elif following in on_trail:
                return True
            elif following not in done:
                trail.append((following, iter(above.get(following, ()))))
                on_trail.add(following)
    return False
