"""What a skill does to the attachment hierarchy, read from the domain before anything is ground."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from icarus_lite.language.syntax import Atom, Constant, Domain, SkillClause, Term, Variable
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED, Value

Pair = tuple[Value, Value]
"""Child and parent."""


@dataclass(frozen=True, slots=True)
class Attach:
    """The child goes with the parent from now on."""

    child: Value
    parent: Value


@dataclass(frozen=True, slots=True)
class Detach:
    """The child goes with the parent no longer; None stands for any."""

    child: Value | None
    parent: Value | None


HierarchyEvent = Attach | Detach


@dataclass(frozen=True, slots=True)
class _Way:
    """An attach or detach pattern of a rule, laid upon the head of a skill.

    Args:
        equal: Pairs of terms that must agree for the pattern to fit.
        child: Who is attached or detached; None for any.
        parent: To or from whom.
    """

    equal: tuple[tuple[Term, Term], ...]
    child: Term | None
    parent: Term | None

    def fits(self, bindings: Mapping[str, Value]) -> bool:
        return all(_value(one, bindings) == _value(two, bindings) for one, two in self.equal)


class Attaching:
    """What one skill clause does to the hierarchy.

    Removing effects on `attached` are not part of it: they are ordinary removals, and come first.

    Source: Liang et al. 2021, Algorithm 1, lines 2-9.
    """

    __slots__ = ("_effects", "_rules")

    def __init__(self, domain: Domain, clause: SkillClause) -> None:
        self._effects = tuple(
            effect.atom
            for effect in clause.effects
            if not effect.negated and effect.atom.predicate == ATTACHED
        )
        rules: list[tuple[_Way | None, _Way | None]] = []
        for rule in domain.attachments:
            attach = _lay(rule.attach, clause.head, rule.child, rule.parent)
            detach = _lay(rule.until, clause.head, rule.child, rule.parent)
            if attach is not None or detach is not None:
                rules.append((attach, detach))
        self._rules: Sequence[tuple[_Way | None, _Way | None]] = tuple(rules)

    def __bool__(self) -> bool:
        return bool(self._effects or self._rules)

    def events(self, bindings: Mapping[str, Value]) -> Iterator[HierarchyEvent]:
        """Give what an instance of the clause does, in order."""
        for atom in self._effects:
            child, parent = (_value(term, bindings) for term in atom.args)
            if child is not None and parent is not None:
                yield Attach(child, parent)
        for attach, detach in self._rules:
            if attach is not None and attach.fits(bindings):
                child, parent = _value(attach.child, bindings), _value(attach.parent, bindings)
                if child is not None and parent is not None:
                    yield Attach(child, parent)
            elif detach is not None and detach.fits(bindings):
                yield Detach(_value(detach.child, bindings), _value(detach.parent, bindings))

    def pairs(self, bindings: Mapping[str, Value]) -> Iterator[Pair]:
        """Give the attachments that an instance of the clause may make."""
        for event in self.events(bindings):
            if isinstance(event, Attach) and event.child != event.parent:
                yield event.child, event.parent


def _lay(pattern: Atom | None, head: Atom, child: Term, parent: Term) -> _Way | None:
    """Lay a pattern of an attachment rule upon the head of a skill; None if it cannot fit."""
    if pattern is None or pattern.predicate != head.predicate:
        return None
    if len(pattern.args) != len(head.args):
        return None
    terms: dict[str, Term] = {}
    equal: list[tuple[Term, Term]] = []
    for wanted, given in zip(pattern.args, head.args, strict=True):
        known = terms.setdefault(wanted.name, given) if isinstance(wanted, Variable) else wanted
        if isinstance(known, Constant) and isinstance(given, Constant):
            if known.value != given.value:
                return None
        elif known != given:
            equal.append((known, given))

    def own(term: Term) -> Term | None:
        return terms.get(term.name) if isinstance(term, Variable) else term

    return _Way(tuple(equal), own(child), own(parent))


def _value(term: Term | None, bindings: Mapping[str, Value]) -> Value | None:
    if term is None:
        return None
    return bindings.get(term.name) if isinstance(term, Variable) else term.value
