"""The goals that problem solving has gone through: what was wanted for what, and how it ended."""

from __future__ import annotations

from collections.abc import Iterator
from enum import StrEnum

from icarus_lite.records import dataclass


class Ending(StrEnum):
    """How the pursuit of a subgoal ended."""

    HELD = "held"  # it was so already
    ACHIEVED = "achieved"
    UNCHAINABLE = "unchainable"  # no skill and no definition can ever bring it about
    CIRCULAR = "circular"  # it is what it is wanted for
    FAILED = "failed"  # every way to it was tried
    LIMIT = "limit"  # given up before every way to it was tried


@dataclass(frozen=True, slots=True)
class Way:
    """One way to a subgoal that was tried.

    Args:
        means: The skill instance with such an effect (skill chaining), or the literal that a
            definition makes of its parts (concept chaining).
        chained: Whether it is a skill.
        subgoals: What it needs and what was pursued for it, in that order.
        leads: Whether it led to the subgoal.
    """

    means: str
    chained: bool
    subgoals: tuple[Subgoal, ...]
    leads: bool


@dataclass(frozen=True, slots=True)
class Subgoal:
    """A literal that was wanted, and what was done about it.

    Args:
        literal: The literal.
        ending: What came of it.
        ways: The ways that were tried, the last one first where it led there.
    """

    literal: str
    ending: Ending
    ways: tuple[Way, ...] = ()

    def lines(self, indent: str = "") -> Iterator[str]:
        """Give the tree below it line by line: what each subgoal took, and what failed."""
        yield f"{indent}{self.literal}: {_WORDS[self.ending]}"
        for way in self.ways:
            what = "by" if way.leads else "not by"
            kind = "" if way.chained else "its parts "
            yield f"{indent}  {what} {kind}{way.means}"
            held = [each.literal for each in way.subgoals if each.ending is Ending.HELD]
            if held:
                yield f"{indent}    holds: {' '.join(held)}"
            for subgoal in way.subgoals:
                if subgoal.ending is not Ending.HELD:
                    yield from subgoal.lines(indent + "    ")

    def as_dict(self) -> dict[str, object]:
        """Give the tree as JSON has it."""
        return {
            "literal": self.literal,
            "ending": str(self.ending),
            "ways": [
                {
                    "means": way.means,
                    "by": "skill" if way.chained else "concept",
                    "leads": way.leads,
                    "subgoals": [subgoal.as_dict() for subgoal in way.subgoals],
                }
                for way in self.ways
            ],
        }


_WORDS = {
    Ending.HELD: "holds",
    Ending.ACHIEVED: "achieved",
    Ending.UNCHAINABLE: "no skill can bring it about",
    Ending.CIRCULAR: "is itself what this is for",
    Ending.FAILED: "every way to it was tried",
    Ending.LIMIT: "given up, too much was tried",
}
