"""Drivers: bodies that carry actions out."""

from __future__ import annotations

from runtime.drivers.driver import ArmState, Driver, Recoverable
from runtime.drivers.dry_run import DryRunDriver
from runtime.drivers.limits import MotionError
from runtime.drivers.motions import plan_motion
from runtime.drivers.stepping import PARK
from runtime.drivers.steps import Grip, Look, MoveJoints, MoveLinear, Press, Step, Tare, Turn
from runtime.drivers.ur import UrDriver

__all__ = [
    "PARK",
    "ArmState",
    "Driver",
    "DryRunDriver",
    "Grip",
    "Look",
    "MotionError",
    "MoveJoints",
    "MoveLinear",
    "Press",
    "Recoverable",
    "Step",
    "Tare",
    "Turn",
    "UrDriver",
    "plan_motion",
]
