from __future__ import annotations

import runpy
from pathlib import Path
from xml.etree import ElementTree as ET

EDITORS = Path(__file__).parents[2] / "editors"
SVG = "{http://www.w3.org/2000/svg}"


def test_the_picture_shows_every_mistake_under_its_word():
    drawn = runpy.run_path(str(EDITORS / "picture.py"))
    root = ET.fromstring(drawn["picture"]())
    words = [each.text for each in root.iter(f"{SVG}text")]
    assert "there is no function `distanse`  " in words
    assert "nothing is ever known about `in-reech`  " in words
    waves = list(root.iter(f"{SVG}polyline"))
    assert len(waves) == len(list(root.iter(f"{SVG}circle"))) >= 5
