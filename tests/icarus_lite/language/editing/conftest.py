from __future__ import annotations

from pathlib import Path

import pytest

from icarus_lite.language.editing import File, Index

DOMAINS = Path(__file__).parents[4] / "domains"


@pytest.fixture(params=sorted(DOMAINS.glob("*.icr")), ids=lambda path: path.stem)
def shipped(request):
    """The text of each domain that is shipped."""
    return request.param.read_text(encoding="utf-8")


@pytest.fixture
def gearbox():
    return (DOMAINS / "gearbox.icr").read_text(encoding="utf-8")


@pytest.fixture
def reading():
    """Read a text as an index of one file, `it`."""
    return lambda text: Index([File.read("it", text)])
