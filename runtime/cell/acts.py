"""What a person may be asked or told to do: acts, how they behave, what they report."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

from runtime.cell.errands import SKILLS
from runtime.errors import UsageError
from runtime.parts import Vector

When: TypeAlias = Literal["held", "inserted"]
"""An occasion: the robot first holds a part, or has first inserted one."""


@dataclass(frozen=True, slots=True)
class Act:
    """Something the person does without being asked.

    Args:
        name: A skill of the person.
        args: Parts by name or type; places as numbers in text.
        at_s: When, s on the arm's clock from the first step on.
        when: Instead: once the robot first holds a part, or has first inserted one.
        after_s: This much later.
    """

    name: str
    args: tuple[str, ...] = ()
    at_s: float | None = None
    when: When | None = None
    after_s: float = 0.0

    def __post_init__(self) -> None:
        """Check it. Raises UsageError."""
        check_act(self.name, self.args)
        if (self.at_s is None) == (self.when is None):
            raise UsageError(f"The act {self.name!r} needs either at_s or when, and not both.")


@dataclass(frozen=True, slots=True)
class PersonParameters:
    """How the person behaves.

    Args:
        acts: What they do unasked.
        reports: Whether they tell what they have done.
        delay_s: From and to, how long they take to begin with what they are asked, s.
        refuses: Probability that they do not do what they are asked.
        speed_m_s: The hand's mean speed on its way.
        distance_m: How close to the robot's tool the hand goes, at the closest.
    """

    acts: tuple[Act, ...] = ()
    reports: bool = True
    delay_s: tuple[float, float] = (1.0, 3.0)
    refuses: float = 0.0
    speed_m_s: float = 0.4
    distance_m: float = 0.15

    def __post_init__(self) -> None:
        """Check the numbers. Raises UsageError."""
        if not 0 <= self.refuses <= 1:
            raise UsageError(f"refuses = {self.refuses:g} is no probability; expected 0 to 1.")
        low, high = self.delay_s
        if not 0 <= low <= high:
            raise UsageError(f"delay_s = {self.delay_s!r}; expected from and to, s, from 0 on.")
        if self.speed_m_s <= 0 or self.distance_m < 0:
            raise UsageError("The hand's speed must be above 0, its distance at least 0.")


@dataclass(frozen=True, slots=True)
class Pointed:
    """A thing as somebody tells of it who points: "this bearing, which was there".

    Args:
        type: What it is.
        place: Where it was when they began, m in the base frame.
    """

    type: str
    place: Vector


@dataclass(frozen=True, slots=True)
class Report:
    """What has ended: a skill, the names as they were asked, and how.

    Args:
        name: The skill.
        args: Its arguments as they were given.
        status: "succeeded" or "failed".
        reason: Why it failed.
        asked: Whether somebody had asked for it.
        pointed: Of what nobody had asked for: for each argument the thing that is meant; None for
            what is no thing.
    """

    name: str
    args: tuple[str, ...]
    status: Literal["succeeded", "failed"]
    reason: str = ""
    asked: bool = True
    pointed: tuple[Pointed | None, ...] = ()


def check_act(name: str, args: tuple[str, ...]) -> None:
    """Raise UsageError unless the person knows a skill that takes so many arguments."""
    if name not in SKILLS:
        raise UsageError(f"The person does not know {name!r}, only {', '.join(SKILLS)}.")
    counts = SKILLS[name][0]
    if len(args) not in counts:
        expected = " or ".join(str(count) for count in counts)
        raise UsageError(
            f"({' '.join((name, *args))}): {len(args)} arguments; expected {expected}."
        )
