"""The stand-in UR controller: a process that speaks what ur-rtde expects of a control box.

It is not a robot and not URSim. It executes the client's own uploaded URScript on a kinematic
arm model, so that the real client can be driven, and be hurt by faults, without hardware. It
proves the client's side and our reaction to faults; it proves nothing about forces, accuracy
or certified safety.

Sources: Universal Robots, "Real-Time Data Exchange (RTDE) Guide", "Dashboard Server" and "The
URScript Programming Language".
"""

from __future__ import annotations

from runtime.controller.process import ControllerProcess

__all__ = ["ControllerProcess"]
