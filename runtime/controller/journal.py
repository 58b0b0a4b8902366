"""The journal: what the controller itself has witnessed, for judging whether a run was safe.

It looks at nothing but the arm's own motion, cycle by cycle, and at what happened to it. It knows
nothing of what a client reports or believes, so it can contradict it.

Travel is the way of whichever joint turns most, summed up over the cycles, rad.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from runtime.controller.arm import Arm
from runtime.controller.motions import is_resting

MOST_EVENTS: Final = 10_000
"""Of the events, so many are kept for the query; a journal file has them all."""

_FOLLOWED: Final = frozenset(
    (
        *("protective_stop", "emergency_stop", "power_off", "program_ended", "program_paused"),
        *("link_lost", "watchdog", "fault"),
    )
)


@dataclass(slots=True)
class Event:
    """Something that happened, and how the arm came to rest after it.

    Args:
        kind: What it was, such as "protective_stop".
        time_s: When, robot time.
        words: What there is to say of it.
        travel_rad: How far the arm has travelled since, until it stood still.
        standstill_s: Robot time at which it stood still first; None while it has not.
    """

    kind: str
    time_s: float
    words: str
    travel_rad: float = 0.0
    standstill_s: float | None = None

    def to_json(self) -> dict[str, Any]:
        """Give it as JSON; travel and standstill only for what should stop an arm."""
        document: dict[str, Any] = {
            "event": self.kind,
            "time_s": round(self.time_s, 6),
            "words": self.words,
        }
        if self.kind in _FOLLOWED:
            document["travel_rad"] = round(self.travel_rad, 9)
            document["standstill_s"] = (
                None if self.standstill_s is None else round(self.standstill_s, 6)
            )
        return document


@dataclass(slots=True)
class _Extremes:
    """The furthest the arm has ever been, and the most it has felt."""

    joints_low: np.ndarray[Any, np.dtype[np.float64]]
    joints_high: np.ndarray[Any, np.dtype[np.float64]]
    tcp_low: list[float] = field(default_factory=lambda: [math.inf] * 3)
    tcp_high: list[float] = field(default_factory=lambda: [-math.inf] * 3)
    joint_speed: float = 0.0
    tcp_speed: float = 0.0
    force_n: float = 0.0
    moment_nm: float = 0.0


class Journal:
    """Watches one arm.

    Args:
        arm: The arm.
        now: Robot time, s.
    """

    def __init__(self, arm: Arm, now: Callable[[], float]) -> None:
        self.write: Callable[[str], None] | None = None
        """Where each event goes, as a line of JSON, once the arm has come to rest after it; None
        keeps them in memory only."""
        self.travel_rad = 0.0
        """How far the arm has travelled in all."""
        self._arm = arm
        self._now = now
        self._time_s = now()
        self._events: list[Event] = []
        self._forgotten = 0
        self._open: list[Event] = []
        self._last_q = arm.state.q
        self._last_tcp = arm.tcp_pose
        self._stood = False
        self._while_stopped_rad = 0.0
        self._ever = _Extremes(self._last_q, self._last_q)
        self._reach_out(arm.tcp_pose)

    def note(self, kind: str, words: str) -> None:
        """Write down that something happened now."""
        event = Event(kind, self._now(), words)
        if len(self._events) < MOST_EVENTS:
            self._events.append(event)
        else:
            self._forgotten += 1
        if kind not in _FOLLOWED:
            self._put(event)
        elif is_resting(self._arm.state.qd):
            event.standstill_s = event.time_s
            self._put(event)
        else:
            self._open.append(event)

    def observe(self, *, may_move: bool) -> None:
        """Look at the arm, once a cycle.

        Args:
            may_move: Whether the safety system lets it move.
        """
        arm, ever, time_s = self._arm, self._ever, self._now()
        dt, self._time_s = time_s - self._time_s, time_s
        force = arm.raw_wrench
        ever.force_n = max(ever.force_n, math.hypot(*force[:3]))
        ever.moment_nm = max(ever.moment_nm, math.hypot(*force[3:]))
        if arm.state.q is not self._last_q:
            self._follow(dt, stopped=not may_move and self._stood)
        resting = is_resting(arm.state.qd)
        self._stood = not may_move and (self._stood or resting)
        if resting and self._open:
            self._come_to_rest()

    def _follow(self, dt: float, *, stopped: bool) -> None:
        q, tcp = self._arm.state.q, self._arm.tcp_pose
        way = float(np.abs(q - self._last_q).max())
        self.travel_rad += way
        for event in self._open:
            event.travel_rad += way
        if stopped:
            self._while_stopped_rad += way
        ever = self._ever
        ever.joints_low = np.minimum(ever.joints_low, q)
        ever.joints_high = np.maximum(ever.joints_high, q)
        if dt > 0:
            ever.joint_speed = max(ever.joint_speed, way / dt)
            ever.tcp_speed = max(ever.tcp_speed, math.dist(tcp[:3], self._last_tcp[:3]) / dt)
        self._reach_out(tcp)
        self._last_q, self._last_tcp = q, tcp

    def _reach_out(self, tcp: tuple[float, ...]) -> None:
        ever = self._ever
        ever.tcp_low = [min(low, at) for low, at in zip(ever.tcp_low, tcp[:3], strict=True)]
        ever.tcp_high = [max(high, at) for high, at in zip(ever.tcp_high, tcp[:3], strict=True)]

    def _come_to_rest(self) -> None:
        for event in self._open:
            event.standstill_s = self._time_s
            self._put(event)
        self._open.clear()

    def _put(self, event: Event) -> None:
        if self.write is not None:
            self.write(json.dumps(event.to_json()))

    def close(self) -> None:
        """Write down what the arm has not come to rest after, and the summary."""
        for event in self._open:
            self._put(event)
        self._open.clear()
        if self.write is not None:
            self.write(json.dumps({"event": "summary", **self.summary()}))

    def summary(self) -> dict[str, Any]:
        """Give the extremes, as JSON.

        `travel_while_stopped_rad` is how far the arm moved while the safety system held it, after
        it had come to rest: anything but 0 would be a fault of this program.
        """
        ever = self._ever
        return {
            "time_s": round(self._time_s, 6),
            "travel_rad": round(self.travel_rad, 9),
            "travel_while_stopped_rad": round(self._while_stopped_rad, 9),
            "moves": self._arm.moves,
            "joints_low": ever.joints_low.tolist(),
            "joints_high": ever.joints_high.tolist(),
            "tcp_low": ever.tcp_low,
            "tcp_high": ever.tcp_high,
            "joint_speed_rad_s": ever.joint_speed,
            "tcp_speed_m_s": ever.tcp_speed,
            "force_n": ever.force_n,
            "moment_nm": ever.moment_nm,
        }

    def to_json(self) -> dict[str, Any]:
        """Give everything, as JSON: the summary, and the events in order."""
        return {
            **self.summary(),
            "events": [event.to_json() for event in self._events],
            "events_forgotten": self._forgotten,
        }
