"""Contradictions: they end what persists, and nothing else.

What concepts derive, or perception reports, is decided anew in each cycle: there is nothing to be
withdrawn. What an action asserted, or `:init` gave, stays until something ends it.
"""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.language.checking.patterns import Patterns
from icarus_lite.language.checking.report import Report
from icarus_lite.language.checking.variables import check_contradiction_variables
from icarus_lite.language.checking.vocabulary import Definition, Origin, Vocabulary
from icarus_lite.language.syntax import Atom, Domain

_LASTING = (Origin.EFFECT, Origin.GIVEN, Origin.ATTACHMENT)


def check_contradictions(
    domain: Domain, names: Vocabulary, patterns: Patterns, report: Report
) -> None:
    """Check heads, conditions and variables of the contradictions of a domain.

    Args:
        domain: The domain.
        names: The names that it defines.
        patterns: Checks its patterns.
        report: Where findings go.
    """
    for clause in domain.contradictions:
        definitions = names.predicates.get(clause.head.predicate, ())
        if _persists(clause.head, definitions, names, report):
            patterns.pattern(clause.head)
        patterns.conditions(clause.elements)
        check_contradiction_variables(clause, report)


def _persists(
    head: Atom, definitions: Sequence[Definition], names: Vocabulary, report: Report
) -> bool:
    """Tell whether beliefs like the head can persist; if they cannot, say why."""
    name, place = head.predicate, report.name_of(head)
    origins = {each.origin for each in definitions}
    if Origin.CONCEPT in origins:
        message = f"`{name}` is a concept: what is derived cannot be withdrawn"
        hint = "withdraw what it rests on, or let its own clauses ask for less"
    elif Origin.PERCEPT in origins:
        message = f"`{name}` is perceived: only perception adds or removes it"
        hint = "withdraw what an action has asserted, or `attached`"
    elif origins.intersection(_LASTING):
        return True
    else:
        message = f"no action asserts `{name}`: there is nothing to withdraw"
        known = [each for each, found in names.predicates.items() if _lasts(found)]
        meant = report.closest(name, known)
        hint = "assert it by an effect, or withdraw what effects assert, or `attached`"
        if name in names.skills:
            hint = "it is a skill; withdraw what its success asserts"
        elif meant:
            hint = f"did you mean `{meant}`?"
        report.error(place, "ICR013", message, hint, label="nothing that persists")
        return False
    report.error(place, "ICR050", message, hint)
    return False


def _lasts(definitions: Sequence[Definition]) -> bool:
    return all(each.origin in _LASTING for each in definitions)
