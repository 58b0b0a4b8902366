"""`why`: the derivation of a belief as a tree, down to percepts and to actions."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from icarus_lite.inference.engine import BeliefState
from icarus_lite.inference.facts import percept_facts
from icarus_lite.inference.given import GIVEN
from icarus_lite.inference.supports import Assertion, Support
from icarus_lite.symbols import Belief, Percept


@dataclass(frozen=True, slots=True)
class Explanation:
    """One belief, why it is held, and the explanations of what that rests on.

    Args:
        subject: The belief or percept, as text.
        because: One sentence: perceived, asserted by which action when, or by which clause.
        premises: The explanations of the percepts and beliefs it was derived from.
        absences: Patterns that nothing matches, which a `not` asked for.
    """

    subject: str
    because: str
    premises: tuple[Explanation, ...] = ()
    absences: tuple[str, ...] = ()

    def __str__(self) -> str:
        return "\n".join(self._lines(""))

    def _lines(self, indent: str) -> Iterator[str]:
        yield f"{indent}{self.subject}  {self.because}"
        for premise in self.premises:
            yield from premise._lines(indent + "  ")  # noqa: SLF001 - its own class
        for absence in self.absences:
            yield f"{indent}  (not {absence})  nothing like it is believed"


def explain(belief: Belief, state: BeliefState) -> Explanation:
    """Explain a belief of a cycle by its first support, which never rests on the belief itself."""
    for percept in state.percepts:
        if belief in percept_facts((percept,), state.lineages):
            return _explain_percept(percept)
    supports = state.supports.get(belief)
    if not supports:
        return Explanation(str(belief), f"is not believed in cycle {state.cycle}")
    return _explain_support(belief, supports[0], state)


def _explain_percept(percept: Percept) -> Explanation:
    return Explanation(str(percept), "is perceived")


def _explain_support(belief: Belief, support: Support, state: BeliefState) -> Explanation:
    if isinstance(support, Assertion) and support.action == GIVEN:
        return Explanation(str(belief), "is given from the start")
    if isinstance(support, Assertion):
        because = f"because {support.action} succeeded, reported in cycle {support.cycle}"
        return Explanation(str(belief), because)
    place = f" ({support.clause.span.in_line})" if support.clause.span.line else ""
    return Explanation(
        str(belief),
        f"by its definition{place}",
        tuple(explain(premise, state) for premise in support.matched),
        tuple(str(atom) for atom in support.absent),
    )
