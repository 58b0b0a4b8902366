"""The tables of the language reference, made of the tables in the code.

    python -m icarus_lite.language.reference docs/reference/language.md

replaces what stands between `<!-- table: NAME -->` and `<!-- end -->` in that page.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from icarus_lite.language.diagnostics import CODES
from icarus_lite.language.functions import FUNCTIONS
from icarus_lite.language.keywords import FIELDS, FORMS, IN_CLAUSES, MOMENTS, Keyword
from icarus_lite.language.reading.older import GONE_FIELDS, GONE_FORMS

_TABLE = re.compile(r"(<!-- table: ([a-z-]+) -->\n).*?(<!-- end -->)", re.DOTALL)


def tables() -> Mapping[str, str]:
    """Give the tables by name, in Markdown."""
    modern = [keyword for keyword in FORMS.values() if not keyword.modern]
    fields = [keyword for keyword in FIELDS.values() if not keyword.modern]
    every = (*FORMS.values(), *FIELDS.values(), *IN_CLAUSES.values())
    older = [keyword for keyword in every if keyword.modern]
    gone = {**{f"({name} …)": way for name, way in GONE_FORMS.items()}, **GONE_FIELDS}
    return {
        "forms": _table(("form", "what it is"), _documented(modern, "({} …)")),
        "fields": _table(("field", "what it is"), _documented(fields, "{}")),
        "moments": _table(
            ("moment", "of", "what it is"),
            (
                (f"`{name}`", f"a {form.removesuffix('s')}", moment.documentation)
                for form, moments in MOMENTS.items()
                for name, moment in moments.items()
            ),
        ),
        "older": _table(
            ("older name", "write"), ((f"`{each.name}`", f"`{each.modern}`") for each in older)
        ),
        "gone": _table(
            ("refused", "what to do instead"), ((f"`{name}`", way) for name, way in gone.items())
        ),
        "functions": _table(
            ("function", "takes", "gives", "what it is"),
            (
                (f"`{each.name}`", f"{each.takes}: {each.arity}", each.gives, each.documentation)
                for each in FUNCTIONS.values()
            ),
        ),
        "codes": _table(
            ("code", "what it says"),
            ((f"[{code}](#{code.lower()})", sentence) for code, sentence in CODES.items()),
        ),
    }


def with_tables(page: str) -> str:
    """Give a page with its tables as they are now.

    Raises:
        KeyError: The page asks for a table that there is none of.
    """
    known = tables()
    return _TABLE.sub(lambda match: f"{match[1]}{known[match[2]]}\n{match[3]}", page)


def _documented(keywords: Iterable[Keyword], shape: str) -> Iterable[tuple[str, str]]:
    return ((f"`{shape.format(each.name)}`", each.documentation) for each in keywords)


def _table(header: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    lines = (header, ("---",) * len(header), *rows)
    return "\n".join(f"| {' | '.join(cell.replace('|', '¦') for cell in row)} |" for row in lines)


if __name__ == "__main__":
    for name in sys.argv[1:]:
        path = Path(name)
        path.write_text(with_tables(path.read_text(encoding="utf-8")), encoding="utf-8")
