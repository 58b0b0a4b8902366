"""The engines that are measured, behind one interface."""

from tabletop.engines.clingo_engine import ClingoEngine
from tabletop.engines.clips_engine import ClipsEngine
from tabletop.engines.engine import Engine
from tabletop.engines.network_engine import NetworkEngine, SnapshotEngine
from tabletop.engines.scratch_engine import ScratchEngine

__all__ = [
    "ClingoEngine",
    "ClipsEngine",
    "Engine",
    "NetworkEngine",
    "ScratchEngine",
    "SnapshotEngine",
]
