"""The extra [neural]: is it there?"""

from __future__ import annotations

from importlib.util import find_spec

from aapa.errors import AnchoringError


def require_torch() -> None:
    """Make sure that PyTorch and safetensors are installed.

    Raises:
        AnchoringError: They are not; the text says how to install them.
    """
    if find_spec("torch") is None or find_spec("safetensors") is None:
        raise AnchoringError(
            "neural models need PyTorch and safetensors: pip install 'icarus-lite[neural]'"
        )
