"""The simulated cell: an arm's measured joints go in, detections of an eye-in-hand camera come out.

It stands where a real cell would: it is told what the arm measures of itself and moves the world
accordingly, and it shows what a camera on the flange would see. What is really where is known to
`Cell.truth` alone, which exists for tests, for judging results, and for the simulated person.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, Final, Self

import numpy as np

from aapa import Camera, Detection
from runtime.cell.acts import PersonParameters
from runtime.cell.arrangement import PlacedPart
from runtime.cell.camera import CameraParameters, Eye, Segmentation
from runtime.cell.contact import Contact
from runtime.cell.detector import DetectorParameters, SegmentationDetector
from runtime.cell.layout import LayoutParameters, random_layout
from runtime.cell.mishaps import Fate, Mishaps
from runtime.cell.person import Person
from runtime.cell.scene import Scene
from runtime.cell.world import HandParameters, World
from runtime.errors import UsageError
from runtime.kinematics import MODELS, ArmModel, Joints, Matrix, forward, inverse, nearest
from runtime.parts import PartModel, load_parts

TCP_M: Final = 0.15
"""From the flange to the tool centre point between the fingertips, along the tool, m."""

LOOK_TCP_M: Final = (0.30, 0.0, 0.42)
"""Tool centre point of the look pose, m; the tool points down, the camera is beyond it."""

_LOOK_LIKE: Final = (2.9, -1.7, 1.4, -1.3, -1.57, -1.8)  # elbow up, in front of the base


@dataclass(frozen=True, slots=True)
class CellParameters:
    """Everything that can be set in the simulated cell.

    Args:
        layout: Which parts, and where they may stand.
        hand: How forgiving gripping and seating are.
        camera: Optics and mount.
        detector: Thresholds and errors.
        mishaps: What goes wrong with parts and fingers, and how often.
        person: How the person at the table behaves.
    """

    layout: LayoutParameters = field(default_factory=LayoutParameters)
    hand: HandParameters = field(default_factory=HandParameters)
    camera: CameraParameters = field(default_factory=CameraParameters)
    detector: DetectorParameters = field(default_factory=DetectorParameters)
    mishaps: Mishaps = field(default_factory=Mishaps)
    person: PersonParameters = field(default_factory=PersonParameters)


class Truth:
    """What is really where. For tests, for judging results, and for the simulated person."""

    def __init__(self, world: World, person: Person) -> None:
        self._world = world
        self.person = person
        """Who else is at the table, and what they do."""

    @property
    def parts(self) -> Mapping[str, PlacedPart]:
        """Every part, by a name such as "bearing-2"."""
        return self._world.parts

    @property
    def held(self) -> str | None:
        """Name of the part in the hand, if any."""
        return self._world.held

    @property
    def seated(self) -> Mapping[str, str]:
        """The parts that sit in a seat, each with the part it sits in."""
        return {
            name: part.parent
            for name, part in self._world.parts.items()
            if part.seated and part.parent is not None
        }

    def place(self, name: str, x: float, y: float) -> None:
        """Put a part down at x, y (m). Raises UsageError for an unknown name."""
        self._world.place(name, x, y)

    def insert(self, name: str, into: str) -> None:
        """Put a part into another, as a person would. Raises UsageError if it has no seat there."""
        self._world.insert(name, into)


class Cell:
    """One arm at the base frame's origin, a table at z = 0, the parts, and a camera on the flange.

    Args:
        model: "ur5" or "ur16e".
        seed: Of the layout and of the detector's errors.
        parameters: Everything else.
        parts: Part models; None loads the gearbox.

    Raises:
        UsageError: Unknown model, the parts do not fit, or MuJoCo is not installed.
    """

    def __init__(
        self,
        model: str = "ur5",
        seed: int = 0,
        parameters: CellParameters | None = None,
        *,
        parts: Mapping[str, PartModel] | None = None,
    ) -> None:
        if model not in MODELS:
            raise UsageError(f"No arm is called {model!r}; there are {', '.join(MODELS)}.")
        self._parameters = parameters or CellParameters()
        self._arm = MODELS[model]
        self._tcp = np.eye(4)
        self._tcp[2, 3] = TCP_M
        self._look_joints = _look_joints(self._arm, self._tcp)
        layout = random_layout(parts or load_parts(), seed, self._parameters.layout)
        self._world = World(
            layout.parts,
            layout.fixture,
            self._parameters.hand,
            Fate(seed, self._parameters.mishaps),
        )
        camera = self._parameters.camera
        self._scene = Scene(
            self._arm, layout, self._tcp, camera.mount_matrix, camera.vertical_view_rad
        )
        self._eye = Eye(self._scene, self._arm, camera)
        self._detector = SegmentationDetector(seed, self._parameters.detector)
        self._person = Person(self._world, seed, self._parameters.person)
        self._joints = self._look_joints
        self._wrist: float | None = None
        self._frame = 0
        self._seen: tuple[tuple[object, ...], Segmentation] | None = None

    @property
    def arm(self) -> ArmModel:
        """The arm's geometry."""
        return self._arm

    @property
    def tcp(self) -> Matrix:
        """Flange to tool centre point, (4, 4)."""
        return self._tcp.copy()

    @property
    def look_joints(self) -> Joints:
        """From here the camera sees the whole parts area, rad."""
        return self._look_joints

    @property
    def truth(self) -> Truth:
        """What is really where: for tests and for judging, never for the loop."""
        return Truth(self._world, self._person)

    @property
    def person(self) -> Person:
        """The person at the other side of the table."""
        return self._person

    @property
    def scene(self) -> Scene:
        """The solids, in their present places, for whoever draws them."""
        self._arrange()
        return self._scene

    def update(
        self,
        joints: Sequence[float],
        gripper_closed: bool,  # noqa: FBT001
        force_n: float = 0.0,
    ) -> bool:
        """Move the cell to what the arm measures of itself.

        Args:
            joints: Six measured angles, rad.
            gripper_closed: Whether the gripper's close output is on.
            force_n: The vertical force measured at the tool, N, whatever its sign.

        Returns:
            Whether the gripper's sensor feels a part between the fingers.
        """
        q1, q2, q3, q4, q5, q6 = (float(angle) for angle in joints)
        self._joints = (q1, q2, q3, q4, q5, q6)
        tool = forward(self._arm, self._joints) @ self._tcp
        # Looking down, the tool turns with wrist 3 the other way about, and hardly with the rest.
        spun = 0.0 if self._wrist is None else self._wrist - q6
        self._wrist = q6
        return self._world.step(tool, closed=gripper_closed, force_n=abs(force_n), spun_rad=spun)

    def contact(self) -> Contact | None:
        """Give what the held part could touch around here; None if it is far from everything.

        As long as nothing has changed the same object is given.
        """
        return self._world.contact()

    def snapshot(self) -> dict[str, object]:
        """Write the cell down, ready for JSON: parts, hand, person. The same until it changes."""
        return {"world": self._world.snapshot(), "person": self._person.snapshot()}

    def restore(self, kept: Mapping[str, Any]) -> None:
        """Set the cell up as it was written down; the arm and its gripper are told by `update`.

        Raises:
            UsageError: It was not written by a cell with these parts.
        """
        if not isinstance(kept.get("world"), Mapping) or not isinstance(
            kept.get("person"), Mapping
        ):
            raise UsageError("This is no cell that was written down: it has no world or person.")
        self._wrist = None
        carried = self._world.restore(kept["world"])
        self._person.restore(kept["person"], carried)

    def look(self) -> tuple[list[Detection], Camera]:
        """Take the next frame: what is detected in it, and the camera it was taken with."""
        view = self.view()
        detections = self._detector.detect(view, self._frame)
        self._frame += 1
        return detections, view.camera

    def view(self) -> Segmentation:
        """Give what each pixel sees now, without taking a frame. For judging and for pictures."""
        state = (self._joints, self._world.version, self._world.opening_m, self._person.place)
        if self._seen is None or self._seen[0] != state:
            self._arrange()
            solids = [*self._world.parts.values()]
            body = self._person.body
            if body is not None:
                solids.append(body.placed_hand())
            seen = self._eye.look(self._joints, self._world.opening_m, solids)
            self._seen = (state, seen)
        return self._seen[1]

    def close(self) -> None:
        """Let go of everything. Nothing is running, so this never fails."""
        self._seen = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _arrange(self) -> None:
        parts = self._world.parts.values()
        self._scene.move(self._joints, self._world.opening_m, parts, self._person.body)


def _look_joints(arm: ArmModel, tcp: Matrix) -> Joints:
    target = np.diag([1.0, -1.0, -1.0, 1.0])
    target[:3, 3] = LOOK_TCP_M
    joints = nearest(inverse(arm, target @ np.linalg.inv(tcp)), _LOOK_LIKE)
    assert joints is not None, "the look pose is within every known arm's reach"
    q1, q2, q3, q4, q5, q6 = (round(angle, 6) for angle in joints)
    return q1, q2, q3, q4, q5, q6
