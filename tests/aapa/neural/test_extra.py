"""Without the extra, what does not need it works, and what does says so."""

from __future__ import annotations

import subprocess
import sys

import pytest

from aapa import AnchoringError
from aapa.neural.extra import require_torch

WITHOUT = """
import sys
sys.modules["torch"] = sys.modules["safetensors"] = None
import numpy as np
from aapa.neural import attention_weights, slot_classes, tensor_of, tracked_slots
print(attention_weights(np.array([1])).shape)
"""


def test_features_and_guidance_need_no_torch():
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT], capture_output=True, text=True, check=False, timeout=60
    )
    assert (done.returncode, done.stdout.strip(), done.stderr) == (0, "(1, 15)", "")


def test_what_is_missing_is_named(monkeypatch: pytest.MonkeyPatch):
    require_torch()
    monkeypatch.setattr("aapa.neural.extra.find_spec", lambda name: None if name == "torch" else 1)
    with pytest.raises(AnchoringError, match=r"icarus-lite\[neural\]"):
        require_torch()
