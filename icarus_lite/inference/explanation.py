"""`why`: the derivation of a belief as a tree, down to percepts and to actions.

Nothing is kept for it from cycle to cycle: a proof follows the first support of each belief and is
made when it is asked for. Should first supports ever lead in a circle, supports are chosen anew so
that they do not. A belief that serves several
times in a proof is explained once and shared, so that a proof is never larger than what it is
about, however often its parts come up.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Mapping

from icarus_lite.inference.contradictions import Doubt, Withdrawal
from icarus_lite.inference.engine import BeliefState
from icarus_lite.inference.explaining.chronicle import Chronicle, Period
from icarus_lite.inference.explaining.grounds import well_founded
from icarus_lite.inference.explaining.reasons import because
from icarus_lite.inference.supports import Assertion, Derivation, Support
from icarus_lite.language.syntax import Atom
from icarus_lite.records import dataclass, replace
from icarus_lite.symbols import Action, Belief, Percept

_PERIODS_TOLD = 5
"""Of how many periods in which it was held a belief's explanation tells as text."""


@dataclass(frozen=True, slots=True)
class Explanation:
    """One belief, why it is held, and the explanations of what that rests on.

    Args:
        belief: The belief, or the percept as a fact.
        cycle: The cycle it is about.
        support: Its derivation, the action that asserted it, or the percept that it is; None if
            it is not believed.
        premises: The explanations of the percepts and beliefs it was derived from.
        alternatives: The same belief by its other supports, where they were asked for.
        periods: When it was held, this cycle included, as far as that is on record.
        withdrawn: When it was withdrawn up to this cycle, and what contradicted it.
        doubts: What contradicts it now, though not for long enough.
    """

    belief: Belief
    cycle: int
    support: Support | Percept | None
    premises: tuple[Explanation, ...] = ()
    alternatives: tuple[Explanation, ...] = ()
    periods: tuple[Period, ...] = ()
    withdrawn: tuple[tuple[int, Withdrawal], ...] = ()
    doubts: tuple[Doubt, ...] = ()

    @property
    def subject(self) -> str:
        """The belief or percept, as text."""
        return str(self.support if isinstance(self.support, Percept) else self.belief)

    @property
    def because(self) -> str:
        """One sentence: perceived, asserted by which action when, or by which clause."""
        if self.support is None:
            return f"is not believed in cycle {self.cycle}"
        return because(None if isinstance(self.support, Percept) else self.support)

    @property
    def holds(self) -> bool:
        """Whether it is believed."""
        return self.support is not None

    @property
    def action(self) -> Action | None:
        """The action that asserted it, if one did."""
        return self.support.action if isinstance(self.support, Assertion) else None

    @property
    def absences(self) -> tuple[Atom, ...]:
        """The patterns that nothing matches, which a `not` asked for."""
        return self.support.absent if isinstance(self.support, Derivation) else ()

    def __str__(self) -> str:
        return "\n".join(self.lines())

    def as_document(self) -> dict[str, object]:
        """Give it as plain data: all nodes of the proof, each once, the root first.

        What rests on others names them by their places in the list.
        """
        numbers: dict[int, int] = {}
        order: list[Explanation] = []
        waiting = deque([self])
        while waiting:
            each = waiting.popleft()
            if id(each) not in numbers:
                numbers[id(each)] = len(order)
                order.append(each)
                waiting += (*each.premises, *each.alternatives)
        nodes = [
            {
                "belief": each.subject,
                "because": each.because,
                "premises": [numbers[id(premise)] for premise in each.premises],
                "absences": [str(absence) for absence in each.absences],
                "alternatives": [numbers[id(other)] for other in each.alternatives],
            }
            for each in order
        ]
        periods = [[period.first, period.last] for period in self.periods]
        document: dict[str, object] = {"cycle": self.cycle, "periods": periods, "nodes": nodes}
        if self.withdrawn:
            document["withdrawn"] = [
                {"cycle": cycle, "because": list(each.because), "cycles": each.cycles}
                for cycle, each in self.withdrawn
            ]
        if self.doubts:
            document["doubts"] = [
                {"cycles": doubt.cycles, "limit": doubt.limit} for doubt in self.doubts
            ]
        return document

    def lines(self) -> Iterator[str]:
        """Give its text, a line at a time; what was told before is not told again."""
        told: set[int] = set()
        waiting: list[tuple[str, Explanation | str]] = [("", self)]
        while waiting:
            indent, each = waiting.pop()
            if isinstance(each, str):
                yield f"{indent}{each}"
                continue
            again = bool(each.premises) and id(each) in told
            yield f"{indent}{each.subject}  {each.because}{', as told above' if again else ''}"
            if again:
                continue
            told.add(id(each))
            below = indent + "  "
            parts: list[tuple[str, Explanation | str]] = [(below, p) for p in each.premises]
            parts += [
                (below, f"(not {absence})  nothing like it is believed")
                for absence in each.absences
            ]
            for other in each.alternatives:
                parts += [(below, "or else:"), (below + "  ", other)]
            if len(each.periods) > 1:
                lately = each.periods[-_PERIODS_TOLD:]
                earlier = len(each.periods) - len(lately)
                times = f" {earlier} times before, and" if earlier else ""
                held = ", ".join(map(str, lately))
                parts.append((below, f"it has been believed{times} {held}"))
            parts += [
                (below, f"it was withdrawn in cycle {cycle}, because {found.reason}")
                for cycle, found in each.withdrawn[-_PERIODS_TOLD:]
            ]
            parts += [(below, f"it is in doubt: {doubt}") for doubt in each.doubts]
            waiting += reversed(parts)


def explain(
    belief: Belief,
    state: BeliefState,
    *,
    alternatives: bool = False,
    chronicle: Chronicle | None = None,
) -> Explanation:
    """Explain a belief of a cycle.

    Args:
        belief: The belief, or a percept as a fact.
        state: The beliefs of the cycle.
        alternatives: Whether to give its other supports as well, all that can be established
            without the belief itself. What they rest on can be asked about in turn.
        chronicle: What was believed when, for the periods.
    """
    proof = _Proof(state)
    found = proof.of(belief)
    others: tuple[Explanation, ...] = ()
    if alternatives and found.support is not None:
        others = tuple(_others(found, state, proof))
    return replace(
        found,
        alternatives=others,
        periods=() if chronicle is None else chronicle.periods(belief),
        withdrawn=() if chronicle is None else _withdrawn(belief, state.cycle, chronicle),
        doubts=tuple(doubt for doubt in state.doubts if doubt.belief == belief),
    )


def _withdrawn(
    belief: Belief, cycle: int, chronicle: Chronicle
) -> tuple[tuple[int, Withdrawal], ...]:
    return tuple(
        (when, each)
        for when, each in chronicle.withdrawals()
        if each.belief == belief and when <= cycle
    )


def _others(found: Explanation, state: BeliefState, proof: _Proof) -> Iterator[Explanation]:
    belief = found.belief
    supports = [each for each in state.supports.get(belief, ()) if each != found.support]
    premises = [
        premise
        for support in supports
        if isinstance(support, Derivation)
        for premise in support.matched
    ]
    choices = well_founded(premises, state.supports, without=belief)
    independent = _Proof(state, choices)
    for support in supports:
        if isinstance(support, Assertion):
            yield Explanation(belief, state.cycle, support)
        elif all(each in choices or proof.is_perceived(each) for each in support.matched):
            below = tuple(independent.of(premise) for premise in support.matched)
            yield Explanation(belief, state.cycle, support, below)


class _Proof:
    """The proofs of one cycle, each belief explained once.

    Args:
        state: The beliefs of the cycle.
        choices: The support to follow for each belief; its first if left out.
    """

    def __init__(self, state: BeliefState, choices: Mapping[Belief, Support] | None = None) -> None:
        self._state = state
        self._choices = choices
        self._reason = state.reasons()
        self._done: dict[Belief, Explanation] = {}

    def of(self, belief: Belief) -> Explanation:
        """Explain a belief, and before it all that it rests on, without recursion."""
        done, cycle = self._done, self._state.cycle
        found = done.get(belief)
        if found is not None:
            return found
        open_: list[_Open] = [_Open(belief, self.reason(belief))]
        begun = {belief}
        while True:
            last = open_[-1]
            for premise in last.waiting:
                below = done.get(premise)
                if below is None:
                    if premise in begun:  # what it rests on has come back to it
                        self._choices = well_founded([belief], self._state.supports)
                        return self.of(belief)
                    reason = self.reason(premise)
                    if isinstance(reason, Derivation):
                        begun.add(premise)
                        open_.append(_Open(premise, reason))
                        break
                    below = done[premise] = Explanation(premise, cycle, reason)
                last.below.append(below)
            else:
                open_.pop()
                found = Explanation(last.belief, cycle, last.reason, tuple(last.below))
                done[last.belief] = found
                if not open_:
                    return found
                begun.discard(last.belief)
                open_[-1].below.append(found)

    def is_perceived(self, belief: Belief) -> bool:
        """Tell whether a belief is a percept as a fact."""
        return self._state.percept(belief) is not None

    def reason(self, belief: Belief) -> Support | Percept | None:
        """Give the support to follow; the percept that a fact is; None for what is not believed."""
        if self._choices is None:
            return self._reason(belief)
        return self._choices.get(belief) or self._state.percept(belief)


class _Open:
    """A belief whose premises are being explained.

    Args:
        belief: The belief.
        reason: Why it is held.

    Attributes:
        waiting: What is still to be explained of what it rests on.
        below: The explanations that are there.
    """

    __slots__ = ("belief", "below", "reason", "waiting")

    def __init__(self, belief: Belief, reason: Support | Percept | None) -> None:
        self.belief, self.reason = belief, reason
        self.waiting = iter(reason.matched if isinstance(reason, Derivation) else ())
        self.below: list[Explanation] = []
