"""Pieces of the language given as text: goals and beliefs typed on a command line or in Python."""

from __future__ import annotations

from icarus_lite.language.reading.reader import read_fragment
from icarus_lite.language.syntax import Atom, Condition


def parse_conditions(text: str, path: str = "<goal>") -> tuple[Condition, ...]:
    """Read one or more literals: `(attached hubcover case)`, or several in a further pair of `()`.

    Raises:
        DomainError: The text is not a sequence of literals; the message points at the place.

    Example:
        >>> [str(c) for c in parse_conditions("((on a b) (not (on b c)))")]
        ['(on a b)', '(not (on b c))']
    """
    conditions = read_fragment(text, path, "conditions")
    return tuple([part for part in conditions if isinstance(part, Condition)])


def parse_atom(text: str, path: str = "<pattern>") -> Atom:
    """Read one pattern, such as `(attached ?obj case)`.

    Raises:
        DomainError: The text is not one pattern; the message points at the place.
    """
    (atom,) = read_fragment(text, path, "pattern")
    assert isinstance(atom, Atom)
    return atom
