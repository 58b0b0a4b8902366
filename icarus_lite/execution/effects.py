"""When a skill has done its work: its effects are believed.

The effects of a primitive skill are those that its clause states, and the attachments that it
makes or dissolves by the attachment table of the domain (Algorithm 1).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from icarus_lite.inference import Bindings, Change, FactStore, bind_pattern, change_of
from icarus_lite.language.syntax import Atom, AttachmentRule, Condition, SkillClause, Term, Variable
from icarus_lite.symbols import ATTACHED, Value


def effects_of(clause: SkillClause, rules: Sequence[AttachmentRule]) -> tuple[Condition, ...]:
    """Give the effects of a clause, attachments included, in its own variables.

    A macro has only those it states: it is its primitive skills that attach and detach.
    """
    if not clause.is_primitive:
        return clause.effects
    attachments: list[Condition] = []
    for rule in rules:
        attaching = _renaming(rule.attach, clause.head)
        if attaching is not None:
            attachments.append(Condition(_attached(rule, attaching)))
            continue
        detaching = None if rule.until is None else _renaming(rule.until, clause.head)
        if detaching is not None:
            attachments.append(Condition(_attached(rule, detaching), negated=True))
    stated = set(clause.effects)
    return (*clause.effects, *(effect for effect in attachments if effect not in stated))


def ways_believed(
    effects: Sequence[Condition], bindings: Bindings, facts: FactStore
) -> Iterator[dict[str, Value]]:
    """Give each way in which all effects are believed, with the bindings extended by it.

    A free variable of a positive effect stands for anything that will do. A negative effect is
    believed when nothing is left that it would remove; what a positive one adds it leaves alone,
    so that `(in ?ball ?room) (not (in ?ball ?_elsewhere))` can come true.
    """
    positive = [effect.atom for effect in effects if not effect.negated]
    negative = [effect.atom for effect in effects if effect.negated]
    for bound in _join(positive, dict(bindings), facts):
        change = change_of(effects, bound)
        if not any(_left(atom, bound, change, facts) for atom in negative):
            yield bound


def are_believed(effects: Sequence[Condition], bindings: Bindings, facts: FactStore) -> bool:
    """Tell whether there are effects and all of them are believed."""
    return bool(effects) and any(True for _ in ways_believed(effects, bindings, facts))


def missing_effect(
    effects: Sequence[Condition], bindings: Bindings, facts: FactStore
) -> Condition | None:
    """Give the first effect that is not believed, bound; None if each of them is."""
    change = change_of(effects, bindings)
    for effect in effects:
        atom = bind_pattern(effect.atom, bindings)
        if effect.negated:
            missing = _left(effect.atom, bindings, change, facts)
        else:
            missing = not any(True for _ in facts.matches(atom, {}))
        if missing:
            return Condition(atom, effect.negated, effect.span)
    return None


def _join(
    atoms: Sequence[Atom], bound: dict[str, Value], facts: FactStore
) -> Iterator[dict[str, Value]]:
    if not atoms:
        yield bound
        return
    for extended, _ in facts.matches(atoms[0], bound):
        yield from _join(atoms[1:], extended, facts)


def _left(atom: Atom, bound: Bindings, change: Change, facts: FactStore) -> bool:
    return any(change.removes(fact) for _, fact in facts.matches(atom, bound))


def _renaming(pattern: Atom, head: Atom) -> dict[str, Term] | None:
    """Give what the variables of an attachment rule stand for in the terms of a skill's head.

    None where the rule is about another skill, or only about some of this skill's instances.
    """
    if pattern.predicate != head.predicate or len(pattern.args) != len(head.args):
        return None
    renamed: dict[str, Term] = {}
    for term, own in zip(pattern.args, head.args, strict=True):
        if isinstance(term, Variable):
            if renamed.setdefault(term.name, own) != own:
                return None
        elif term != own:
            return None
    return renamed


def _attached(rule: AttachmentRule, renamed: dict[str, Term]) -> Atom:
    def own(term: Term, stand_in: str) -> Term:
        if not isinstance(term, Variable):
            return term
        # A variable of the rule that its action does not bind is open; the name is nobody else's.
        return renamed.get(term.name, Variable(f"?_{stand_in} of the attachment"))

    return Atom(ATTACHED, (own(rule.child, "child"), own(rule.parent, "parent")), (), rule.span)
