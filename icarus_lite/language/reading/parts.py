"""What the parser hands on: forms, clauses and fields in the order the text states them.

`assembly` makes a `Domain` of them. Keeping the two apart lets fields come in any order, under
older names, and be reported with their place when they do not fit together.
"""

from __future__ import annotations

from typing import TypeAlias

from icarus_lite.language.diagnostics import Diagnostic
from icarus_lite.language.syntax import (
    Atom,
    Bind,
    Call,
    Condition,
    PerceptType,
    Span,
    Term,
)
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Word:
    """A keyword, name or title as it stands in the text; `text` of a string is its content."""

    text: str
    span: Span


@dataclass(frozen=True, slots=True)
class Command:
    """An entry of `:actions`; `starred` tells whether its name was written with a star."""

    atom: Atom
    starred: bool


FieldValue: TypeAlias = "Condition | Call | Bind | Atom | Command | Term | Word | Group"


@dataclass(frozen=True, slots=True)
class Field:
    """A field of a clause, task or test, such as `:elements (…)`."""

    keyword: Word
    values: tuple[FieldValue, ...]


@dataclass(frozen=True, slots=True)
class Group:
    """Fields in parentheses of their own: an entry of `:then`."""

    fields: tuple[Field, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Clause:
    """An entry of a concepts, skills, attachments or contradictions form: a pattern and fields."""

    head: Atom
    fields: tuple[Field, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Problem:
    """A conjunction of goals: an entry of the older form `create-problems`."""

    conditions: tuple[Condition, ...]
    span: Span


FormItem: TypeAlias = PerceptType | Clause | Condition | Field | Problem


@dataclass(frozen=True, slots=True)
class Form:
    """A top-level form.

    Args:
        keyword: Its first word.
        words: Its name and title, for the forms that have them.
        items: Percept types, clauses, conditions or fields.
        span: From its opening to its closing parenthesis.
    """

    keyword: Word
    words: tuple[Word, ...]
    items: tuple[FormItem, ...]
    span: Span


@dataclass(frozen=True, slots=True)
class Outcome:
    """What reading one text came to.

    Args:
        forms: The forms. With errors there are none, unless only parentheses were wrong: then they
            are the forms that were probably meant.
        problems: The errors.
        mended: The lines in which parentheses were mended to get there. What else seems wrong in
            them may come of that.
    """

    forms: tuple[Form, ...]
    problems: tuple[Diagnostic, ...]
    mended: frozenset[int] = frozenset()

    @property
    def is_whole(self) -> bool:
        """Whether all that the text says is there."""
        return bool(self.forms) or not self.problems


class MalformedTermError(Exception):
    """A number or string cannot be represented. It never leaves the reader.

    Args:
        span: The number, or the escape inside the string.
        message: What is wrong.
        hint: What to write instead.
    """

    def __init__(self, span: Span, message: str, hint: str) -> None:
        self.span = span
        self.message = message
        self.hint = hint
        super().__init__(message)
