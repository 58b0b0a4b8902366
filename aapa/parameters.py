"""The few numbers that anchoring depends on, each with its unit and its range."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Literal, TypeAlias

from aapa.costs import CENTRE, COSTS, OVERLAP, Cost
from aapa.errors import AnchoringError

Space: TypeAlias = Literal["image", "base"]
"""Where distances are measured: px in the image, or m in the robot's base frame."""

_LARGEST_BASE_TAU = 25.0
_FRACTIONS = (
    "confidence_gain",
    "confidence_loss",
    "sure_score",
    "initial_confidence",
    "min_anchor_confidence",
    "min_report_confidence",
)


@dataclass(frozen=True, slots=True)
class AnchoringParameters:
    """How much perception is trusted, and for how long.

    Args:
        tau: The largest squared centre distance at which a detection is still the object that
            was anchored there; squared px in image space, squared m in base space; above 0,
            and at most 25 in base space. Default 6500 px², a radius of 80.6 px.
        space: "image" measures between box centres in px, which needs a camera that stands
            still; "base" measures between positions in m, and every detection has to carry one.
            Default "image".
        cost: How detections are compared with anchors: "centre", the squared distance of the
            centres (default); "centre-and-size", the square of that distance and the difference
            of the mean sides, px²; "overlap", 1 less the boxes' intersection over union, with
            tau at most 1. In base space, where positions have no boxes, only "centre". A `Cost`
            of one's own does as well.
        position_gain: Share of the way an anchor goes to its new detection, in (0, 1]. 1, the
            default, takes the detection as it is; less makes a running mean for a noisy
            detector, for anchors that nothing carries.
        sure_score: Of detectors whose score falls with the visible share: a sighting that scores
            less is of something half hidden, whose middle is not where it seems. It does not
            move an anchor of full confidence that nothing carries, in [0, 1]. Default 0: every
            sighting does.
        confidence_gain: Added with each sighting, in (0, 1]. Default 0.1.
        confidence_loss: Taken with each unexplained miss, in (0, 1]. Default 0.1.
        initial_confidence: At the first sighting, in [0, 1]. Default 0.1.
        min_anchor_confidence: A lost anchor below this is not reasoned about, it only fades,
            in [0, 1]. Default 0.3.
        min_report_confidence: The confidence from which on anchors are returned, in [0, 1].
            Default 0.1.
        blink: For how many frames in a row the detector may miss what stands in front of something
            else, without an explanation, before it is held to hide it no longer; at least 0.
            Default 0: it has to be seen, or its absence explained, in the very frame.
        margin_px: Two boxes closer than this overlap, and a box closer than this to the border
            reaches out of the image, px, at least 0. Default 2.
        unique_types: Types of which one object is expected: the first is named by the bare
            type ("case"), a second one "case-2". All others are "cone-1", "cone-2", …
        reunite_after: After how many sightings in a row a second anchor of a unique type, whose
            first is not seen, is taken for the first; at least 1. None, the default, never.
        use_attachments: False leaves the attachments out of account, which is plain perceptual
            anchoring, the paper's PA. Default True.
        image_size: Width and height of the image, px, for a caller that has no camera to pass
            with the detections. Without either nothing is ever held to be out of view.

    Raises:
        AnchoringError: A value is out of its range or of another kind.

    Source: Liang et al. 2021, section III-B; the confidences are those of the authors' ICARUS
    module, squared pixels the reading of tau that fits the published tables.

    Example:
        >>> round(AnchoringParameters(tau=6500).radius, 1)
        80.6
    """

    tau: float = 6500.0
    space: Space = "image"
    cost: str | Cost = "centre"
    position_gain: float = 1.0
    sure_score: float = 0.0
    confidence_gain: float = 0.1
    confidence_loss: float = 0.1
    initial_confidence: float = 0.1
    min_anchor_confidence: float = 0.3
    min_report_confidence: float = 0.1
    blink: int = 0
    margin_px: float = 2.0
    unique_types: frozenset[str] = frozenset()
    reunite_after: int | None = None
    use_attachments: bool = True
    image_size: tuple[int, int] | None = None

    def __post_init__(self) -> None:
        if self.space not in ("image", "base"):
            raise AnchoringError(f'space is {self.space!r}; it has to be "image" or "base"')
        self._check_cost()
        self._check_tau()
        for name in ("position_gain", "confidence_gain", "confidence_loss"):
            if _number(name, getattr(self, name)) <= 0:
                raise AnchoringError(f"{name} is {getattr(self, name)!r}; it has to be above 0")
        for name in ("position_gain", *_FRACTIONS):
            if not 0 <= _number(name, getattr(self, name)) <= 1:
                raise AnchoringError(f"{name} is {getattr(self, name)!r}; it has to be within 0…1")
        if _number("margin_px", self.margin_px) < 0:
            raise AnchoringError(f"margin_px is {self.margin_px!r}; it has to be at least 0 px")
        if not _is_count(self.blink, 0):
            raise AnchoringError(
                f"blink is {self.blink!r}; it has to be a whole number of frames, at least 0"
            )
        if not isinstance(self.use_attachments, bool):
            raise AnchoringError(
                f"use_attachments is {self.use_attachments!r}; it has to be true or false"
            )
        self._check_containers()

    @property
    def radius(self) -> float:
        """The distance that `tau` stands for, px in image space and m in base space.

        Infinite with a cost that is no distance.
        """
        reach = self.comparison.reach
        return math.inf if reach is None else reach(self.tau)

    @property
    def comparison(self) -> Cost:
        """What `cost` stands for."""
        return COSTS[self.cost] if isinstance(self.cost, str) else self.cost

    @classmethod
    def from_mapping(cls, values: Mapping[str, object]) -> AnchoringParameters:
        """Make parameters of what a configuration file holds.

        Args:
            values: Parameter names and values; lists stand for `unique_types`, `image_size`.

        Raises:
            AnchoringError: A key is unknown, or a value wrong; the text names the key.

        Example:
            >>> AnchoringParameters.from_mapping({"tau": 3000, "unique_types": ["case"]}).tau
            3000
        """
        if not isinstance(values, Mapping):
            raise AnchoringError(f"the anchoring parameters are {values!r}; expected keys, values")
        known = [field.name for field in fields(cls)]
        unknown = [key for key in values if key not in known]
        if unknown:
            raise AnchoringError("; ".join(_unknown_key(key, known) for key in unknown))
        settings = dict(values)
        types = settings.get("unique_types")
        if isinstance(types, list | tuple | set) and all(isinstance(t, str) for t in types):
            settings["unique_types"] = frozenset(types)
        size = settings.get("image_size")
        if isinstance(size, list):
            settings["image_size"] = tuple(size)
        # Every value is checked by __post_init__, which the type checker cannot know.
        return cls(**settings)  # type: ignore[arg-type]

    def _check_cost(self) -> None:
        if isinstance(self.cost, Cost):
            return
        if self.cost not in tuple(COSTS):
            names = ", ".join(COSTS)
            raise AnchoringError(f"cost is {self.cost!r}; it has to be one of {names}")
        if self.space == "base" and self.cost != CENTRE.name:
            raise AnchoringError(
                f'cost is {self.cost!r}, which compares boxes; in base space it has to be "centre"'
            )
        if self.cost == OVERLAP.name and _number("tau", self.tau) > 1:
            raise AnchoringError(
                f"tau is {self.tau!r}; with the cost of overlap it is at most 1, where boxes "
                "share nothing"
            )

    def _check_tau(self) -> None:
        tau = _number("tau", self.tau)
        unit = "squared px" if self.space == "image" else "squared m"
        if tau <= 0:
            raise AnchoringError(f"tau is {self.tau!r}; it has to be above 0, in {unit}")
        if self.space == "base" and tau > _LARGEST_BASE_TAU:
            raise AnchoringError(
                f"tau is {self.tau!r}, a radius of {math.sqrt(tau):.0f} m: in base space it is in "
                f"squared m and at most {_LARGEST_BASE_TAU:.0f}; 0.01 is a radius of 0.1 m"
            )

    def _check_containers(self) -> None:
        if not _is_set_of_names(self.unique_types):
            raise AnchoringError(
                f"unique_types is {self.unique_types!r}; expected a set of type names"
            )
        if self.reunite_after is not None and not _is_count(self.reunite_after):
            raise AnchoringError(
                f"reunite_after is {self.reunite_after!r}; "
                "it has to be a whole number of at least 1, or null"
            )
        if self.image_size is not None and not _is_image_size(self.image_size):
            raise AnchoringError(
                f"image_size is {self.image_size!r}; expected a width and a height, in whole px"
            )


def _is_set_of_names(value: object) -> bool:
    return isinstance(value, frozenset) and all(isinstance(name, str) and name for name in value)


def _is_count(value: object, least: int = 1) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value >= least


def _is_image_size(value: object) -> bool:
    if not isinstance(value, tuple) or len(value) != 2:
        return False
    return all(isinstance(side, int) and not isinstance(side, bool) and side > 0 for side in value)


def _number(name: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise AnchoringError(f"{name} is {value!r}; it has to be a number")
    if not math.isfinite(value):
        raise AnchoringError(f"{name} is {value!r}; it has to be a finite number")
    return float(value)


def _unknown_key(key: object, known: list[str]) -> str:
    near = difflib.get_close_matches(str(key), known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(known)}"
    return f"unknown anchoring parameter {key!r}; {hint}"
