"""The how-to on formatting says what the formatter does."""

from __future__ import annotations

import re
from pathlib import Path

from icarus_lite.language import parse_domain
from icarus_lite.language.formatting.formatter import format_text

PAGE = (Path(__file__).parents[4] / "docs" / "how-to" / "format.md").read_text(encoding="utf-8")
BEFORE, AFTER, OFF = re.findall(r"```lisp\n(.*?)```", PAGE, re.DOTALL)


def test_the_example_is_laid_out_as_shown():
    assert format_text(BEFORE) == AFTER
    assert parse_domain(BEFORE)[0] == parse_domain(AFTER)[0] is not None


def test_what_is_switched_off_is_left_alone():
    assert format_text(OFF) == OFF
