"""What can never be: concepts true, skills started, contradictions in force; idle effects.

A concept can be true if some clause of it asks, positively, only for what is perceived, given,
asserted by an effect, or can itself be true. What is left over can never be believed, whatever the
percepts: mostly a recursion without a case in which it begins.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator

from icarus_lite.language.checking.report import Report
from icarus_lite.language.checking.vocabulary import Origin, Vocabulary
from icarus_lite.language.syntax import (
    Atom,
    ConceptClause,
    Condition,
    Contradiction,
    Domain,
    SkillClause,
)
from icarus_lite.symbols import ATTACHED

_BASE = (Origin.PERCEPT, Origin.GIVEN)


def check_possibility(domain: Domain, names: Vocabulary, report: Report) -> None:
    """Warn of concepts that can never be true, and of skills and contradictions likewise."""
    _Possibility(domain, names, report).check()


def check_effects(domain: Domain, names: Vocabulary, report: Report) -> None:
    """Warn of effects on percepts: only perception adds or removes those."""
    for skill in domain.skills:
        for effect in skill.effects:
            origins = {each.origin for each in names.predicates.get(effect.atom.predicate, ())}
            if Origin.PERCEPT in origins and Origin.CONCEPT not in origins:
                name = effect.atom.predicate
                message = f"the effect speaks of `{name}`, which only perception adds or removes"
                hint = "assert a belief instead, such as (moved ?obj), or leave it out: what is "
                hint += "perceived will show"
                report.warning(report.name_of(effect.atom), "ICR042", message, hint)


class _Possibility:
    """One analysis of one domain."""

    def __init__(self, domain: Domain, names: Vocabulary, report: Report) -> None:
        self._domain = domain
        self._report = report
        self._names = names
        self._clauses: dict[str, list[ConceptClause]] = {}
        for clause in domain.concepts:
            self._clauses.setdefault(clause.head.predicate, []).append(clause)
        self._never = self._find_impossible()

    def check(self) -> None:
        """Report each impossible concept, except where another one is to blame."""
        blockers = {name: self._blockers(name) for name in self._never if name in self._clauses}
        users: dict[str, list[str]] = {}
        for name, needed in blockers.items():
            for each in needed:
                users.setdefault(each, []).append(name)
        explained: set[str] = set()
        roots = [name for name, needed in blockers.items() if needed <= {name, ATTACHED}]
        for name in roots:
            self._report_concept(name, blockers[name])
            _spread(name, users, explained)
        for name, needed in blockers.items():
            if name not in explained:
                self._report_concept(name, needed)
                _spread(name, users, explained)
        for skill in self._domain.skills:
            self._check_skill(skill)
        for clause in self._domain.contradictions:
            self._check_contradiction(clause)

    def _find_impossible(self) -> dict[str, None]:
        """Give the predicates that can never be true, in the order of their definition."""
        possible = {name for name in self._names.predicates if self._is_base(name)}
        waiting: dict[str, list[tuple[str, set[str]]]] = {}
        queue: deque[str] = deque()
        for name, clauses in self._clauses.items():
            for clause in clauses:
                needed = set(self._needs(clause.elements)) - possible
                if _contradiction(clause.elements) is not None:
                    continue
                if not needed:
                    queue.append(name)
                for each in needed:
                    waiting.setdefault(each, []).append((name, needed))
        while queue:
            name = queue.popleft()
            if name in possible:
                continue
            possible.add(name)
            for head, needed in waiting.get(name, ()):
                needed.discard(name)
                if not needed:
                    queue.append(head)
        defined = (*self._clauses, ATTACHED)
        return dict.fromkeys(name for name in defined if name not in possible)

    def _is_base(self, name: str) -> bool:
        origins = {each.origin for each in self._names.predicates[name]}
        if origins.intersection(_BASE):
            return True
        if name == ATTACHED:
            return bool(self._domain.attachments) or any(
                effect.atom.predicate == ATTACHED and not effect.negated
                for skill in self._domain.skills
                for effect in skill.effects
            )
        return Origin.EFFECT in origins and Origin.CONCEPT not in origins

    def _needs(self, conditions: Iterable[Condition]) -> Iterator[str]:
        """Give the known predicates that conditions ask for positively."""
        for condition in conditions:
            atom = condition.atom
            if condition.negated or atom.predicate not in self._names.predicates:
                continue  # what is unknown is reported as such
            if atom.attributes and not self._domain.percepts:
                continue  # taken to be perceived
            yield atom.predicate

    def _blockers(self, name: str) -> set[str]:
        return {
            each
            for clause in self._clauses[name]
            for each in self._needs(clause.elements)
            if each in self._never
        }

    def _report_concept(self, name: str, blockers: set[str]) -> None:
        first = self._clauses[name][0]
        place = self._report.name_of(first.head)
        clash = next(
            (atom for clause in self._clauses[name] if (atom := _contradiction(clause.elements))),
            None,
        )
        opening = f"`{name}` can never be true: "
        if ATTACHED in blockers and name != ATTACHED:
            message = f"{opening}it needs `attached`, and nothing ever attaches anything"
            hint = "say which action attaches what: (attachments ((pick-up ?hand ?obj) …))"
        elif name in blockers:
            message = f"{opening}every clause of it needs `{name}` itself"
            hint = "add a clause for the case in which it begins, one without the recursion"
        elif blockers:
            other = min(blockers)
            message = f"{opening}it needs `{other}`, which needs `{name}` in turn"
            hint = "add a clause for the case in which it begins, one without the recursion"
        else:
            message = f"{opening}it asks both for {clash} and for its negation"
            hint = "remove one of the two, or rename a variable"
        self._report.warning(place, "ICR041", message, hint)

    def _check_skill(self, skill: SkillClause) -> None:
        name = skill.head.predicate
        clash = _contradiction(skill.elements)
        if clash is not None:
            message = f"`{name}` can never start: it asks both for {clash} and for its negation"
            hint = "remove one of the two, or rename a variable"
            self._report.warning(self._report.name_of(skill.head), "ICR041", message, hint)
        elif ATTACHED in self._never and ATTACHED in self._needs(skill.elements):
            message = f"`{name}` can never start: nothing ever attaches anything"
            hint = "say which action attaches what: (attachments ((pick-up ?hand ?obj) …))"
            self._report.warning(self._report.name_of(skill.head), "ICR041", message, hint)

    def _check_contradiction(self, clause: Contradiction) -> None:
        head, opening = clause.head, f"the contradiction of `{clause.head.predicate}` never holds: "
        needed = {head.predicate, *self._needs(clause.elements)}
        clash = _contradiction((Condition(head), *clause.elements))
        if clash == head:
            message = f"{opening}it asks for the negation of what it withdraws"
            hint = "say what goes together with it and should not"
        elif clash is not None:
            message = f"{opening}it asks both for {clash} and for its negation"
            hint = "remove one of the two, or rename a variable"
        elif ATTACHED in self._never and ATTACHED in needed:
            message = f"{opening}nothing ever attaches anything"
            hint = "say which action attaches what: (attachments ((pick-up ?hand ?obj) …))"
        else:
            return
        self._report.warning(self._report.name_of(head), "ICR041", message, hint)


def _contradiction(conditions: Iterable[Condition]) -> Atom | None:
    """Give a pattern that is asked for both positively and inside `not`, or None."""
    conditions = tuple(conditions)
    positive = {str(each.atom) for each in conditions if not each.negated}
    return next((c.atom for c in conditions if c.negated and str(c.atom) in positive), None)


def _spread(name: str, users: dict[str, list[str]], explained: set[str]) -> None:
    """Mark a concept, and all that can never be true because of it."""
    queue = [name]
    while queue:
        each = queue.pop()
        if each not in explained:
            explained.add(each)
            queue += users.get(each, ())
