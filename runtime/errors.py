"""What can go wrong in the body and the loop.

RuntimeFault
├── UsageError (ValueError)     the person asked for something that cannot be; exit status 2
├── ConfigError (ValueError)    a configuration value is wrong
├── ControllerError (OSError)   the controller cannot be started or reached
└── DriverError (RuntimeError)  the arm can no longer be driven: link lost, stopped, dead
"""

from __future__ import annotations


class RuntimeFault(Exception):  # noqa: N818 - the root of a tree, named for what it is
    """The root of every error this package raises on purpose. Its text is for the user."""


class UsageError(RuntimeFault, ValueError):
    """The person asked for something that cannot be done as asked."""


class ConfigError(RuntimeFault, ValueError):
    """A configuration value is wrong; the text names key, value and the allowed range."""


class ControllerError(RuntimeFault, OSError):
    """A controller cannot be started or reached (a busy port, a wrong model, nobody there)."""


class DriverError(RuntimeFault, RuntimeError):
    """The arm can no longer be driven. It has been stopped, or is beyond reach."""
