"""What can be told of a controller's address without driving it."""

from __future__ import annotations

import ipaddress
import socket
from typing import Final

RTDE_PORT: Final = 30004
"""The port of a UR controller's state stream, fixed in its clients."""


def is_loopback(address: str) -> bool:
    """Tell whether an address is this machine's own, so that no real arm can be behind it."""
    if address == "localhost":
        return True
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False


def answers(address: str, within_s: float = 0.5) -> bool:
    """Tell whether anybody takes a connection on a controller's state port."""
    try:
        with socket.create_connection((address, RTDE_PORT), timeout=within_s):
            return True
    except OSError:
        return False
