"""What can go wrong in the eyes.

AnchoringError (ValueError)     a detection, an attachment or a parameter is malformed
├── RecordingError              so is a line of a recorded file; carries file, line and key
└── DatasetError                so is a file of a data set; carries file and key
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


class DatasetError(AnchoringError):
    """A file of a data set cannot be read, or two of them contradict each other.

    Args:
        message: What is wrong and what was expected.
        path: The file, or the folder it should lie in.
        key: The key or entry that is wrong, or "" when the whole file is.
    """

    def __init__(self, message: str, *, path: str, key: str = "") -> None:
        self.message = message
        self.path = path
        self.key = key
        super().__init__(f"{path}: " + (f"{key}: " if key else "") + message)

    def __reduce__(self) -> tuple[object, ...]:
        """Let the error come back from another process as it was."""
        return _dataset_error, (self.message, self.path, self.key)


def _dataset_error(message: str, path: str, key: str) -> DatasetError:
    return DatasetError(message, path=path, key=key)
