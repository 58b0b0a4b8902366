"""The scene while it is being made up: where everything is at every frame, and who covers whom.

A stack is what goes together: a cone and what it covers, the outermost first. A thing by itself
is a stack of one. All paths reach to the end of the scene: whatever has come to rest stays.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.motion import QUARTER_TURN, Moves, turn
from aapa.lacater.scene import Movement

LAST_FRAME: Final = 300
"""The last frame that is simulated; the video ends one before it."""

LEAST_GAP: Final = 0.25
"""Things come no closer than this to each other, in units of the scene, centre distance less
radii."""


class Stage:
    """What happens to a set of bodies, move by move.

    Args:
        bodies: The things.
        places: Where each is put at first, x and y.

    Attributes:
        radii: (n,) each body's radius.
        planned: (n, 301, 3) the origin of each body as the moves are planned.
        filmed: (n, 301, 3) the same as the pictures show it.
        tilts: (n, 301) how far each body is turned about its own y axis, as filmed, rad.
        stacks: The bodies' indices, each in one stack, the outermost first.
        movements: The record of each body.
    """

    def __init__(self, bodies: Sequence[Body], places: Sequence[tuple[float, float]]) -> None:
        count = len(bodies)
        origins = [body.origin_at(x, y) for body, (x, y) in zip(bodies, places, strict=True)]
        self.bodies = tuple(bodies)
        self.radii = np.array([body.radius for body in bodies])
        self.planned = np.repeat(np.array(origins)[:, None, :], LAST_FRAME + 1, axis=1)
        self.filmed = self.planned.copy()
        self.tilts = np.zeros((count, LAST_FRAME + 1))
        self.stacks = [[index] for index in range(count)]
        self.movements: list[list[Movement]] = [[] for _ in bodies]
        self._touching = np.eye(count, dtype=np.bool_)
        self._settled = 0

    def origin(self, index: int) -> NDArray[np.float64]:
        """Give where a body comes to rest after everything planned so far, (3,)."""
        origin: NDArray[np.float64] = self.planned[index, LAST_FRAME]
        return origin

    def record(
        self, index: int, action: str, start: int, end: int, other: int | None = None
    ) -> None:
        """Write down what is done with a body."""
        name = None if other is None else self.bodies[other].instance
        self.movements[index].append(Movement(action, name, start, end))

    def move(self, index: int, moves: Moves, start: int, target: NDArray[np.float64]) -> None:
        """Let a body go to a target (3,) of its own height, from a frame on."""
        origin = self.origin(index).copy()
        for paths, profile in ((self.planned, moves.planned), (self.filmed, moves.filmed)):
            path = profile.path(origin, target)
            paths[index, start : start + len(path)] = path
            paths[index, start + len(path) :] = path[-1]
        self._settled = max(self._settled, start + len(moves.planned.travel) - 1)

    def turn(self, index: int, start: int, end: int) -> None:
        """Let a body turn by a quarter about its own y axis."""
        before = self.tilts[index, LAST_FRAME]
        self.tilts[index, start : end + 1] = before + QUARTER_TURN * turn(end - start + 1)
        self.tilts[index, end + 1 :] = before + QUARTER_TURN

    def is_free(
        self,
        movers: Sequence[int],
        moves: Moves,
        start: int,
        shift: NDArray[np.float64],
    ) -> bool:
        """Tell whether bodies can be moved by a shift (3,) without coming near any other stack.

        Bodies of the movers' own stack are left out of account.
        """
        others = [i for stack in self.stacks if not set(stack) & set(movers) for i in stack]
        if not others:
            return True
        moving = list(movers)
        ends = self.planned[moving, LAST_FRAME] + shift
        least = self.radii[moving][:, None] + self.radii[others] + LEAST_GAP
        if _any_closer(ends, self.planned[others, LAST_FRAME], least):
            return False
        # Beyond the last move everything rests, as it does at the end.
        frames = len(moves.planned.travel)
        until = max(self._settled, start + frames - 1) + 1
        paths = np.empty((len(moving), until - start, 3))
        for row, index in enumerate(moving):
            origin = self.origin(index)
            paths[row, :frames] = moves.planned.path(origin, origin + shift)
            paths[row, frames:] = origin + shift
        return not _any_closer(paths, self.planned[others, start:until], least)

    def is_clear(
        self, place: NDArray[np.float64], radius: float, frame: int, but: Sequence[int]
    ) -> bool:
        """Tell whether a body could be at a place (3,) at a frame, among the outermost but some."""
        others = [stack[0] for stack in self.stacks if stack[0] not in but]
        least = (radius + self.radii[others] + LEAST_GAP)[None, :]
        return not _any_closer(place[None, :], self.planned[others, frame], least)

    def are_apart(self, first: int, place: NDArray[np.float64], second: int) -> bool:
        """Tell whether a body put at a place (3,) is apart from where another rests."""
        gap = np.linalg.norm(place - self.origin(second)) - self.radii[first] - self.radii[second]
        return bool(gap >= LEAST_GAP)

    def merge(self, outer: int, inner: int) -> None:
        """Put a stack of one over the stack whose outermost body is given."""
        below = self.stack_of(inner)
        self.stacks = [stack for stack in self.stacks if stack[0] not in (outer, inner)]
        self.stacks.append([outer, *below])
        self._touching[np.ix_([outer, *below], [outer, *below])] = True

    def split(self, outer: int) -> None:
        """Take the outermost body of a stack off it."""
        stack = self.stack_of(outer)
        self.stacks = [other for other in self.stacks if other is not stack]
        self.stacks += [[outer], stack[1:]]

    def stack_of(self, outermost: int) -> list[int]:
        """Give the stack with that outermost body."""
        return next(stack for stack in self.stacks if stack[0] == outermost)

    def is_sound(self) -> bool:
        """Tell whether no two outermost bodies are ever too close; cover and covered may be."""
        outer = [stack[0] for stack in self.stacks]
        first, second = np.triu_indices(len(outer), 1)
        one, two = np.array(outer)[first], np.array(outer)[second]
        strangers = ~self._touching[one, two]
        one, two = one[strangers], two[strangers]
        until = self._settled + 1
        gaps = self.planned[one, :until] - self.planned[two, :until]
        squares = np.einsum("pfi,pfi->pf", gaps, gaps)
        least = (self.radii[one] + self.radii[two] + LEAST_GAP) ** 2
        return not bool(np.any(squares < least[:, None]))


def _any_closer(
    first: NDArray[np.float64], second: NDArray[np.float64], least: NDArray[np.float64]
) -> bool:
    """Tell whether a place (m, …, 3) is closer than the least (m, o) to one of (o, …, 3)."""
    for places, limits in zip(first, least, strict=True):
        gaps = places - second
        squares = np.einsum("...i,...i->...", gaps, gaps)
        bound = limits.reshape(-1, *(1,) * (squares.ndim - 1)) ** 2
        if np.any(squares < bound):
            return True
    return False
