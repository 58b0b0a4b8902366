"""What can go wrong in a run, and which reasons of a failed run are then true.

Each kind is data: who causes it, how its moment is drawn from the run's seed, and patterns of
what a run may truly give as its reason if it ends as failed. Whether a fault really struck is not
told by the plan but by a witness: the controller's journal, or the cell.
"""

from __future__ import annotations

import random
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from gearbox.plans import (
    Plan,
    Planner,
    during_motion,
    from_the_start,
    killed,
    mishap,
    moved,
    nothing,
    reaches_in,
    refusing,
    silent,
    taken,
)
from gearbox.trials import NO_FAULT, TASKS, Trial


class Cause(StrEnum):
    """Who causes a fault."""

    NOBODY = "nobody"
    CONTROLLER = "the controller"
    CELL = "the cell"
    PERSON = "the person"
    MACHINE = "the machine"


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of fault.

    Args:
        cause: Who causes it.
        words: What happens, for the page.
        plan: Draws what is to happen in a run of a task.
        signs: Patterns of what a witness tells when it has struck: see `judging.Judge.events`.
            `{part}` stands for the type of the task's part. The controller's faults are in its
            journal.
        reasons: Patterns of the reasons that are true if the run fails.
        takes: Whether the person takes parts away. That one is not seen is then a true reason, if
            it is really away in the end.
        tasks: The tasks in which it can happen; none stands for all.
    """

    cause: Cause
    words: str
    plan: Planner
    signs: tuple[str, ...] = ()
    reasons: tuple[str, ...] = ()
    takes: bool = False
    tasks: tuple[str, ...] = ()


WITHOUT_ATTACHMENTS: Final = (
    r"is not perceived",
    r"no longer anchored",
    r"is anchored [\d.]+ m away from its place in",
    r"is not anchored",
)
"""Reasons that are true of a run without attachments: what is hidden is lost from sight."""

_GONE: Final = (
    r"\b{part}\b.* is not perceived",
    r"\b{part} is no longer anchored",
    r"\(object {part} .*\^seen yes\)",
)
"""Reasons that are true of a part that a person has taken, as long as it is really away."""

_MOVED: Final = r"^moved by hand: {part}(-\d+)?$"

_LINK: Final = (
    r"the connection to the controller at \S+ was lost",
    r"has sent no new state for",
    r"the connection to the controller has hung",
    r"no longer answers",
    r"nothing passed between this program and the controller",
)
"""Reasons that are true of a link that is gone."""

KINDS: Final[Mapping[str, Kind]] = MappingProxyType(
    {
        NO_FAULT: Kind(Cause.NOBODY, "nothing goes wrong", nothing),
        "protective_stop": Kind(
            Cause.CONTROLLER,
            "the arm is stopped in the middle of a motion",
            during_motion("protective_stop"),
            reasons=(r"protective stop",),
        ),
        "emergency_stop": Kind(
            Cause.CONTROLLER,
            "somebody presses the emergency stop",
            during_motion("emergency_stop"),
            reasons=(r"emergency stop",),
        ),
        "drop_rtde": Kind(
            Cause.CONTROLLER, "the link is cut", during_motion("drop_rtde"), reasons=_LINK
        ),
        "stall": Kind(
            Cause.CONTROLLER,
            "the controller falls silent, its connections open",
            during_motion("stall", wall_s=(0.3, 5.0)),
            reasons=_LINK,
        ),
        "slow": Kind(
            Cause.CONTROLLER,
            "the controller runs at a fraction of its pace",
            during_motion("slow", factor=(1.5, 6.0), wall_s=(0.5, 5.0)),
            reasons=(*_LINK, r"a move planned to take"),
        ),
        "garbage": Kind(
            Cause.CONTROLLER,
            "random bytes come through the link",
            during_motion("garbage"),
            # The client itself dies of some.
            reasons=(*_LINK, r"the process that drives the arm ended by itself"),
        ),
        "kill_script": Kind(
            Cause.CONTROLLER,
            "somebody stops the program on the controller",
            during_motion("kill_script"),
            reasons=(r"the control program on .* was stopped",),
        ),
        "die": Kind(
            Cause.CONTROLLER,
            "the controller's power fails",
            during_motion("die"),
            (r"^the controller ended$",),
            _LINK,
        ),
        "refuse_remote": Kind(
            Cause.CONTROLLER,
            "the pendant is set to local control",
            from_the_start("refuse_remote"),
            # PolyScope 3 says nothing of it: the program does not start, and that is all.
            reasons=(r"remote control", r"did not start the control program"),
        ),
        "occupy_registers": Kind(
            Cause.CONTROLLER,
            "somebody else uses the controller's registers",
            from_the_start("occupy_registers"),
            reasons=(r"RTDE registers", r"registers are already in use"),
        ),
        "slip": Kind(
            Cause.CELL,
            "a part slips out of the fingers, each time with probability 0.5",
            mishap(slip_rate=0.5),
            (r"^slipped: ",),
            (r"no longer feels the part", r"\(holding \?hand \?obj\) no longer holds"),
        ),
        "jam": Kind(
            Cause.CELL,
            "an insertion jams, or a thread takes hold askew, each first time",
            mishap(jam_rate=1.0, cross_thread_rate=1.0),
            (r"jam", r"thread", r"above its seat"),
            (r"jammed", r"cross-threaded", r"above its seat"),
        ),
        "taken": Kind(
            Cause.PERSON,
            "the person takes the part away once it is in, says so, and puts it back on the table",
            taken(reports=True, back=True),
            (_MOVED,),
            takes=True,
        ),
        "taken_silently": Kind(
            Cause.PERSON,
            "the same without a word",
            taken(reports=False, back=True),
            (_MOVED,),
            takes=True,
        ),
        "kept": Kind(
            Cause.PERSON,
            "the person takes the part away once it is in, says so, and keeps it",
            taken(reports=True, back=False),
            (_MOVED,),
            takes=True,
        ),
        "moved": Kind(
            Cause.PERSON,
            "the person puts the part elsewhere while the robot is on its way to it",
            moved,
            (_MOVED,),
        ),
        "reaches_in": Kind(
            Cause.PERSON,
            "the person's hand is between camera and parts, three times",
            reaches_in,
            (r"^person: reach-in",),
        ),
        "refuses": Kind(
            Cause.PERSON,
            "the person does not do what is asked, each time with probability 0.5",
            refusing(0.5),
            (r"does not want to do that now",),
            (r"does not want to do that now",),
            tasks=("1.3", "2.2"),
        ),
        "silent": Kind(
            Cause.PERSON,
            "the person never says what is done",
            silent,
            (r"^person: ",),
            tasks=("1.3", "2.2"),
        ),
        "killed": Kind(
            Cause.MACHINE,
            "the program is killed at some cycle, and resumed from its trace",
            killed,
            (r"^killed$",),
        ),
    }
)
"""Every kind of fault, by its name."""


def plan_of(trial: Trial) -> Plan:
    """Draw what is to go wrong in a run; the same run has the same plan.

    Raises:
        KeyError: there is no such kind of fault.
    """
    rng = random.Random(f"{trial.fault} {trial.task} {trial.seed}")  # noqa: S311 - repeatable on purpose
    return KINDS[trial.fault].plan(rng, trial)


def applies(trial: Trial) -> bool:
    """Tell whether a run's fault can happen in its task."""
    tasks = KINDS[trial.fault].tasks
    return not tasks or trial.task in tasks


def signs_of(trial: Trial, events: Iterable[str]) -> tuple[str, ...]:
    """Give those of the events that witnesses tell which are signs that a run's fault struck."""
    part = re.escape(TASKS[trial.task].part)
    signs = [sign.replace("{part}", part) for sign in KINDS[trial.fault].signs]
    return tuple(event for event in events if any(re.search(sign, event) for sign in signs))


def true_reasons(trial: Trial, away: Iterable[str] = ()) -> tuple[str, ...]:
    """Give the patterns of the reasons that are true if a run fails.

    Args:
        trial: The run.
        away: The types of the task's parts that the person really has in the end.
    """
    kind = KINDS[trial.fault]
    own = kind.reasons if trial.attachments else (*kind.reasons, *WITHOUT_ATTACHMENTS)
    taken = [re.escape(part) for part in away] if kind.takes else []
    return (*own, *(each.replace("{part}", part) for part in taken for each in _GONE))
