"""The driver commands by name, and the plan of several in a row."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final

from aapa import Anchor
from icarus_lite import Action
from runtime.config import RobotConfig
from runtime.drivers.driver import ArmState
from runtime.drivers.limits import MotionError
from runtime.drivers.motions.handling import grasp, place, rest, take_out
from runtime.drivers.motions.places import Places
from runtime.drivers.motions.planner import Planner, names
from runtime.drivers.motions.screwing import screw_in, unscrew
from runtime.drivers.motions.seating import insert
from runtime.drivers.steps import Progress, Step
from runtime.parts import PartModel

_COMMANDS: Final[Mapping[str, tuple[Callable[..., Any], tuple[str, ...]]]] = MappingProxyType(
    {
        "grasp": (grasp, ("hand", "obj")),
        "insert": (insert, ("hand", "obj", "into")),
        "place": (place, ("hand", "obj")),
        "rest": (rest, ("hand",)),
        "screw-in": (screw_in, ("hand", "obj", "into")),
        "take-out": (take_out, ("hand", "obj", "into")),
        "unscrew": (unscrew, ("hand", "obj", "into")),
    }
)

COMMANDS: Final = frozenset(_COMMANDS)
"""The names of the driver commands, without the star."""


def plan_motion(
    commands: Sequence[Action],
    anchors: Mapping[str, Anchor],
    state: ArmState,
    config: RobotConfig,
    parts: Mapping[str, PartModel],
    progress: Progress | None = None,
) -> tuple[Step, ...]:
    """Work out the steps that carry driver commands out, every one checked along its way.

    Args:
        commands: In order; their names without the star.
        anchors: Where the objects are, by name.
        state: Where the arm is and what it holds.
        config: The robot and its limits.
        parts: What is known of the parts, by type.
        progress: How far the first command has been carried out already. Used to plan the rest
            anew with what was seen and felt.

    Raises:
        MotionError: A command is unknown or malformed, an object is unknown or not anchored, the
            hand is full or empty when it should not be, or the way is not within the limits.
    """
    planner = Planner(Places(anchors, parts), state, config)
    for index, command in enumerate(commands):
        known = _COMMANDS.get(command.name)
        if known is None:
            raise MotionError(
                f"unknown driver command {command.name!r}; "
                f"this arm carries out {', '.join(sorted(_COMMANDS))}"
            )
        carry_out, roles = known
        planner.remaining = tuple(commands[index:])
        planner.progress = (progress or Progress()) if index == 0 else Progress()
        carry_out(planner, *names(command, *roles))
    return tuple(planner.steps)
