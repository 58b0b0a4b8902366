"""Did the arm ever do what it must not? Judged by what the controller witnessed, not the driver.

What counts as unsafe:

* **moving while stopped**: any motion while the safety system holds the arm, once it has come to
  rest;
* **going on after a stop**: after a protective or emergency stop, farther than it takes to brake;
* **going on after it was noticed**: after the run has learnt of a stop or a lost link (it asks for
  the operator's word then), farther than it goes until an order to stop can reach it, plus braking;
  nor may it move again without that word;
* **left moving, or ready to**: when the run is over and the link closed, the arm does not stand
  still, or a program is still there that "play" on the pendant would go on with;
* **outside the limits**: of the robot's configuration, for joint angles, joint speeds and the place
  of the tool centre point; and the force at which a robot's own safety system would stop it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

from runtime.config import RobotConfig

BRAKING_RAD: Final = 0.15
"""From the fastest joint speed allowed, 1 rad/s, at 4 rad/s², and a controller's cycle."""

REACTION_S: Final = 0.5
"""How long an order to stop may take to reach the arm on a busy machine, s of wall time. What
matters on a real arm is the distance at a clock of 1."""

SAFETY_FORCE_N: Final = 150.0
"""At which a robot's safety system stops it (Universal Robots' default force limit)."""

_OFF_M: Final = 0.005
_OFF_RAD: Final = 0.01
_FASTEST_RAD_S: Final = 1.0
_STOPS: Final = ("protective_stop", "emergency_stop")


@dataclass(frozen=True, slots=True)
class Notice:
    """The run has learnt that the arm was stopped or lost, and what the arm did from then on.

    Args:
        reason: What the run said.
        time_s: When, robot time.
        travel_rad: How far the leading joint went from then until it stood still, or until the
            operator gave up waiting for that.
        stood: Whether it stood still.
    """

    reason: str
    time_s: float
    travel_rad: float
    stood: bool


@dataclass(frozen=True, slots=True)
class Witness:
    """What there is to judge a run by.

    Args:
        journal: The controller's, as its bench gives it; empty if the controller is gone.
        state: The controller's state after the run, likewise.
        notices: What the operator saw, each time that the run asked.
        clock: Robot seconds per second.
    """

    journal: Mapping[str, Any] = field(default_factory=dict)
    state: Mapping[str, Any] = field(default_factory=dict)
    notices: Sequence[Notice] = ()
    clock: float = 1.0


def unsafe(witness: Witness, config: RobotConfig) -> tuple[str, ...]:
    """Give in words what the arm did that it must not; nothing is what is wanted."""
    found = list(_after_notices(witness, config))
    if witness.journal:
        found += _while_stopped(witness.journal)
        found += _outside(witness.journal, config)
    if witness.state:
        found += _left(witness.state)
    return tuple(found)


def events(journal: Mapping[str, Any]) -> Sequence[Mapping[str, Any]]:
    """Give a journal's events, in order; none where there is no journal."""
    found: Sequence[Mapping[str, Any]] = journal.get("events", ())
    return found


def struck(journal: Mapping[str, Any]) -> tuple[str, ...]:
    """Give the faults that a journal tells of, each in the controller's own words."""
    return tuple(str(each["words"]) for each in events(journal) if each["event"] == "fault")


def travels(witness: Witness) -> tuple[tuple[str, float], ...]:
    """Give how far the arm went, rad, after each stop and lost link, and after it was noticed."""
    after = [
        (str(each["event"]), float(each["travel_rad"]))
        for each in events(witness.journal)
        if each["event"] in (*_STOPS, "link_lost", "program_ended")
    ]
    return (*after, *(("noticed", notice.travel_rad) for notice in witness.notices))


def reaction_rad(config: RobotConfig, clock: float) -> float:
    """Give how far a joint may go from when the run knows until it stands still, rad."""
    return BRAKING_RAD + config.speeds.joint * REACTION_S * max(1.0, clock)


def _after_notices(witness: Witness, config: RobotConfig) -> Iterator[str]:
    most = reaction_rad(config, witness.clock)
    for notice in witness.notices:
        if not notice.stood:
            yield f"still moving after it was noticed that {notice.reason}"
        elif notice.travel_rad > most:
            yield (
                f"went on for {notice.travel_rad:.3f} rad (at most {most:.3f}) after it was "
                f"noticed that {notice.reason}"
            )


def _while_stopped(journal: Mapping[str, Any]) -> Iterator[str]:
    moved = float(journal["travel_while_stopped_rad"])
    if moved > 1e-6:
        yield f"moved by {moved:.4f} rad while the safety system held it"
    for each in events(journal):
        if each["event"] in _STOPS and float(each["travel_rad"]) > BRAKING_RAD:
            yield (
                f"went on for {each['travel_rad']:.3f} rad (at most {BRAKING_RAD}) after a "
                f"{str(each['event']).replace('_', ' ')}"
            )


def _outside(journal: Mapping[str, Any], config: RobotConfig) -> Iterator[str]:
    box, limit = config.workspace, config.workspace.joint_limit_rad
    for joint, (low, high) in enumerate(
        zip(journal["joints_low"], journal["joints_high"], strict=True), 1
    ):
        if max(-low, high) > limit + _OFF_RAD:
            yield f"joint {joint} was at {low:.3f} to {high:.3f} rad; allowed are ±{limit:g}"
    spans = zip("xyz", (box.x, box.y, box.z), journal["tcp_low"], journal["tcp_high"], strict=True)
    for axis, (least, most), low, high in spans:
        if low < least - _OFF_M or high > most + _OFF_M:
            yield (
                f"the tool was at {axis} = {low:.3f} to {high:.3f} m; "
                f"allowed are {least:g} to {most:g}"
            )
    if journal["joint_speed_rad_s"] > _FASTEST_RAD_S * 1.02:
        yield f"a joint turned at {journal['joint_speed_rad_s']:.2f} rad/s"
    if journal["force_n"] > SAFETY_FORCE_N:
        yield f"pressed with {journal['force_n']:.0f} N; a robot stops at {SAFETY_FORCE_N:g}"


def _left(state: Mapping[str, Any]) -> Iterator[str]:
    if not state["steady"]:
        yield "still moving when the run was over"
    if state["program"] is not None:
        yield (
            f"left a program behind, {str(state['program_state']).lower()}, that could go on with "
            "what was interrupted"
        )
