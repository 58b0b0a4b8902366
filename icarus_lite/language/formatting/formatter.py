"""The canonical layout of a domain file.

The formatter knows parentheses, words and comments, not the grammar: it reads a text into a small
concrete tree, and writes the tree out again. Words, strings and numbers come out as they went in,
in the same order, so that the meaning cannot change; forms and fields which the grammar has yet to
gain are laid out like those it has.
"""

from __future__ import annotations

from icarus_lite.language.formatting.layout import lay_out
from icarus_lite.language.formatting.modern import modernized
from icarus_lite.language.formatting.reader import read_tree


def format_text(text: str, *, modernize: bool = False) -> str:
    """Give the text of a domain in its canonical layout; a second time changes nothing.

    Args:
        text: The text of a domain file. What stands between `; fmt: off` and `; fmt: on` on lines
            of their own comes out as it is.
        modernize: Whether older forms and fields are rewritten under their modern names.

    Returns:
        The laid out text, with LF line ends and one newline at its end. A text whose parentheses,
        quotes or comments do not match is returned as it is; whether a text is a domain is for
        `parse_domain` to say.

    Example:
        >>> print(format_text("(goals (on a b)(not(on b c)) ) ; at last"), end="")
        (goals
          (on a b)
          (not (on b c)))  ; at last
    """
    tree = read_tree(text)
    if tree is None:
        return text
    return lay_out(modernized(tree) if modernize else tree)
