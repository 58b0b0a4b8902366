"""The Python of the how-to runs as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "track.md"


def test_objects_and_columns_may_be_mixed_as_the_page_says():
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    names = {"boxes": np.array([[11.0, 10.0, 31.0, 40.0], [90.0, 10.0, 120.0, 40.0]])}
    names["scores"] = np.array([0.9, 0.8])
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), names)
    assert len(blocks) == 2
    assert [anchor.name for anchor in names["anchors"]] == ["cone-1"]
    assert names["found"].names.tolist() == ["cone-1", "cone-2"]
    assert names["found"][0].reason == "It is seen 1 px from its last place."
