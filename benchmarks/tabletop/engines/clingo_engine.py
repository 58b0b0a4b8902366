"""clingo: grounds the rules over the whole state anew in each frame; that gives all facts."""

from __future__ import annotations

from collections.abc import Callable

import clingo

from tabletop.oracle import PREDICATES, Facts
from tabletop.scene import Frame, State

RULES = """
left_of(A,B) :- obj(A,_,XA,_,_,WA,_,_), obj(B,_,XB,_,_,WB,_,_), A != B, 2*XA+WA <= 2*XB-WB.
near(A,B) :- obj(A,_,XA,YA,ZA,_,_,_), obj(B,_,XB,YB,ZB,_,_,_), A != B,
  (XA-XB)*(XA-XB)+(YA-YB)*(YA-YB)+(ZA-ZB)*(ZA-ZB) < 90000.
on(A,B) :- obj(A,_,XA,YA,ZA,_,_,_), obj(B,_,XB,YB,ZB,WB,DB,HB), A != B, |ZA-(ZB+HB)| <= 5,
  2*|XA-XB| < WB, 2*|YA-YB| < DB, not holding(A).
covered(B) :- on(_,B).
clear(B) :- obj(B,_,_,_,_,_,_,_), not covered(B).
connected(A,B) :- attached(A,B).
connected(A,C) :- attached(A,B), connected(B,C).
linked(A) :- connected(A,_).
reachable(A) :- obj(A,_,X,Y,Z,_,_,_), base(RX,RY,R2), (X-RX)*(X-RX)+(Y-RY)*(Y-RY)+Z*Z <= R2.
graspable(A) :- clear(A), reachable(A), not holding(A).
adjacent(A,B) :- left_of(A,B), near(A,B).
candidate(A,B) :- adjacent(A,B), graspable(A), clear(B).
has_candidate(A) :- candidate(A,_).
loose(A) :- has_candidate(A), not linked(A).
assembly(A,B) :- loose(A), loose(B), near(A,B), left_of(A,B),
  obj(A,peg,_,_,_,_,_,_), obj(B,hole,_,_,_,_,_,_).
#defined holding/1.
#defined attached/2.
"""


class ClingoEngine:
    """Is handed the whole state as program text, ready-made; adding and grounding it are timed.

    Args:
        base: Where the arm stands.
    """

    def __init__(self, base: tuple[int, int, int]) -> None:
        self._base = base
        self._control: clingo.Control | None = None

    def begin(self, state: State) -> None:
        """Ground everything; here the text is made in the time that is measured."""
        self.prepare(Frame((), ()), state)()

    def prepare(self, frame: Frame, state: State) -> Callable[[], None]:  # noqa: ARG002 - as `Engine`
        """Write the state down; give what grounds it."""
        text = RULES + self._text(state)

        def step() -> None:
            control = clingo.Control(logger=lambda _code, _text: None)
            control.add("base", [], text)
            control.ground([("base", [])])
            self._control = control

        return step

    def facts(self) -> Facts:
        """Give all derived facts."""
        assert self._control is not None
        names = {name.replace("-", "_"): name for name in PREDICATES}
        return frozenset(
            (names[atom.symbol.name], *(each.number for each in atom.symbol.arguments))
            for atom in self._control.symbolic_atoms
            if atom.symbol.name in names and atom.is_fact
        )

    def _text(self, state: State) -> str:
        base = ",".join(map(str, self._base))
        lines = [f"base({base})."]
        lines += [
            f"obj({t.name},{t.type},{t.x},{t.y},{t.z},{t.w},{t.d},{t.h})." for t in state.things
        ]
        lines += [f"holding({name})." for name in sorted(state.holding)]
        lines += [f"attached({a},{b})." for a, b in sorted(state.fixed)]
        return "\n".join(lines)
