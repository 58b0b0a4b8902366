"""The ports of a UR control box, fixed in its clients, and the stand-in's own bench port."""

from __future__ import annotations

from typing import Final

NAME: Final = "stand-in controller"
"""What this program calls itself, everywhere, so that nobody takes it for a robot."""

BANNER: Final = f"{NAME} (not a robot, not URSim)"
"""The name with what it is not, for greetings and log lines."""

BENCH_PORT: Final = 29950
"""The stand-in's own: JSON lines for what a cell or a test wires to the controller."""

DASHBOARD_PORT: Final = 29999
"""Line commands: play, stop, unlock, modes."""

SCRIPT_PORTS: Final = (30001, 30002, 30003)
"""Primary, secondary and real-time interface; here they take programs and stay silent."""

RTDE_PORT: Final = 30004
"""The state stream and the input registers."""

PORTS: Final = (BENCH_PORT, DASHBOARD_PORT, *SCRIPT_PORTS, RTDE_PORT)
"""All ports of one controller."""

BUSY: Final = "is already in use"
"""Part of the refusal to start on a busy port, by which it is told from other refusals."""
