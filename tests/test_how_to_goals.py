"""The pages on goals and on agents: their domains, programs and what these print."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from icarus_lite.language import check_domain, format_text, parse_domain

FOLDER = Path(__file__).parents[1] / "docs" / "how-to"
PAGES = {"goals.md": "tables.icr", "agents.md": "assembly.icr"}


def blocks(page, language):
    text = (FOLDER / page).read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.mark.parametrize("page", PAGES)
def test_the_domain_of_the_page_is_sound_and_laid_out(page):
    (text,) = blocks(page, "lisp")
    domain, found = parse_domain(text)
    assert (found, check_domain(domain)) == ((), ())
    assert format_text(text) == text


@pytest.mark.parametrize("page", PAGES)
def test_the_programs_of_the_page_print_what_it_says(page, tmp_path):
    (text,) = blocks(page, "lisp")
    (tmp_path / PAGES[page]).write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", "\n".join(blocks(page, "python"))],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    printed = [line.rstrip() for line in done.stdout.splitlines()]
    assert printed == "".join(blocks(page, "text")).splitlines()
