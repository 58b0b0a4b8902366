"""PDDL written out: one section after another, one condition a line, the place of origin above."""

from __future__ import annotations

from collections.abc import Iterable

from icarus_lite.language.pddl.syntax import (
    And,
    Effect,
    Equal,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    PddlAction,
    PddlDomain,
    PddlProblem,
    Rule,
    Typed,
)

_WIDTH = 100


def write_domain(domain: PddlDomain, remarks: Iterable[str] = ()) -> str:
    """Write a PDDL domain, with remarks as comments at its beginning."""
    lines = [*(f"; {remark}" for remark in remarks), f"(define (domain {domain.name})"]
    lines += _section(":requirements", requirements(domain))
    if domain.types:
        lines += _section(":types", _typed(domain.types))
    if domain.constants:
        lines += _section(":constants", _typed(domain.constants))
    declared = [f"({' '.join([p.name, *_typed(p.parameters)])})" for p in domain.predicates]
    lines += _section(":predicates", declared)
    for rule in domain.rules:
        lines += ["", *_rule(rule)]
    for action in domain.actions:
        lines += ["", *_action(action)]
    return "\n".join([*lines, ")", ""])


def write_problem(problem: PddlProblem, remarks: Iterable[str] = ()) -> str:
    """Write a PDDL problem, with remarks as comments at its beginning."""
    lines = [*(f"; {remark}" for remark in remarks), f"(define (problem {problem.name})"]
    lines.append(f"  (:domain {problem.domain})")
    lines += _section(":objects", _typed(problem.objects))
    lines += _section(":init", [_formula(fact) for fact in problem.init])
    lines += _lines("  (:goal ", problem.goal, 4)
    lines[-1] += ")"
    return "\n".join([*lines, ")", ""])


def requirements(domain: PddlDomain) -> tuple[str, ...]:
    """Give the requirements that the text of a domain makes necessary."""
    formulas = [rule.body for rule in domain.rules] + [a.precondition for a in domain.actions]
    parts = [part for each in formulas for part in _parts(each)]
    effects = [effect for action in domain.actions for effect in action.effects]
    found = [":strips", ":typing"]
    if any(isinstance(part, Not) for part in parts):
        found.append(":negative-preconditions")
    if any(isinstance(part, Or) for part in parts):
        found.append(":disjunctive-preconditions")
    if any(isinstance(part, Exists) for part in parts):
        found.append(":existential-preconditions")
    if any(isinstance(part, Equal) for part in parts):
        found.append(":equality")
    if any(effect.every for effect in effects):
        found.append(":conditional-effects")  # the one that PDDL 2.1 puts universal effects under
    if domain.rules:
        found.append(":derived-predicates")
    return tuple(found)


def _parts(formula: Formula) -> Iterable[Formula]:
    yield formula
    match formula:
        case Not(part) | Exists(_, part):
            yield from _parts(part)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _parts(part)


def _section(keyword: str, entries: Iterable[str]) -> list[str]:
    lines = [f"  ({keyword}"]
    for entry in entries:
        if len(lines[-1]) + len(entry) + 1 > _WIDTH:
            lines.append("   ")
        lines[-1] += f" {entry}"
    lines[-1] += ")"
    return lines


def _typed(entries: Iterable[Typed]) -> list[str]:
    """Give `a b - t` with neighbours of one type put together, as words that stay on one line."""
    words: list[str] = []
    waiting: list[str] = []
    known: str | None = None
    for entry in (*entries, None):
        if waiting and (entry is None or entry.type != known):
            words += [*waiting[:-1], f"{waiting[-1]} - {known}"]
            waiting = []
        if entry is not None:
            waiting.append(entry.name)
            known = entry.type
    return words


def _rule(rule: Rule) -> list[str]:
    head = f"({' '.join([rule.predicate, *_typed(rule.parameters)])})"
    lines = _lines(f"  (:derived {head} ", rule.body, 4)
    lines[-1] += ")"
    return lines


def _action(action: PddlAction) -> list[str]:
    lines = [f"  ; {action.comment}"] if action.comment else []
    lines += [f"  (:action {action.name}"]
    lines.append(f"    :parameters ({' '.join(_typed(action.parameters))})")
    lines += _lines("    :precondition ", action.precondition, 6)
    lines += _effects([_effect(effect) for effect in action.effects])
    lines[-1] += ")"
    return lines


def _lines(opening: str, formula: Formula, indent: int) -> list[str]:
    """Write a formula behind an opening; parts that do not fit get lines of their own."""
    flat = opening + _formula(formula)
    if len(flat) < _WIDTH:
        return [flat]
    match formula:
        case And(parts) | Or(parts) if parts:
            lines = [f"{opening}({'and' if isinstance(formula, And) else 'or'}"]
            for part in parts:
                lines += _lines(" " * indent, part, indent + 2)
        case Not(part):
            lines = _lines(f"{opening}(not ", part, indent)
        case Exists(variables, part):
            lines = [f"{opening}(exists ({' '.join(_typed(variables))})"]
            lines += _lines(" " * indent, part, indent + 2)
        case _:
            return [flat]
    lines[-1] += ")"
    return lines


def _effects(effects: list[str]) -> list[str]:
    opening = "    :effect "
    text = effects[0] if len(effects) == 1 else f"({' '.join(['and', *effects])})"
    if len(effects) < 2 or len(opening) + len(text) < _WIDTH:
        return [opening + text]
    return [f"{opening}(and", *(f"      {each}" for each in effects[:-1]), f"      {effects[-1]})"]


def _effect(effect: Effect) -> str:
    text = _formula(effect.fact)
    if effect.negated:
        text = f"(not {text})"
    if effect.every:
        text = f"(forall ({' '.join(_typed(effect.every))}) {text})"
    return text


def _formula(formula: Formula) -> str:
    match formula:
        case Fact(predicate, args):
            return f"({' '.join([predicate, *args])})"
        case Equal(left, right):
            return f"(= {left} {right})"
        case Not(part):
            return f"(not {_formula(part)})"
        case Exists(variables, part):
            return f"(exists ({' '.join(_typed(variables))}) {_formula(part)})"
        case And(parts):
            return f"({' '.join(['and', *map(_formula, parts)])})"
        case Or(parts):
            return f"({' '.join(['or', *map(_formula, parts)])})"
