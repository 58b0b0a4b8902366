"""The version of icarus-lite, stated once."""

__version__ = "0.1.0"
