"""A top-level goal: a state of the world that is worth something of itself."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from icarus_lite.language.syntax import Condition, Term, Variable
from icarus_lite.records import dataclass, replace


@dataclass(frozen=True, slots=True)
class Goal:
    """A top-level goal.

    Args:
        name: What it is called: unique among the goals of an agent.
        conditions: What is to hold, all of it; variables stand for anything.
        priority: How much it matters; greater comes first.
        maintain: Whether it is kept up once it is reached; otherwise it is dropped then.
        is_long_term: Whether the domain states it, and its relevance nominates and drops it.
    """

    name: str
    conditions: tuple[Condition, ...]
    priority: float = 0.0
    maintain: bool = False
    is_long_term: bool = False


def name_of(conditions: Iterable[Condition]) -> str:
    """Name a goal by what is to hold: `(on a b) (on b c)`."""
    return " ".join(map(str, conditions))


def together(target: Goal, kept: Sequence[Goal]) -> tuple[Condition, ...]:
    """Give a goal and others that must not suffer from it as one conjunction.

    Each goal's variables are its own: those of the others are renamed where two goals use the
    same name.
    """
    taken = _variables(target.conditions)
    conditions = list(target.conditions)
    for number, goal in enumerate(kept, 1):
        own = _variables(goal.conditions)
        renamed = {name: f"{name}~{number}" for name in sorted(own & taken)}
        taken |= own | set(renamed.values())
        conditions += [_renamed(condition, renamed) for condition in goal.conditions]
    return tuple(dict.fromkeys(conditions))


def _variables(conditions: Iterable[Condition]) -> set[str]:
    return {name for condition in conditions for name in condition.atom.variables}


def _renamed(condition: Condition, names: dict[str, str]) -> Condition:
    def own(term: Term) -> Term:
        return Variable(names.get(term.name, term.name)) if isinstance(term, Variable) else term

    atom = condition.atom
    args = tuple(own(term) for term in atom.args)
    attributes = tuple((name, own(term)) for name, term in atom.attributes)
    return replace(condition, atom=replace(atom, args=args, attributes=attributes))
