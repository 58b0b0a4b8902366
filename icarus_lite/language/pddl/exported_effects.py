"""Effects of a skill as PDDL: what it states, and what it does to the attachment hierarchy.

Effects of ours come one after the other: what the clause states, then each attachment rule. PDDL
has them all at once, additions last. So a later removal takes back an earlier addition here, and
where two of them may or may not be about the same objects, the action asks that they are not.
"""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.language.pddl.attaching import Attaching, Unclear, bonds
from icarus_lite.language.pddl.exported_conditions import Conditions
from icarus_lite.language.pddl.syntax import Effect, Equal, Formula, Not, Typed
from icarus_lite.language.pddl.values import Values
from icarus_lite.language.pddl.vocabulary import variable_name
from icarus_lite.language.syntax import (
    Atom,
    Condition,
    Constant,
    Domain,
    SkillClause,
    Term,
    Variable,
)
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import ATTACHED

ASSERTED = "asserted"
"""Ends the name of the predicate that says: an effect has made it so."""

UNTOUCHED = "untouched"
"""Ends the name of the predicate that says: no effect speaks against what is derived."""

CIRCLE = "moves-with"
"""The derived predicate that keeps attachments from forming a circle."""


@dataclass(slots=True)
class EffectTranslation:
    """The effects of one clause in the making.

    Args:
        domain: Has the attachment rules.
        clause: The clause.
        conditions: Translates terms and types.
        parameters: The variables that the action has.
        may_circle: Whether attachments could form a circle.
        effects: What has been translated, in order.
        extra: Conditions that the action must have besides those of the clause.
    """

    domain: Domain
    clause: SkillClause
    conditions: Conditions
    parameters: frozenset[str]
    may_circle: bool
    effects: list[tuple[Atom, bool]] = field(default_factory=list)
    extra: list[Formula] = field(default_factory=list)

    def run(self) -> tuple[Effect, ...]:
        """Translate all effects. Raises RefusedError where PDDL cannot say them."""
        stated = self.clause.effects
        for effect in stated:
            if effect.atom.attributes:
                message = f"the effect {effect} sets an attribute, which PDDL cannot say"
                hint = "make the value an argument of the predicate"
                raise self.conditions.refuse(effect.atom, message, hint)
            if effect.negated:
                self._remove(effect.atom)
        for effect in stated:
            if not effect.negated and self._is_definite(effect.atom):
                if effect.atom.predicate == ATTACHED:
                    self._attach(*effect.atom.args)
                else:
                    self._add(effect.atom)
        for bond in bonds(self.domain, self.clause):
            match bond:
                case Unclear(pattern):
                    message = f"{pattern} fits `{self.clause.head}` only for some of its arguments"
                    hint = "write a clause of the skill for those"
                    raise self.conditions.refuse(self.clause.head, message, hint)
                case Attaching(child, parent):
                    self._attach(child, parent)
                case _:
                    child_term = bond.child or Variable("?any-child")
                    parent_term = bond.parent or Variable("?any-parent")
                    self._remove(Atom(ATTACHED, (child_term, parent_term)))
        return tuple(
            dict.fromkeys(each for effect in self.effects for each in self._written(*effect))
        )

    def _is_definite(self, atom: Atom) -> bool:
        return all(name in self.parameters for name in atom.variables)

    def _add(self, atom: Atom) -> None:
        self.effects.append((atom, False))

    def _remove(self, atom: Atom) -> None:
        """Remove what matches, taking back what an earlier step has added."""
        for effect in tuple(self.effects):
            added, negated = effect
            if negated or added.predicate != atom.predicate or len(added.args) != len(atom.args):
                continue
            open_pairs: list[tuple[Term, Term]] = []
            for ours, theirs in zip(atom.args, added.args, strict=True):
                is_free = isinstance(ours, Variable) and ours.name not in self.parameters
                if ours != theirs and not is_free:
                    open_pairs.append((ours, theirs))
            if not open_pairs:
                self.effects.remove(effect)
            elif all(self._may_be_same(ours, theirs) for ours, theirs in open_pairs):
                left, right = (self.conditions.names.term(term) for term in open_pairs[0])
                self.extra.append(Not(Equal(left, right)))
        self.effects.append((atom, True))

    def _attach(self, child: Term, parent: Term) -> None:
        """Give a child its one parent, unless that moves with the child itself."""
        if not self._is_definite(Atom(ATTACHED, (child, parent))):
            return
        names = self.conditions.names
        if self._may_be_same(child, parent):
            self.extra.append(Not(Equal(names.term(child), names.term(parent))))
        if self.may_circle:
            types = [self._type(parent), self._type(child)]
            name = names.fresh_predicate(CIRCLE, CIRCLE)
            above = names.fact(name, (names.term(parent), names.term(child)), types)
            self.extra.append(Not(above))
        self._remove(Atom(ATTACHED, (child, Variable("?any-parent"))))
        self._add(Atom(ATTACHED, (child, parent)))

    def _may_be_same(self, first: Term, second: Term) -> bool:
        return bool(self._values(first).keys() & self._values(second).keys())

    def _values(self, term: Term) -> Values:
        if isinstance(term, Constant):
            return {term.value: None}
        return self.conditions.names.values.of(term.name, self.clause.elements)

    def _type(self, term: Term) -> str:
        if isinstance(term, Constant):
            return self.conditions.names.type_of_value(term.value)
        return self.conditions.type_of(term.name, self.clause.elements)

    def _written(self, atom: Atom, negated: bool) -> Iterator[Effect]:  # noqa: FBT001 - a literal
        names = self.conditions.names
        if negated and atom.predicate not in names.values.possible:
            return  # it is never true anyway
        free = [n for n in dict.fromkeys(atom.variables) if n not in self.parameters]
        own = [Condition(atom)]
        every = tuple(Typed(variable_name(n), self.conditions.type_of(n, own)) for n in free)
        types = [
            self.conditions.type_of(term.name, own)
            if isinstance(term, Variable) and term.name in free
            else self._type(term)
            for term in atom.args
        ]
        terms = [names.term(term) for term in atom.args]
        if atom.predicate not in names.kinds.overruled:
            yield Effect(names.fact(names.predicate(atom.predicate), terms, types), negated, every)
            return
        for role in (ASSERTED, UNTOUCHED):
            key = f"{atom.predicate} {role}"
            name = names.fresh_predicate(key, f"{atom.predicate}-{role}")
            if role == ASSERTED or negated or self._was_removed(atom):
                yield Effect(names.fact(name, terms, types), negated, every)

    def _was_removed(self, atom: Atom) -> bool:
        """Tell whether some skill can have ended a belief, so that stating it must undo that."""
        return any(
            effect.negated and effect.atom.predicate == atom.predicate
            for clause in self.domain.skills
            for effect in clause.effects
        )
