"""What can go wrong in the eyes.

AnchoringError (ValueError)     a detection, an attachment or a parameter is malformed
└── RecordingError              so is a line of a recorded file; carries file, line and key
"""

from __future__ import annotations


class AnchoringError(ValueError):
    """The root of every error this package raises on purpose. Its text is for the user."""


class RecordingError(AnchoringError):
    """A line of a recording cannot be read.

    Args:
        message: What is wrong and what was expected.
        path: The file it stands in.
        line: The 1-based line in that file.
        key: The key that is wrong, or "" when the whole line is.
    """

    def __init__(self, message: str, *, path: str, line: int, key: str = "") -> None:
        self.message = message
        self.path = path
        self.line = line
        self.key = key
        where = f"{path}:{line}: " + (f"key {key!r}: " if key else "")
        super().__init__(where + message)
