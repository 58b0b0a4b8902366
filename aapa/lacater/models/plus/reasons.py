"""Why the snitch is believed to be where it is, and how sure that is.

How sure follows from what it rests on: about the share of the frames of that kind, on the tuning
videos of both kinds of perception, in which the model's box and the true one shared half of
their union; times the weight of the best rival, where there are several. What is inferred is
weaker than what is reported, and says so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from aapa.lacater.models.plus.rivals import OUTSIDE, Rival


class Ground(Enum):
    """What the belief rests on."""

    UNSEEN = "unseen"
    SEEN = "seen"
    REPORTED = "reported"
    INFERRED = "inferred"
    ON_PATH = "on path"
    GOES_ON = "goes on"
    REMEMBERED = "remembered"


SURE = {
    Ground.UNSEEN: 0.0,
    Ground.SEEN: 1.0,
    Ground.REPORTED: 0.99,
    Ground.INFERRED: 0.98,
    Ground.ON_PATH: 0.98,
    Ground.GOES_ON: 0.85,
    Ground.REMEMBERED: 0.92,
}
"""How sure a belief is that rests on each ground."""


@dataclass(frozen=True, slots=True)
class Belief:
    """What is believed of the snitch's place, beside its box.

    Args:
        why: One sentence.
        confidence: In [0, 1]; 0 before it was seen.
        rivals: Where else it may be, the surest first; empty where there is no doubt of that kind.
    """

    why: str
    confidence: float
    rivals: tuple[Rival, ...] = ()


def belief(
    ground: Ground,
    containers: Sequence[str] = (),
    rivals: tuple[Rival, ...] = (),
    unseen: int = 0,
    *,
    moves: bool = False,
) -> Belief:
    """Put a belief into words.

    Args:
        ground: What it rests on.
        containers: What the snitch stands in, the innermost first.
        rivals: All places that are possible, where that is in doubt.
        unseen: For how many frames it has not been seen.
        moves: Its outermost container is moving.
    """
    said = _sentence(ground, containers, unseen, moves=moves)
    sure = confidence(ground, containers[-1] if containers else OUTSIDE, rivals)
    return Belief(said, sure, rivals)


def confidence(ground: Ground, held: str, rivals: Sequence[Rival] = ()) -> float:
    """Give how sure a belief is, in [0, 1].

    Args:
        ground: What it rests on.
        held: The outermost thing that the snitch stands in; `OUTSIDE` if in none.
        rivals: All places that are possible, where that is in doubt.
    """
    weight = 1.0
    if rivals and ground in (Ground.INFERRED, Ground.REMEMBERED, Ground.GOES_ON):
        weight = next((rival.weight for rival in rivals if rival.container == held), 1.0)
    return round(SURE[ground] * weight, 3)


def _sentence(ground: Ground, containers: Sequence[str], unseen: int, *, moves: bool) -> str:
    inside = ", which stands in ".join(containers)
    how = f"goes with {inside}" if moves else f"stands in {inside}"
    return {
        Ground.UNSEEN: "It has not been seen yet.",
        Ground.SEEN: "It is seen.",
        Ground.REPORTED: f"It {how}: that was reported.",
        Ground.INFERRED: (
            f"It {how}: no action said so, but that came to stand where it vanished, "
            "which is weaker than a report."
        ),
        Ground.ON_PATH: (
            "It is hidden on its way, and is taken to go on to where the move is planned to end."
        ),
        Ground.GOES_ON: (
            "It was seen to move, and is taken to have gone on behind what hides it, no farther."
        ),
        Ground.REMEMBERED: (
            f"It has not been seen for {unseen} frames, and is taken to be where it was last."
        ),
    }[ground]
