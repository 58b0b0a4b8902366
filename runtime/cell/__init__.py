"""The simulated cell: arm, gripper, gearbox parts and an eye-in-hand camera, on MuJoCo."""

from __future__ import annotations

from runtime.cell.acts import Act, PersonParameters, Report
from runtime.cell.arrangement import PlacedPart
from runtime.cell.camera import CameraParameters, Segmentation
from runtime.cell.cell import Cell, CellParameters, Truth
from runtime.cell.contact import Contact, Thread
from runtime.cell.detector import (
    PERFECT,
    POOR_LIGHT,
    Detector,
    DetectorParameters,
    SegmentationDetector,
)
from runtime.cell.layout import LayoutParameters
from runtime.cell.mishaps import Mishaps
from runtime.cell.person import Person
from runtime.cell.world import HandParameters

__all__ = [
    "PERFECT",
    "POOR_LIGHT",
    "Act",
    "CameraParameters",
    "Cell",
    "CellParameters",
    "Contact",
    "Detector",
    "DetectorParameters",
    "HandParameters",
    "LayoutParameters",
    "Mishaps",
    "Person",
    "PersonParameters",
    "PlacedPart",
    "Report",
    "Segmentation",
    "SegmentationDetector",
    "Thread",
    "Truth",
]
