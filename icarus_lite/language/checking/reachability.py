"""Goals that no skill can ever change, by predicate and sign alone.

Skills change what their effects and the attachments say, and every concept whose definition rests
on such a literal. A goal outside of this is out of reach of any plan, whatever the situation.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TypeAlias

from icarus_lite.language.checking.report import Report
from icarus_lite.language.checking.vocabulary import Vocabulary
from icarus_lite.language.syntax import Condition, Domain
from icarus_lite.symbols import ATTACHED

_Sign: TypeAlias = tuple[str, bool]  # a predicate, and whether it becomes true or false


def check_reachability(domain: Domain, names: Vocabulary, report: Report) -> None:
    """Warn of goals that no skill can bring about; a domain without skills only observes."""
    if not domain.skills:
        return
    changeable = changeable_signs(domain)
    given = {str(fact) for task in domain.tasks for fact in task.init}
    for goal in _goals(domain):
        name = goal.atom.predicate
        if (name, not goal.negated) in changeable or name not in names.predicates:
            continue
        if goal.negated:
            message = f"no skill can ever end {goal.atom}"
            hint = f"a skill that ends it says so: :effects ({goal})"
            report.note(goal.span, "ICR045", message, hint)
        elif str(goal.atom) not in given:
            message = f"no skill can ever make {goal.atom} true"
            hint = f"the skill that brings it about must say so: :effects ({goal.atom}), or state "
            hint += "what its definition rests on"
            report.warning(goal.span, "ICR045", message, hint)


def changeable_signs(domain: Domain) -> frozenset[_Sign]:
    """Give every predicate with each truth value that some skill can lead to."""
    rests_on: dict[_Sign, list[_Sign]] = {}
    for concept in domain.concepts:
        for element in concept.elements:
            for becomes in (True, False):
                sign = (element.atom.predicate, becomes is not element.negated)
                rests_on.setdefault(sign, []).append((concept.head.predicate, becomes))
    found: set[_Sign] = set()
    queue = list(_direct_signs(domain))
    while queue:
        sign = queue.pop()
        if sign not in found:
            found.add(sign)
            queue += rests_on.get(sign, ())
    return frozenset(found)


def _direct_signs(domain: Domain) -> Iterator[_Sign]:
    for skill in domain.skills:
        for effect in skill.effects:
            yield effect.atom.predicate, not effect.negated
    if domain.attachments:  # also those by actions of others, which are only observed
        yield ATTACHED, True
        yield ATTACHED, False  # a new parent replaces the old one


def _goals(domain: Domain) -> Iterable[Condition]:
    for task in domain.tasks:
        yield from task.goals
    yield from domain.goals
    for goal in domain.long_term_goals:
        yield from goal.goals
