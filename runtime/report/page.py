"""The page: one file of HTML with everything in it, to be opened from disk."""

from __future__ import annotations

import html
import json
from collections.abc import Mapping
from importlib.resources import files


def page(contents: Mapping[str, object]) -> str:
    """Give the page for what `contents` has gathered."""
    template = (files("runtime") / "data" / "report.html").read_text(encoding="utf-8")
    data = json.dumps(contents, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
    title = html.escape(str(contents["title"]))
    return template.replace("{{title}}", title).replace("{{data}}", data, 1)
