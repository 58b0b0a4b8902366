"""What speaks for and against a skill besides its conditions: its `:while`, and its effects."""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.inference.explaining.attempts import nearest_attempt
from icarus_lite.inference.explaining.context import Context
from icarus_lite.inference.explaining.diagnosis import diagnose
from icarus_lite.inference.explaining.fitting import fit
from icarus_lite.inference.explaining.lookup import matching
from icarus_lite.inference.explaining.reasons import Reason
from icarus_lite.inference.facts import Bindings
from icarus_lite.inference.supports import bind_pattern
from icarus_lite.language.syntax import Atom, Condition, SkillClause
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED


@dataclass(frozen=True, slots=True)
class Readiness:
    """What would become of a skill if it started now.

    Args:
        broken: Why its `:while` does not hold; None if it does, or there is none.
        believed: Its effects that are so already.
        outstanding: Its effects that are not.
    """

    broken: Reason | None
    believed: tuple[Condition, ...]
    outstanding: tuple[Condition, ...]

    @property
    def is_idle(self) -> bool:
        """Whether all that it would bring about is so already."""
        return bool(self.believed) and not self.outstanding

    def __str__(self) -> str:
        if not self.believed:
            return "none of its effects is so yet"
        listed = " and ".join(map(str, self.believed))
        so = f"{listed} {'is' if len(self.believed) == 1 else 'are'} so already"
        return f"it would change nothing: {so}" if self.is_idle else f"of its effects, {so}"


def readiness(clause: SkillClause, bindings: Bindings, context: Context) -> Readiness:
    """Look at the `:while` and the effects of a skill under the bindings of an attempt."""
    attempt = nearest_attempt(clause.holds, (), context.facts, bindings, context.evaluator)
    failure = attempt.failure
    broken = None if failure is None else diagnose(failure, attempt.bindings, context)
    effects = [
        Condition(bind_pattern(effect.atom, bindings), effect.negated, effect.span)
        for effect in clause.effects
    ]
    effects += _attachments(bind_pattern(clause.head, bindings), context)
    believed: list[Condition] = []
    outstanding: list[Condition] = []
    for effect in effects:
        found = bool(matching(effect.atom, context.facts))
        (outstanding if found is effect.negated else believed).append(effect)
    return Readiness(broken, tuple(believed), tuple(outstanding))


def _attachments(action: Atom, context: Context) -> Iterator[Condition]:
    """Give what an action attaches and detaches, as effects."""
    for rule in context.domain.attachments:
        pair = Atom(ATTACHED, (rule.child, rule.parent))
        found = fit(rule.attach, action)
        if found is not None:
            yield Condition(bind_pattern(pair, found.bindings))
            continue
        found = None if rule.until is None else fit(rule.until, action)
        if found is not None:
            yield Condition(bind_pattern(pair, found.bindings), negated=True)
