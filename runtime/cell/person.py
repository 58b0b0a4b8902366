"""The person at the other side of the table: helps when asked, and sometimes does as they like.

One hand, moved smoothly from beside the table to the parts and back, on the arm's clock. It never
goes where the robot's tool is closer than `PersonParameters.distance_m`; it waits. What it does is
decided by what it is asked, a script and a seed: the same seed and the same motion of the arm give
the same acts.

| skill | what the person does |
|---|---|
| `hold base` | holds it where it stands, until `release`, or until something was pressed into it |
| `release base` | lets go of it |
| `put-in obj into` | fetches a part and seats it, a screw screwed in |
| `take-away obj` | takes a part from the table, or out of its seat, to their own side |
| `put-back obj [x y]` | puts a part down at a place of the table, or where they took it |
| `reach-in [obj]` | holds the hand over the middle of the table, or a part, for a while |
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from runtime.cell.acts import PersonParameters, Pointed, Report, When, check_act
from runtime.cell.body import REST, Body, body_at
from runtime.cell.errands import SKILLS, Done, Errand, Errands, Target
from runtime.cell.helping_hand import HelpingHand, Leg, StoppedError, Until
from runtime.cell.world import World
from runtime.parts import Vector

_FASTEST_S: Final = 0.35  # no motion of the hand is shorter
_HOLD: Final = "hold"
_REFUSAL: Final = "the person does not want to do that now"


@dataclass(frozen=True, slots=True)
class _Job:
    """Something to be done from a time on."""

    name: str
    targets: tuple[Target, ...]
    begins_s: float
    asked: bool
    refused: bool = False

    @property
    def args(self) -> tuple[str, ...]:
        return tuple(name for name, _ in self.targets)


class Person:
    """Somebody who shares the table with the robot.

    Args:
        world: The parts, and the robot's tool.
        seed: Of delays and refusals.
        parameters: How they behave.
    """

    def __init__(
        self, world: World, seed: int = 0, parameters: PersonParameters | None = None
    ) -> None:
        self._world = world
        self._parameters = parameters or PersonParameters()
        self._rng = np.random.default_rng([seed, 5])
        self._hand = HelpingHand(world, self._parameters.distance_m)
        self._errands = Errands(self._hand, world, self._is_released)
        self._waiting: list[_Job] = []
        self._script = list(self._parameters.acts)
        self._began_s: float | None = None
        self._now_s = 0.0
        self._before_s = 0.0
        self._seated_before: frozenset[str] = frozenset()
        self._job: _Job | None = None
        self._errand: Errand | None = None
        self._move: Leg | Until | None = None
        self._from: Vector = REST
        self._move_began_s = 0.0
        self._has_waited = False
        self._told = False
        self._pointed: tuple[Pointed | None, ...] = ()
        self._reports: list[Report] = []
        self._is_there = False
        self._let_go: Pointed | None = None

    @property
    def let_go(self) -> Pointed | None:
        """What they held when they were written down, and say that they have let go of since."""
        return self._let_go

    @property
    def body(self) -> Body | None:
        """Where the person's solids are; None as long as nobody has come to the table."""
        return body_at(self._hand.place) if self._is_there else None

    @property
    def place(self) -> Vector | None:
        """The middle of the person's palm, m; None as long as nobody has come to the table."""
        return self._hand.place if self._is_there else None

    @property
    def doing(self) -> str | None:
        """The skill that is under way, if any."""
        return None if self._job is None else self._job.name

    @property
    def holds(self) -> str | None:
        """The part the person holds where it stands, if any."""
        return self._hand.holds

    @property
    def carries(self) -> str | None:
        """The part the person carries, if any."""
        return self._hand.carries

    def ask(self, name: str, parts: Sequence[tuple[str, Vector | None]] = ()) -> None:
        """Ask for a skill.

        Args:
            name: The skill.
            parts: Its arguments as the asker names them, each with where the asker believes it
                to be, m in the base frame; None if that is not known, or for a number.

        Raises:
            UsageError: The person does not know that skill, or the arguments are too many or few.
        """
        targets = tuple((str(part), place) for part, place in parts)
        check_act(name, tuple(part for part, _ in targets))
        low, high = self._parameters.delay_s
        delay, chance = self._rng.random(2).tolist()
        begins = self._now_s + low + delay * (high - low)
        refused = chance < self._parameters.refuses
        self._waiting.append(_Job(name, targets, begins, asked=True, refused=refused))
        self._is_there = True

    def step(self, time_s: float) -> tuple[Report, ...]:
        """Go on to a time of the arm's clock, s; give what has ended since the last step.

        A person who does not report gives nothing.
        """
        if self._began_s is None:
            self._began_s = time_s
            self._seated_before = self._seated()
        now = max(self._now_s, time_s - self._began_s)
        self._follow_script(now)
        at = self._now_s
        self._now_s = now
        self._say_again(now)
        while self._advance(at, now):
            at = self._move_began_s
        reports, self._reports = tuple(self._reports), []
        return reports if self._parameters.reports else ()

    def snapshot(self) -> dict[str, object]:
        """Give what is needed to go on later, ready for JSON."""
        acts = self._parameters.acts
        left = [acts.index(act) for act in self._script]
        elapsed = math.floor(self._now_s) if left else 0
        return {
            **self._hand.snapshot(),
            "acts_left": left,
            "elapsed_s": elapsed,
            "there": self._is_there,
            "holds": self._hand.holds,
        }

    def restore(self, kept: Mapping[str, Any], carried: Iterable[str]) -> None:
        """Go on from what was written down.

        What was asked and not done is forgotten; what was held where it stands is let go.

        Args:
            kept: What `snapshot` gave.
            carried: The parts the person had in hand then.
        """
        self._hand.restore(kept, carried)
        self._hand.unpin()
        held = self._world.parts.get(str(kept.get("holds")))
        if held is not None and self._parameters.reports:
            self._let_go = Pointed(held.model.type, held.position)
        acts = self._parameters.acts
        left = kept.get("acts_left", range(len(acts)))
        self._script = [acts[index] for index in left if 0 <= index < len(acts)]
        self._before_s = float(kept.get("elapsed_s", 0))
        self._is_there = bool(kept.get("there", False))

    def _advance(self, at: float, now: float) -> bool:
        """Do what comes next between two times; give whether there may be more to do."""
        if self._job is None:
            due = self._due(now)
            if due is None:
                return False
            self._waiting.remove(due)
            self._job, self._told, self._move = due, False, None
            self._move_began_s = max(at, due.begins_s)
            self._pointed = () if due.asked else tuple(self._meant(name) for name in due.args)
            self._errand = SKILLS[due.name][1](self._errands, due.targets)
            if due.refused:
                self._end(_REFUSAL)
            return True
        if self._move is None:
            return self._next()
        if isinstance(self._move, Until):
            return self._wait(self._move, now)
        return self._go(self._move, now)

    def _next(self) -> bool:
        assert self._errand is not None, "a job has an errand"
        try:
            move = next(self._errand)
        except StopIteration:
            self._end()
        except StoppedError as stopped:
            self._end(str(stopped))
        else:
            if isinstance(move, Done):
                self._tell()
            else:
                self._move, self._from = move, self._hand.place
        return True

    def _wait(self, wait: Until, now: float) -> bool:
        if wait.ready():
            # What was not so at the last look has come about now; else nobody had to wait.
            began = now if self._has_waited else self._move_began_s
            self._move, self._move_began_s, self._has_waited = None, began, False
            return True
        self._has_waited = True
        if now - self._move_began_s < wait.limit_s:
            return False
        self._move, self._move_began_s, self._has_waited = None, now, False
        if wait.otherwise:
            self._end(f"{wait.otherwise} for {wait.limit_s:g} s")
        return True

    def _go(self, leg: Leg, now: float) -> bool:
        seconds = leg.seconds
        if seconds is None:
            way = math.dist(self._from, leg.target)
            seconds = max(_FASTEST_S, way / self._parameters.speed_m_s)
        share = min(1.0, (now - self._move_began_s) / seconds)
        # Least jerk from rest to rest (Flash and Hogan 1985), as people move their hands.
        smooth = share**3 * (10 - 15 * share + 6 * share**2)
        x, y, z = (a + smooth * (b - a) for a, b in zip(self._from, leg.target, strict=True))
        self._hand.move((x, y, z))
        if share < 1:
            return False
        self._move, self._move_began_s = None, self._move_began_s + seconds
        return True

    def _tell(self, reason: str = "") -> None:
        job = self._job
        assert job is not None, "only what is under way is told of"
        if not self._told:
            status: Literal["succeeded", "failed"] = "failed" if reason else "succeeded"
            report = Report(job.name, job.args, status, reason, job.asked, self._pointed)
            self._reports.append(report)
            self._told = True

    def _meant(self, name: str) -> Pointed | None:
        """Give what is meant by a name, where it is now; None if it is no thing that is there."""
        try:
            part = self._world.parts[self._hand.find(name, None)]
        except StoppedError:
            return None
        return Pointed(part.model.type, part.position)

    def _end(self, reason: str = "") -> None:
        """End what is under way. Who could not do it takes the hand back all the same."""
        self._tell(reason)
        failed, self._job, self._errand, self._move = bool(reason), None, None, None
        if failed and (self._hand.place != REST or self._hand.carries is not None):
            self._hand.unpin()
            self._job = _Job("go-home", (), self._now_s, asked=False)
            self._told = True
            self._errand = self._errands.go_home()

    def _say_again(self, now: float) -> None:
        """Say once more that something is being held, to whoever asks for just that."""
        held = self._hand.holds
        if held is None or self._job is None or not self._told:
            return
        for job in [job for job in self._waiting if job.begins_s <= now and job.name == _HOLD]:
            with contextlib.suppress(StoppedError):
                if self._hand.find(*job.targets[0]) == held:
                    self._waiting.remove(job)
                    self._reports.append(_answer(job))

    def _is_released(self) -> bool:
        """Tell whether somebody asks for something else than what is being held.

        What the person does of their own accord waits: who holds a part for a robot that presses
        on it does not let go of it for something else.
        """
        return any(job.asked and job.begins_s <= self._now_s for job in self._waiting)

    def _due(self, now: float) -> _Job | None:
        """Give what is to be begun next, if its time has come."""
        due = [job for job in self._waiting if job.begins_s <= now]
        return min(due, key=lambda job: job.begins_s) if due else None

    def _follow_script(self, now: float) -> None:
        for act in tuple(self._script):
            begins = None if act.at_s is None else max(0.0, act.at_s - self._before_s)
            if act.when is not None and self._has_come(act.when):
                begins = now
            if begins is not None and begins <= now:
                self._script.remove(act)
                targets = tuple((name, None) for name in act.args)
                job = _Job(act.name, targets, begins + act.after_s, asked=False)
                self._waiting.append(job)
                self._is_there = True

    def _has_come(self, when: When) -> bool:
        if when == "held":
            return self._world.held is not None
        return bool(self._seated() - self._seated_before)

    def _seated(self) -> frozenset[str]:
        return frozenset(part.name for part in self._world.parts.values() if part.seated)


def _answer(job: _Job) -> Report:
    """Give what is said at once to who asks for what is being done already."""
    if job.refused:
        return Report(job.name, job.args, "failed", _REFUSAL, job.asked)
    return Report(job.name, job.args, "succeeded", asked=job.asked)
