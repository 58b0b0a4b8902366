"""Everything that can go wrong in the mind, as one tree.

IcarusError
├── DomainError (ValueError)        a domain file has problems; carries them all
├── NotStratifiedError (ValueError) a concept depends on its own negation
├── FrameError (ValueError)         a recorded frame, percept or action is malformed
├── TraceError (ValueError)         a trace cannot be read
└── InferenceError (ValueError)     a rule failed while it ran (a wrong type in a test, a budget)
"""

from __future__ import annotations


class IcarusError(Exception):
    """The root of every error this package raises on purpose."""


class FrameError(IcarusError, ValueError):
    """A recorded frame, percept or action is malformed.

    Args:
        message: What is wrong and what was expected.
        path: The file it stands in, if it came from one.
        line: The 1-based line in that file, or 0 if unknown.
    """

    def __init__(self, message: str, *, path: str = "", line: int = 0) -> None:
        self.message = message
        self.path = path
        self.line = line
        place = f"{path}:{line}: " if line else (f"{path}: " if path else "")
        super().__init__(place + message)


class TraceError(FrameError):
    """A trace cannot be read or written."""


class InferenceError(IcarusError, ValueError):
    """A rule failed while it ran, for example a number was compared with a symbol."""
