"""The simulated cell: arm, gripper, gearbox parts and an eye-in-hand camera, on MuJoCo."""

from __future__ import annotations

from runtime.cell.camera import CameraParameters, Segmentation
from runtime.cell.cell import Cell, CellParameters, Truth
from runtime.cell.detector import PERFECT, Detector, DetectorParameters, SegmentationDetector
from runtime.cell.layout import LayoutParameters
from runtime.cell.world import HandParameters, PlacedPart

__all__ = [
    "PERFECT",
    "CameraParameters",
    "Cell",
    "CellParameters",
    "Detector",
    "DetectorParameters",
    "HandParameters",
    "LayoutParameters",
    "PlacedPart",
    "Segmentation",
    "SegmentationDetector",
    "Truth",
]
