"""What of a run's beliefs was true. The ground truth is used here, to judge, and nowhere else."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np
from scipy.optimize import linear_sum_assignment

from aapa import Anchor
from gearbox.rows import Episode, Places, Trouble
from gearbox.trials import Benchmark
from icarus_lite import DecisionKind, Status
from icarus_lite.symbols import ATTACHED
from runtime.cycle_report import CycleReport

HOLDING: Final = "holding"
"""The robot's hand holds a part."""

HELD: Final = "held"
"""The person holds a part where it stands."""

ASTRAY_M: Final = 0.06
"""What is farther than this from an anchor is taken for another object: the root of `tau` in
`runtime/data/anchoring.yaml`."""

_FAR_M: Final = 10.0
_OWN_SIDE_M: Final = 0.75  # beyond it nothing is in reach, or in view
_MOVED_M: Final = 0.03


class TruePart(Protocol):
    """What the judge has to know of a part."""

    @property
    def name(self) -> str:
        """Unique."""

    @property
    def position(self) -> tuple[float, float, float]:
        """Its centre in the base frame, m."""


class Colleague(Protocol):
    """What the judge has to know of the person."""

    @property
    def doing(self) -> str | None:
        """The skill that is under way, if any."""

    @property
    def holds(self) -> str | None:
        """The part that is held where it stands, if any."""

    @property
    def carries(self) -> str | None:
        """The part that is carried, if any."""


class Truth(Protocol):
    """What the judge has to know of the world: `runtime.cell.Truth` has it."""

    @property
    def parts(self) -> Mapping[str, TruePart]:
        """Every part, by a name such as "bearing-2"."""

    @property
    def held(self) -> str | None:
        """Name of the part in the robot's hand, if any."""

    @property
    def person(self) -> Colleague:
        """Who else is at the table."""

    @property
    def seated(self) -> Mapping[str, str]:
        """The parts that sit in a seat, each with the part it sits in."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What was true of a run.

    Args:
        true: Whether the task was really done in the end.
        away: The types of the task's parts that the person has in the end, in hand or on their own
            side of the table.
        false_at_end: Beliefs of the last cycle that were not true.
        episodes: What was believed without being true, at any time.
        places: How far anchors were from their objects.
        troubles: Actions that failed or were aborted.
        withdrawn: Beliefs that perception contradicted, in words.
        events: What was seen to happen: parts that slipped, or were moved by other hands, what
            the person did, and the reasons of actions that failed. Each once, in order.
        actions: How many actions were begun.
        robot_s: From the first cycle to the last, on the arm's clock, s.
    """

    true: bool
    away: tuple[str, ...]
    false_at_end: tuple[str, ...]
    episodes: tuple[Episode, ...]
    places: Places
    troubles: tuple[Trouble, ...]
    withdrawn: tuple[str, ...]
    events: tuple[str, ...]
    actions: int
    robot_s: float


def kind_of(name: str) -> str:
    """Give the type of a part or of an anchor by its name: "bearing-2" is a bearing."""
    stem, dash, number = name.rpartition("-")
    return stem if dash and number.isdigit() else name


def identities(
    anchors: Sequence[Anchor], parts: Iterable[TruePart]
) -> dict[str, tuple[TruePart, float]]:
    """Say which part each anchor stands for, and how far (m) it is from it.

    A detector does not tell parts of one type apart, so the anchors of a type are shared out among
    its parts at the least total distance. An anchor that is one too many stands for nothing.
    """
    by_kind: dict[str, list[TruePart]] = {}
    for part in parts:
        by_kind.setdefault(kind_of(part.name), []).append(part)
    wanted: dict[str, list[Anchor]] = {}
    for anchor in anchors:
        if anchor.type in by_kind:
            wanted.setdefault(anchor.type, []).append(anchor)
    found: dict[str, tuple[TruePart, float]] = {}
    for kind, named in wanted.items():
        there = by_kind[kind]
        apart = np.array([[_apart(anchor, part) for part in there] for anchor in named])
        for row, column in zip(*linear_sum_assignment(apart), strict=True):
            found[named[row].name] = (there[column], float(apart[row, column]))
    return found


def _apart(anchor: Anchor, part: TruePart) -> float:
    return _FAR_M if anchor.position is None else math.dist(anchor.position, part.position)


def is_done(benchmark: Benchmark, truth: Truth) -> bool:
    """Tell whether a task is really done: all is seated, and the hand holds none of it."""
    return all(
        any(
            kind_of(name) == child and kind_of(into) == parent
            for name, into in truth.seated.items()
        )
        for child, parent in benchmark.seated
    ) and (truth.held is None or kind_of(truth.held) not in dict(benchmark.seated))


def taken_away(benchmark: Benchmark, truth: Truth) -> set[str]:
    """Give the types of a task's parts that the person has, in hand or on their own side."""
    wanted = {kind for pair in benchmark.seated for kind in pair}
    return {
        kind_of(part.name)
        for part in truth.parts.values()
        if kind_of(part.name) in wanted
        and (part.name == truth.person.carries or part.position[0] > _OWN_SIDE_M)
    }


class Judge:
    """Watches a run beside the ground truth; give it to the loop as its observer.

    Args:
        benchmark: The task.
        truth: The world's.
        hand: The symbol of the robot's hand.
    """

    def __init__(self, benchmark: Benchmark, truth: Truth, hand: str) -> None:
        self._benchmark = benchmark
        self._truth = truth
        self._hand = hand
        self._identities: dict[str, str] = {}
        self._open: dict[str, Episode] = {}
        self._closed: list[Episode] = []
        self._began_s: dict[str, float] = {}
        self._distances: list[float] = []
        self._last: list[float] = []
        self._phantoms = 0
        self._under_way = ""
        self._troubles: list[Trouble] = []
        self._withdrawn: list[str] = []
        self._actions = 0
        self._events: dict[str, None] = {}
        self._held: str | None = None
        self._stood: dict[str, tuple[float, float, float]] = {}
        self._first_s: float | None = None
        self._now_s = 0.0

    def __call__(self, report: CycleReport) -> None:
        """Judge a cycle."""
        self._now_s = report.arm.timestamp_s
        if self._first_s is None:
            self._first_s = self._now_s
        self._follow(report)
        self._witness(report)
        self._compare_places(report.anchors)
        self._compare_beliefs(report)
        self._note_action(report)

    def verdict(self) -> Verdict:
        """Give what was true of the run so far."""
        places = Places(
            len(self._distances),
            sum(distance > ASTRAY_M for distance in self._distances),
            1e3 * statistics.median(self._distances) if self._distances else 0.0,
            1e3 * max(self._last, default=0.0),
            self._phantoms,
        )
        return Verdict(
            is_done(self._benchmark, self._truth),
            tuple(sorted(taken_away(self._benchmark, self._truth))),
            tuple(sorted(self._open)),
            (*self._closed, *self._open.values()),
            places,
            tuple(self._troubles),
            tuple(self._withdrawn),
            tuple(self._events),
            self._actions,
            0.0 if self._first_s is None else self._now_s - self._first_s,
        )

    def _follow(self, report: CycleReport) -> None:
        for outcome in report.outcomes:
            if outcome.status is Status.RUNNING:
                continue
            if str(outcome.action) == self._under_way:
                self._under_way = ""
            if outcome.status is Status.FAILED:
                self._troubles.append(
                    Trouble(report.decision.cycle, str(outcome.action), outcome.reason)
                )
        # Domains without contradictions, and older traces, have none.
        withdrawn = getattr(report.decision, "withdrawn", ())
        self._withdrawn += [str(each) for each in withdrawn]

    def _witness(self, report: CycleReport) -> None:
        """Note what happens in the world, whatever anybody makes of it."""
        held = self._truth.held
        if self._held is not None and held is None and report.arm.gripper_closed:
            self._events[f"slipped: {self._held}"] = None
        for name, part in self._truth.parts.items():
            moved = math.dist(self._stood.setdefault(name, part.position), part.position) > _MOVED_M
            if moved and name not in {held, self._held}:
                self._events[f"moved by hand: {name}"] = None
            # From a cycle to the next a hand goes but a little way: it is the sum that tells.
            if moved or name in {held, self._held}:
                self._stood[name] = part.position
        self._held = held
        doing = self._truth.person.doing
        if doing is not None:
            self._events[f"person: {doing}"] = None
        # What the cell itself knows to have gone wrong, if it tells.
        told = (*getattr(self._truth, "mishaps", ()), *(each.reason for each in self._troubles))
        self._events.update(dict.fromkeys(told))

    def _note_action(self, report: CycleReport) -> None:
        decision = report.decision
        if decision.kind is DecisionKind.ACT and decision.step is not None:
            self._under_way = str(decision.step.action)
            self._actions += 1

    def _compare_places(self, anchors: Sequence[Anchor]) -> None:
        kinds = {kind_of(name) for name in self._truth.parts}
        mine = [anchor for anchor in anchors if anchor.type in kinds]
        found = identities(mine, self._truth.parts.values())
        self._identities.update((name, part.name) for name, (part, _) in found.items())
        self._last = [
            found[anchor.name][1]
            for anchor in mine
            if anchor.name in found and anchor.position is not None
        ]
        self._distances += self._last
        self._phantoms = len(mine) - len(found)

    def _compare_beliefs(self, report: CycleReport) -> None:
        cycle, false = report.decision.cycle, set(self._false(report))
        for belief, known in list(self._open.items()):
            lasted = round(self._now_s - self._began_s[belief], 3)
            self._open[belief] = replace(known, seconds=lasted)
            if belief not in false:
                self._closed.append(self._open.pop(belief))
        for belief in sorted(false):
            if belief not in self._open:
                self._began_s[belief] = self._now_s
                self._open[belief] = Episode(belief, cycle, 0, 0.0, self._under_way)
            known = self._open[belief]
            over = not known.during or self._under_way != known.during
            self._open[belief] = replace(
                known, cycles=known.cycles + 1, outlived=known.outlived or over
            )

    def _false(self, report: CycleReport) -> Iterator[str]:
        state, truth = report.decision.state, self._truth
        for child, parent in state.hierarchy.pairs():
            if not self._is_attached(str(child), str(parent)):
                yield f"({ATTACHED} {child} {parent})"
        for belief, _ in state.asserted():
            objects = [self._part(str(each)) for each in belief.args]
            if belief.predicate == HOLDING and objects != [self._hand, truth.held]:
                yield str(belief)
            if belief.predicate == HELD and objects != [truth.person.holds]:
                yield str(belief)

    def _is_attached(self, child: str, parent: str) -> bool:
        part = self._part(child)
        if parent == self._hand:
            return self._truth.held == part
        return self._truth.seated.get(part) == self._part(parent)

    def _part(self, name: str) -> str:
        """Give the part that a symbol stands for, or stood for when it was last anchored."""
        return self._identities.get(name, name)
