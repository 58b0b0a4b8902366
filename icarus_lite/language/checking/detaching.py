"""Attachments that their detach action never undoes, or undoes for everything at once."""

from __future__ import annotations

from collections.abc import Mapping

from icarus_lite.language.checking.report import Report
from icarus_lite.language.syntax import Atom, AttachmentRule, Constant, Domain, Variable
from icarus_lite.symbols import Value

_MOST_CLAUSES = 100


def check_detaching(domain: Domain, report: Report) -> None:
    """Warn of attachments that cannot be undone as they are written."""
    heads: dict[str, list[Atom]] = {}
    for skill in domain.skills:
        heads.setdefault(skill.head.predicate, []).append(skill.head)
    for rule in domain.attachments:
        for pattern in (rule.attach, rule.until):
            if pattern is not None:
                _check_matches(pattern, heads, report)
        if rule.until is not None:
            _check_until(rule, rule.until, report)


def _check_matches(pattern: Atom, heads: Mapping[str, list[Atom]], report: Report) -> None:
    """Warn if no clause of the skill can ever be reported as the pattern has it."""
    alike = [h for h in heads.get(pattern.predicate, ()) if len(h.args) == len(pattern.args)]
    if len(alike) > _MOST_CLAUSES:
        return  # some clause of so many will do, and trying each for each rule takes long
    if alike and not any(_can_match(pattern, head) for head in alike):
        message = f"no clause of `{pattern.predicate}` can ever match {pattern}"
        hint = f"its first clause, in {alike[0].span.in_line}, begins with {alike[0]}"
        report.warning(pattern.span, "ICR043", message, hint)


def _check_until(rule: AttachmentRule, until: Atom, report: Report) -> None:
    attach = rule.attach
    same = attach.predicate == until.predicate and len(attach.args) == len(until.args)
    if same and _is_general(attach):
        message = f"{until} never detaches: {attach} matches it first, and attaches again"
        hint = "name the action that undoes it after :until, or leave :until out"
        report.warning(until.span, "ICR043", message, hint)
        return
    roles = [term for term in (rule.child, rule.parent) if isinstance(term, Variable)]
    if len(roles) == 2 and not {role.name for role in roles} & set(until.variables):
        message = f"{until} names neither {roles[0]} nor {roles[1]}: it detaches everything"
        hint = f"use the variables of {attach}, so that it detaches what was attached"
        report.warning(until.span, "ICR043", message, hint)


def _is_general(pattern: Atom) -> bool:
    """Tell whether a pattern matches every action of its name: variables only, all different."""
    names = pattern.variables
    return len(names) == len(pattern.args) == len(set(names))


def _can_match(pattern: Atom, head: Atom) -> bool:
    """Tell whether some instance of the head may match the pattern; their variables are apart."""
    bound: dict[str, Value] = {}
    for term, given in zip(pattern.args, head.args, strict=True):
        if not isinstance(given, Constant):
            continue
        expected = term.value if isinstance(term, Constant) else bound.get(term.name, given.value)
        if expected != given.value:
            return False
        if isinstance(term, Variable):
            bound[term.name] = given.value
    return True
