"""Percept types and their subtypes: `(part :is object ^grip)`.

A subtype has the attributes of its supertype besides its own. Its percepts match the patterns of
the supertype, so that a concept about objects need not know what kinds of object there are.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from icarus_lite.language.checking.report import Report
from icarus_lite.language.syntax import PerceptType

MAX_LINEAGE = 20
"""How many types a percept may belong to."""


def lineages(types: Iterable[PerceptType]) -> Mapping[str, tuple[str, ...]]:
    """Give each percept type with all types that its percepts belong to, its own first.

    A chain that leads back to itself or to a type that is not declared ends there, and so does one
    that is longer than `MAX_LINEAGE`: the checker refuses such domains.
    """
    supertypes: dict[str, str | None] = {}
    for each in types:
        supertypes.setdefault(each.name, each.supertype)
    chains: dict[str, tuple[str, ...]] = {}
    for name, supertype in supertypes.items():
        chain: dict[str, None] = {name: None}
        above = supertype
        while above in supertypes and above not in chain and len(chain) < MAX_LINEAGE:
            chain[above] = None
            above = supertypes[above]
        chains[name] = tuple(chain)
    return chains


def inherited_attributes(types: Iterable[PerceptType]) -> Mapping[str, tuple[str, ...]]:
    """Give each percept type with its attributes, those of its supertypes first."""
    types = tuple(types)
    own: dict[str, tuple[str, ...]] = {}
    for each in types:
        own.setdefault(each.name, each.attributes)
    return {
        name: tuple(dict.fromkeys([a for each in reversed(chain) for a in own[each]]))
        for name, chain in lineages(types).items()
    }


def check_percept_types(types: Iterable[PerceptType], report: Report) -> None:
    """Report percept types and attributes declared twice, and supertypes that cannot be."""
    types = tuple(types)
    first: dict[str, PerceptType] = {}
    for each in types:
        if each.name in first:
            message = f"the percept type `{each.name}` is declared twice"
            hint = f"it is declared in {first[each.name].span.in_line} already; merge the two"
            report.error(each.span, "ICR011", message, hint)
        first.setdefault(each.name, each)
    chains = lineages(types)
    for each in types:
        seen: set[str] = set()
        for name in each.attributes:
            if name in seen:
                message = f"the attribute `^{name}` is declared twice"
                report.error(each.span, "ICR011", message, "remove one of them")
            seen.add(name)
        if each.supertype is not None and first[each.name] is each:
            _check_supertype(each, each.supertype, first, chains, report)


def _check_supertype(
    each: PerceptType,
    supertype: str,
    first: Mapping[str, PerceptType],
    chains: Mapping[str, tuple[str, ...]],
    report: Report,
) -> None:
    if supertype not in first:
        message = f"`{each.name}` is said to be a kind of `{supertype}`, which is not declared"
        meant = report.closest(supertype, first)
        hint = f"did you mean `{meant}`?" if meant else f"declare it: ({supertype} ^type ^x ^y)"
        report.error(each.span, "ICR039", message, hint)
        return
    if each.name == supertype or each.name in chains[supertype]:
        circle = [each.name, *chains[supertype]]
        circle = circle[: circle.index(each.name, 1) + 1]
        if next(name for name in first if name in circle) != each.name:
            return  # told of already, where the first of them is declared
        message = f"`{each.name}` is made a kind of itself: {' -> '.join(circle)}"
        report.error(each.span, "ICR039", message, "remove one of these :is")
        return
    if len(chains[supertype]) == MAX_LINEAGE:
        message = f"`{each.name}` stands under more than {MAX_LINEAGE - 1} other percept types"
        report.error(each.span, "ICR039", message, "leave out those that no pattern asks for")
        return
    for above in chains[each.name][1:]:
        for name in sorted(set(each.attributes) & set(first[above].attributes)):
            message = f"`{each.name}` has the attribute `^{name}` from `{above}` already"
            report.error(each.span, "ICR011", message, f"remove it here: a {each.name} has it too")
