"""The cell in MuJoCo: geometry only.

Joint angles and part poses come in, `mj_kinematics` puts every solid in its place, and rays or a
renderer look at it. There are no dynamics: the cell is quasi-static, and what the hand does to the
parts is decided in `runtime.cell.world`.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Iterable, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from runtime.cell.arrangement import PlacedPart
from runtime.cell.body import LIMBS, Body
from runtime.cell.layout import Layout
from runtime.cell.mjcf import AWAY, GROUPS, cell_xml
from runtime.errors import UsageError
from runtime.kinematics import ArmModel, Matrix

_SIGNS: Final = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])


class Scene:
    """The solids of the cell and where they are.

    Args:
        model: The arm.
        layout: The parts and the fixture.
        tcp: (4, 4), flange to tool centre point.
        mount: (4, 4), flange to camera.
        view_rad: The camera's vertical field of view.

    Raises:
        UsageError: MuJoCo is not installed.
    """

    def __init__(
        self, model: ArmModel, layout: Layout, tcp: Matrix, mount: Matrix, view_rad: float
    ) -> None:
        mujoco = load_mujoco()
        self.names = tuple(part.name for part in layout.parts)
        xml = cell_xml(
            model,
            layout.parts,
            layout.fixture,
            tcp_m=float(tcp[2, 3]),
            mount=mount,
            view_rad=view_rad,
        )
        self.model: Any = mujoco.MjModel.from_xml_string(xml)
        self.data: Any = mujoco.MjData(self.model)
        self._kinematics = mujoco.mj_kinematics
        self._camlight = mujoco.mj_camlight
        self._rays = mujoco.mj_multiRay
        self._quaternion = mujoco.mju_mat2Quat
        bodies = [self.model.body(name).id for name in self.names]
        self._mocap = [int(self.model.body_mocapid[body]) for body in bodies]
        owner = np.full(self.model.nbody, -1, dtype=np.int32)
        owner[bodies] = np.arange(len(bodies))
        limbs = [self.model.body(name).id for name in LIMBS]
        self._limbs = [int(self.model.body_mocapid[limb]) for limb in limbs]
        owner[limbs[-1]] = len(bodies)
        self._owner = np.append(owner[self.model.geom_bodyid], -1)  # the last one: nothing hit

    def move(
        self,
        joints: Sequence[float],
        opening_m: float,
        parts: Iterable[PlacedPart],
        person: Body | None = None,
    ) -> None:
        """Put everything in its place.

        Args:
            joints: Of the arm, rad.
            opening_m: How far apart the fingers are.
            parts: In the layout's order.
            person: The person's body, None if nobody is there.
        """
        self.data.qpos[:6] = joints
        self.data.qpos[6:8] = opening_m / 2
        for slot, part in zip(self._mocap, parts, strict=True):
            self._put(slot, part.pose)
        if person is None:
            self.data.mocap_pos[self._limbs] = AWAY
        else:
            for slot, pose in zip(self._limbs, person.poses, strict=True):
                self._put(slot, pose)
        self._kinematics(self.model, self.data)
        self._camlight(self.model, self.data)

    def cast(
        self,
        origin: Sequence[float],
        directions: NDArray[np.float64],
        groups: Iterable[str] = ("arm", "hand", "part", "person"),
    ) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
        """Follow rays from a point to the first solid.

        Args:
            origin: m, in the base frame.
            directions: (n, 3) unit vectors in the base frame.
            groups: Names of the groups of solids that stop a ray.

        Returns:
            (n,) index of the part hit, the number of parts for the person's hand, -1 for anything
            else; (n,) distance, m, -1 for nothing hit.
        """
        count = len(directions)
        geoms = np.full(count, -1, dtype=np.int32)
        distances = np.full(count, -1.0)
        self._rays(
            self.model,
            self.data,
            np.asarray(origin, dtype=np.float64),
            np.ascontiguousarray(directions).ravel(),
            self._flags(groups),
            True,  # noqa: FBT003 - MuJoCo takes flags by position
            -1,
            geoms,
            distances,
            None,
            count,
            10.0,
        )
        return self._owner[geoms], distances

    def corners(self, groups: Iterable[str]) -> NDArray[np.float64]:
        """Give the corners of the boxes around solids, (n, 8, 3) m in the base frame."""
        ids = np.flatnonzero(self._flags(groups)[self.model.geom_group])
        boxes = self.model.geom_aabb[ids]
        local = boxes[:, None, :3] + _SIGNS * boxes[:, None, 3:]
        turns = self.data.geom_xmat[ids].reshape(-1, 3, 3)
        corners: NDArray[np.float64] = (
            local @ turns.transpose(0, 2, 1) + self.data.geom_xpos[ids, None]
        )
        return corners

    @staticmethod
    def _flags(groups: Iterable[str]) -> NDArray[np.uint8]:
        flags = np.zeros(6, dtype=np.uint8)
        flags[[GROUPS[name] for name in groups]] = 1
        return flags

    def _put(self, slot: int, pose: Matrix) -> None:
        quaternion = np.empty(4)
        self._quaternion(quaternion, pose[:3, :3].ravel())
        self.data.mocap_pos[slot] = pose[:3, 3]
        self.data.mocap_quat[slot] = quaternion


def load_mujoco() -> Any:
    """Import MuJoCo, or say how to get it. Raises UsageError."""
    if (
        "mujoco" not in sys.modules
        and "MUJOCO_GL" not in os.environ
        and "DISPLAY" not in os.environ
    ):
        # Read once, when MuJoCo is imported; its own default needs a display.
        for library, name in (("libEGL.so.1", "egl"), ("libOSMesa.so.8", "osmesa")):
            with contextlib.suppress(OSError):
                ctypes.CDLL(library)
                os.environ["MUJOCO_GL"] = name
                break
    try:
        import mujoco  # noqa: PLC0415 - an optional extra
    except ImportError as error:
        raise UsageError(
            "The simulated cell needs MuJoCo, which is not installed:"
            " pip install 'icarus-lite[cell]'."
        ) from error
    return mujoco
