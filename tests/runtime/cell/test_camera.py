from __future__ import annotations

import math

import numpy as np
import pytest

from runtime.cell import CameraParameters, Cell, CellParameters
from runtime.cell.camera import HAND_EYE, camera_at
from runtime.kinematics import UR5, forward


def test_the_mount_is_a_rotation_and_looks_along_the_tool():
    mount = np.array(HAND_EYE)
    np.testing.assert_allclose(mount[:3, :3].T @ mount[:3, :3], np.eye(3), atol=1e-12)
    assert np.linalg.det(mount[:3, :3]) == pytest.approx(1.0)
    assert mount[:3, 2].tolist() == [0.0, 0.0, 1.0]


def test_the_camera_moves_with_the_flange():
    joints = (2.7, -1.9, 1.5, -1.1, -1.5, 0.3)
    camera = camera_at(UR5, joints, CameraParameters())
    flange = forward(UR5, joints)
    place = flange @ np.array([0.07, 0.0, 0.03, 1.0])
    assert camera.position == pytest.approx(tuple(place[:3]))
    assert 2 * math.degrees(math.atan2(camera.width / 2, camera.focal_px)) == pytest.approx(69.0)


def test_at_the_look_pose_it_looks_straight_down_with_the_tool_at_the_lower_edge(cell):
    camera = cell.view().camera
    assert camera.rotation[:, 2] == pytest.approx([0, 0, -1], abs=1e-5)
    tool = (forward(cell.arm, cell.look_joints) @ cell.tcp)[:3, 3]
    u, v, depth = camera.project(tuple(tool))
    assert u == pytest.approx(160, abs=0.5)
    assert v > 240
    assert depth < camera.near_m


def test_pixels_and_depth_lead_back_to_the_part(cell):
    view = cell.view()
    for index, part in enumerate(view.parts):
        rows, columns = np.nonzero(view.ids == index)
        half = np.asarray(part.model.size) / 2 + 1e-6
        for row, column in list(zip(rows.tolist(), columns.tolist(), strict=True))[::25]:
            depth = float(view.depth[row, column])
            point = view.camera.back_project(column + 0.5, row + 0.5, depth)
            assert np.all(np.abs(np.subtract(point, part.position)) <= half)


def test_alone_a_part_shows_its_whole_outline(cell):
    view = cell.view()
    for index, part in enumerate(view.parts):
        whole = view.silhouettes[index]
        assert whole is not None
        seen = np.count_nonzero(view.ids == index)
        assert seen == pytest.approx(whole.pixels, rel=0.12), part.name


def test_rays_are_spared_where_no_part_can_be(cell):
    view = cell.view()
    looked_at = np.zeros(view.ids.shape, dtype=bool)
    for whole in view.silhouettes:
        assert whole is not None
        x1, y1, x2, y2 = whole.box
        looked_at[math.floor(y1) : math.ceil(y2), math.floor(x1) : math.ceil(x2)] = True
    assert np.all(view.ids[~looked_at] == -1)
    assert np.all((view.depth > 0) == (view.ids >= 0))


def test_other_optics_change_the_image_only(cell):
    small = Cell("ur5", 2, CellParameters(camera=CameraParameters(width=160, height=120)))
    one, other = cell.view(), small.view()
    assert other.ids.shape == (120, 160)
    for index in range(len(one.parts)):
        ratio = np.count_nonzero(one.ids == index) / np.count_nonzero(other.ids == index)
        assert ratio == pytest.approx(4, rel=0.35)


def test_the_image_is_a_dataclass_of_what_was_seen(cell):
    first = cell.view()
    assert cell.view() is first  # nothing has moved
    cell.truth.place("bearing-1", 0.25, 0.0)
    second = cell.view()
    assert second is not first
    assert first.parts[7].position != second.parts[7].position


def by_rays(cell, view):
    """Every pixel by a ray through all of MuJoCo's solids."""
    camera = view.camera
    v, u = np.mgrid[0 : camera.height, 0 : camera.width] + 0.5
    rays = np.stack([u - camera.width / 2, v - camera.height / 2, 0 * u + camera.focal_px], -1)
    rays = (rays / np.linalg.norm(rays, axis=-1, keepdims=True)).reshape(-1, 3)
    ids, distances = cell.scene.cast(camera.position, rays @ camera.rotation.T)
    depth = np.where(ids >= 0, distances * rays[:, 2], 0.0)
    return ids.reshape(view.ids.shape), depth.reshape(view.ids.shape)


@pytest.mark.parametrize("scene", ["empty hand", "lid in hand", "person", "elsewhere"])
def test_drawing_part_by_part_sees_what_rays_through_everything_see(cell, grip, scene):
    rng = np.random.default_rng(3)
    poses = [np.asarray(cell.look_joints) + rng.normal(0, 0.12, 6) for _ in range(5)]
    if scene == "lid in hand":
        assert grip(cell, "casingtop-1")
    if scene == "elsewhere":
        poses = [np.asarray(cell.look_joints) + rng.normal(0, 0.4, 6) for _ in range(8)]
    if scene == "person":
        cell.person.ask("reach-in")
        for time_s in range(5):
            cell.person.step(time_s)
    seen = 0
    for joints in poses:
        cell.update(joints, gripper_closed=scene == "lid in hand")
        view = cell.view()
        ids, depth = by_rays(cell, view)
        # A ray that grazes an edge may go either way.
        assert np.count_nonzero(view.ids != ids) <= 3
        same = view.ids == ids
        np.testing.assert_allclose(view.depth[same], depth[same], atol=1e-6)
        seen += np.count_nonzero(ids >= 0)
    assert seen > 2000
    if scene == "person":
        assert np.count_nonzero(view.ids == len(cell.truth.parts)) > 200
