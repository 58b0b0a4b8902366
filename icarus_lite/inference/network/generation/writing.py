"""Writing Python source line by line, with its indentation."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager


class Lines:
    """Source in the making."""

    __slots__ = ("_depth", "_lines")

    def __init__(self, depth: int = 0) -> None:
        self._lines: list[str] = []
        self._depth = depth

    def add(self, *lines: str) -> None:
        """Append lines at the present indentation; an empty one stays empty."""
        indent = "    " * self._depth
        self._lines.extend(indent + line if line else "" for line in lines)

    @contextmanager
    def block(self, opening: str) -> Iterator[None]:
        """Append a line such as `for a in near:`; what is added inside is its body."""
        self.add(opening)
        self._depth += 1
        yield
        self._depth -= 1

    def indent(self, by: int = 1) -> None:
        """Indent what follows, or take that back with a negative number."""
        self._depth += by

    @property
    def depth(self) -> int:
        """How deep the next line will be indented."""
        return self._depth

    def __str__(self) -> str:
        return "\n".join(self._lines) + "\n"
