"""The scene and what happens in it: n things on a table, 300 frames, all in whole millimetres.

Density is constant, sixteen things a square metre; three in ten begin stacked, in towers of up to
three. In episodes of 25 frames one thing is grasped, lifted, carried and put onto a clear thing
nearby, to which it is fixed; in the middle of each episode one fixed pair comes apart. In mode
`two` a second thing is pushed 10 mm a frame; in mode `all` every other thing drifts, each tower as
a whole, at most 10 mm a frame along each axis.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum

TYPES = ("peg", "hole", "block", "box")
FRAMES = 300
EPISODE = 25
LIFT, CARRY = 5, 15
NEARBY = 12
"""From how many of the nearest clear things one is chosen to put something onto."""
HEIGHT = 120
"""How far a carried thing is lifted, mm."""


class Mode(StrEnum):
    """How many things move in each frame."""

    TWO = "two"
    ALL = "all"


@dataclass(frozen=True, slots=True)
class Thing:
    """A thing on the table: centre x, y and bottom z, sizes w, d, h."""

    name: int
    x: int
    y: int
    z: int
    w: int
    d: int
    h: int

    @property
    def type(self) -> str:
        """Its type, which its number decides."""
        return TYPES[self.name % len(TYPES)]


class Verb(StrEnum):
    """What an action does."""

    GRASP = "grasp"
    RELEASE = "release"
    ATTACH = "attach"
    DETACH = "detach"


@dataclass(frozen=True, slots=True)
class Frame:
    """What is different in a frame: name, x, y, z of what has moved, and the actions that ended."""

    moved: tuple[tuple[int, int, int, int], ...]
    actions: tuple[tuple[Verb, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class State:
    """All that is given in a frame."""

    things: tuple[Thing, ...]
    holding: frozenset[int]
    fixed: frozenset[tuple[int, int]]

    def after(self, frame: Frame) -> State:
        """Give the state after a frame."""
        things = list(self.things)
        for name, x, y, z in frame.moved:
            things[name] = replace(things[name], x=x, y=y, z=z)
        holding, fixed = set(self.holding), set(self.fixed)
        for verb, args in frame.actions:
            match verb:
                case Verb.GRASP:
                    holding.add(args[0])
                case Verb.RELEASE:
                    holding.discard(args[0])
                case Verb.ATTACH:
                    fixed.add((args[0], args[1]))
                case Verb.DETACH:
                    fixed.discard((args[0], args[1]))
        return State(tuple(things), frozenset(holding), frozenset(fixed))


@dataclass(frozen=True, slots=True)
class Workload:
    """A first state and the frames that follow.

    Args:
        count: How many things there are.
        mode: How many of them move.
        base: Where the arm stands, x and y, and the square of its reach.
        start: What is given in frame 0.
        frames: Frames 1 and on.
    """

    count: int
    mode: Mode
    base: tuple[int, int, int]
    start: State
    frames: tuple[Frame, ...]

    def states(self) -> Iterator[State]:
        """Give the state of each frame, frame 0 first."""
        state = self.start
        yield state
        for frame in self.frames:
            state = state.after(frame)
            yield state


def make_workload(count: int, mode: Mode, seed: int = 1, frames: int = FRAMES) -> Workload:
    """Make the workload of a size and mode; the same arguments give the same workload.

    Args:
        count: How many things, at least six.
        mode: How many of them move.
        seed: Where chance comes from.
        frames: How many frames, frame 0 included.
    """
    draw = random.Random(f"{count} {mode} {seed}")  # noqa: S311 - a benchmark, not a secret
    side = round(250 * math.sqrt(count))
    things, below = _place(draw, count, side)
    fixed: set[tuple[int, int]] = set()
    while len(fixed) < count // 3:
        one, other = sorted(draw.sample(range(count), 2))
        fixed.add((one, other))
    start = State(tuple(things), frozenset(), frozenset(fixed))
    story = _Story(draw, mode, side, start, below)
    told = tuple(frame for frame, _ in zip(story.frames(), range(frames - 1), strict=False))
    reach2 = int((0.4 * side) ** 2)
    return Workload(count, mode, (side // 2, side // 2, reach2), start, told)


def _place(draw: random.Random, count: int, side: int) -> tuple[list[Thing], dict[int, int]]:
    """Place all things; give them, and for each one that is stacked what is right below it."""
    stacked = set(draw.sample(range(1, count), round(0.3 * count)))
    things: list[Thing] = []
    below: dict[int, int] = {}
    level: list[int] = []
    for name in range(count):
        w, d, h = (draw.randint(40, 80) for _ in range(3))
        tops = [t.name for t in things if level[t.name] < 2 and t.name not in below.values()]
        if name in stacked and tops:
            support = things[draw.choice(tops)]
            below[name] = support.name
            level.append(level[support.name] + 1)
            things.append(Thing(name, support.x, support.y, support.z + support.h, w, d, h))
        else:
            level.append(0)
            things.append(Thing(name, draw.randrange(side), draw.randrange(side), 0, w, d, h))
    return things, below


@dataclass
class _Story:
    """What happens, frame by frame.

    Args:
        draw: Where chance comes from.
        mode: How many things move.
        side: The length of the table, mm.
        state: What is given now.
        below: For each stacked thing, what is right below it.
        speed: For each thing that stands on the table, how it drifts, mm a frame.
    """

    draw: random.Random
    mode: Mode
    side: int
    state: State
    below: dict[int, int]
    speed: dict[int, tuple[int, int]] = field(default_factory=dict)

    def frames(self) -> Iterator[Frame]:
        """Tell one episode after another, without end."""
        while True:
            carried, target = self._chosen()
            pushed = self._pushed(carried, target)
            for step in range(EPISODE):
                frame = self._frame(step, carried, target, pushed)
                self.state = self.state.after(frame)
                yield frame
            self.below[carried] = target

    def _chosen(self) -> tuple[int, int]:
        """Choose what is carried, and a clear thing nearby that it can be put onto."""
        things = self.state.things
        clear = [t.name for t in things if t.name not in self.below.values()]
        carried = things[self.draw.choice(clear)]
        possible = [n for n in clear if n != carried.name and self._level(n) < 2]
        possible.sort(key=lambda n: (_distance2(things[n], carried), n))
        return carried.name, self.draw.choice(possible[:NEARBY])

    def _pushed(self, carried: int, target: int) -> tuple[int, int, int]:
        """Choose what is pushed: a thing that stands alone; and by how much a frame."""
        busy = {carried, target, *self.below, *self.below.values()}
        alone = [t for t in self.state.things if t.name not in busy]
        if not alone:  # all are stacked: push the foot of a tower, and let it fall apart
            alone = [t for t in self.state.things if t.name not in (carried, target)]
        thing = self.draw.choice(alone)
        along_x = self.draw.random() < 0.5
        inwards = 10 if (thing.x if along_x else thing.y) < self.side // 2 else -10
        return thing.name, inwards if along_x else 0, 0 if along_x else inwards

    def _frame(self, step: int, carried: int, target: int, pushed: tuple[int, int, int]) -> Frame:
        actions: list[tuple[Verb, tuple[int, ...]]] = []
        if step == 0:
            self.below.pop(carried, None)
            actions.append((Verb.GRASP, (carried,)))
        if step == EPISODE // 2 and self.state.fixed:
            actions.append((Verb.DETACH, self.draw.choice(sorted(self.state.fixed))))
        if step == EPISODE - 1:
            actions.append((Verb.RELEASE, (carried,)))
            actions.append((Verb.ATTACH, (min(carried, target), max(carried, target))))
        if self.mode is Mode.ALL:
            moved = self._drifted(carried)
        else:
            thing = self.state.things[pushed[0]]
            moved = {thing.name: (thing.x + pushed[1], thing.y + pushed[2], thing.z)}
        moved[carried] = self._carried(step, carried, target, moved)
        rows = tuple((name, *place) for name, place in sorted(moved.items()))
        return Frame(rows, tuple(actions))

    def _carried(
        self, step: int, carried: int, target: int, moved: dict[int, tuple[int, int, int]]
    ) -> tuple[int, int, int]:
        """Give the next place of what is carried, on the way to where the target will be."""
        thing, goal = self.state.things[carried], self.state.things[target]
        x, y, z = moved.get(target, (goal.x, goal.y, goal.z))
        top = z + goal.h
        if step < LIFT:
            return thing.x, thing.y, thing.z + HEIGHT // LIFT
        if step < LIFT + CARRY:
            left = LIFT + CARRY - step
            return thing.x + (x - thing.x) // left, thing.y + (y - thing.y) // left, thing.z
        left = EPISODE - step
        return x, y, thing.z + (top - thing.z) // left

    def _drifted(self, carried: int) -> dict[int, tuple[int, int, int]]:
        """Let each tower drift as a whole, back from the edge of the table."""
        shift: dict[int, tuple[int, int]] = {}
        moved = {}
        for thing in sorted(self.state.things, key=lambda t: self._level(t.name)):
            if thing.name == carried:
                continue
            foot = self.below.get(thing.name)
            if foot is None or foot == carried:
                shift[thing.name] = self._step(thing)
            else:
                shift[thing.name] = shift[foot]
            dx, dy = shift[thing.name]
            moved[thing.name] = (thing.x + dx, thing.y + dy, thing.z)
        return moved

    def _step(self, thing: Thing) -> tuple[int, int]:
        if thing.name not in self.speed:
            self.speed[thing.name] = (self.draw.randint(-10, 10), self.draw.randint(-10, 10))
        dx, dy = self.speed[thing.name]
        if not 0 <= thing.x + dx < self.side:
            dx = -dx
        if not 0 <= thing.y + dy < self.side:
            dy = -dy
        self.speed[thing.name] = dx, dy
        return dx, dy

    def _level(self, name: int) -> int:
        """Give how many things are below a thing."""
        count = 0
        while name in self.below:
            name, count = self.below[name], count + 1
        return count


def _distance2(one: Thing, other: Thing) -> int:
    return (one.x - other.x) ** 2 + (one.y - other.y) ** 2


def moved_count(frames: Sequence[Frame]) -> float:
    """Give how many things move in a frame, on average."""
    return sum(len(frame.moved) for frame in frames) / len(frames)
