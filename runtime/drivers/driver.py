"""The driver protocol: how the loop talks to any body that can carry actions out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, TypeAlias, runtime_checkable

from aapa import Anchor
from icarus_lite import Action, Outcome

Joints: TypeAlias = tuple[float, float, float, float, float, float]
"""Joint angles from base to wrist 3, rad."""

Pose: TypeAlias = tuple[float, float, float, float, float, float]
"""x, y, z in m and a rotation vector in rad, in the base frame, of the tool centre point."""


@dataclass(frozen=True, slots=True)
class ArmState:
    """What the arm measures of itself.

    Args:
        joints: Measured joint angles, rad.
        tcp_pose: Measured tool centre point.
        gripper_closed: Whether the gripper's close output is on.
        gripped: Whether the gripper's sensor feels a part between its fingers.
        timestamp_s: The controller's own clock, s.
        force_n: How hard the tool presses down, N; 0 where nothing measures it.
        regrips: Whether the fingers are open only to take hold of the same part again.
    """

    joints: Joints
    tcp_pose: Pose
    gripper_closed: bool
    gripped: bool
    timestamp_s: float
    force_n: float = 0.0
    regrips: bool = False


class Driver(Protocol):
    """A body. One action runs at a time; nothing here blocks for longer than a cycle."""

    @property
    def commands(self) -> frozenset[str]:
        """The names of the commands it carries out, without the star."""

    def state(self) -> ArmState:
        """Give the newest measured state. Raises DriverError when the link is lost."""

    def start(
        self, action: Action, commands: Sequence[Action], anchors: Mapping[str, Anchor]
    ) -> None:
        """Begin an action, given by its driver commands, on the objects as anchored now.

        A command that cannot be carried out (unreachable, outside the limits) does not raise:
        the next `poll` reports the action as failed, with the reason, and nothing has moved.
        """

    def poll(self, anchors: Mapping[str, Anchor]) -> Outcome | None:
        """Report on the running action, once a cycle; None when no action is running."""

    def stop(self) -> None:
        """Bring the arm to a standstill and drop the running action. Safe to call at any time."""

    def close(self) -> None:
        """Stop the arm and let go of the connection. Never raises, never hangs."""


@runtime_checkable
class Recoverable(Protocol):
    """A body that can be made fit to be driven again after a stop or a loss.

    Only ever at the operator's word: whoever calls this has asked a person, who has looked at the
    arm and found that it may move.
    """

    def recover(self) -> str:
        """Make the arm fit to be driven again; the action that was under way stays failed.

        Unlike everything else here it may take half a minute. Nothing moves.

        Returns:
            What was done, as a sentence without its full stop.

        Raises:
            ControllerError: It cannot be; the text says what a person must do first. It may be
                called again then.
            DriverError: The driver was closed.
        """
