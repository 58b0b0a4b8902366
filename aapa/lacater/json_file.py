"""Reads a file of JSON, and says in words why it cannot."""

from __future__ import annotations

import json
from pathlib import Path

from aapa.errors import DatasetError


def read_json(path: Path) -> object:
    """Give what a file of JSON holds.

    Raises:
        DatasetError: There is no such file, it cannot be read, or is no JSON.
    """
    try:
        return json.loads(path.read_bytes())
    except FileNotFoundError as error:
        raise DatasetError("there is no such file", path=str(path)) from error
    except OSError as error:
        raise DatasetError(f"cannot be read: {error.strerror}", path=str(path)) from error
    except (ValueError, RecursionError) as error:
        raise DatasetError("is no JSON; it may be cut off or damaged", path=str(path)) from error
