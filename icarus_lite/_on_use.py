"""Packages whose public names are imported when they are first used.

Whoever needs one name of a package, or only one of its modules, then does not wait for all the
others: a plan is found in less time than it takes to import what tells why a belief is not held.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping


def imported_on_use(package: str, homes: Mapping[str, str]) -> Callable[[str], object]:
    """Give a package's `__getattr__`, which is asked for a name as long as it is not there.

    No module may be called like a name of the package that it stands in: once it is imported, it
    would be found in the place of that name.

    Args:
        package: The package, by its full name.
        homes: For each public name the module of the package that has it, such as `engine`.
    """

    def imported(name: str) -> object:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        __import__(home := f"{package}.{homes[name]}")  # `importlib` takes as long as a module
        found = getattr(sys.modules[home], name)
        setattr(sys.modules[package], name, found)
        return found

    return imported
