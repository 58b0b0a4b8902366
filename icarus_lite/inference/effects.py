"""What an executed skill leaves behind: the effects of its clause, as facts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.facts import Bindings, FactStore, ground, match, unify
from icarus_lite.inference.supports import bind_pattern
from icarus_lite.language.syntax import Atom, Condition, SkillClause
from icarus_lite.records import dataclass
from icarus_lite.symbols import Action, Belief


@dataclass(frozen=True, slots=True)
class Change:
    """The effects of one ground skill instance.

    Args:
        added: Facts that are believed from now on.
        removed: Patterns that no belief may match any longer; a free variable means "any".
    """

    added: tuple[Belief, ...] = ()
    removed: tuple[Atom, ...] = ()

    def removes(self, belief: Belief) -> bool:
        """Tell whether a belief has to go, because of a removal that nothing added overrides."""
        return belief not in self.added and any(
            match(atom, belief, {}) is not None for atom in self.removed
        )


def change_of(effects: Iterable[Condition], bindings: Bindings) -> Change:
    """Bind effects; a positive one with a free variable says nothing definite and is left out."""
    added, removed = [], []
    for effect in effects:
        if effect.negated:
            removed.append(bind_pattern(effect.atom, bindings))
        else:
            fact = ground(effect.atom, bindings)
            if fact is not None:
                added.append(fact)
    return Change(tuple(added), tuple(removed))


def change_by_action(
    clauses: Sequence[SkillClause],
    action: Action,
    before: FactStore,
    evaluator: Evaluator,
) -> Change:
    """Give the effects of a recorded action, of which only name and arguments are known.

    The clause taken is the first whose conditions held before the action. If none did (the
    record begins here, or the action was not ours to plan), only those effects count that all
    clauses of that name agree on.
    """
    named = [(clause, _unify_head(clause, action)) for clause in clauses]
    candidates = [(clause, bound) for clause, bound in named if bound is not None]
    for clause, bound in candidates:
        matcher = evaluator.matcher(clause.elements, clause.tests, tuple(bound))
        for found in matcher.matches(before, bound):
            return change_of(clause.effects, found.bindings)
    changes = [change_of(clause.effects, bound) for clause, bound in candidates]
    if not changes:
        return Change()
    first, *others = changes
    return Change(
        tuple(fact for fact in first.added if all(fact in other.added for other in others)),
        tuple(atom for atom in first.removed if all(atom in other.removed for other in others)),
    )


def _unify_head(clause: SkillClause, action: Action) -> Bindings | None:
    head = clause.head
    if head.predicate != action.name or len(head.args) != len(action.args):
        return None
    return unify(zip(head.args, action.args, strict=True))
