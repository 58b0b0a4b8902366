from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.arm_frames import jacobian, joint_axes
from runtime.kinematics import UR5, UR16E, link_frames
from runtime.kinematics import jacobian as general_jacobian

_ANGLES = st.tuples(*[st.floats(-6.3, 6.3)] * 6)


@pytest.mark.parametrize("model", [UR5, UR16E], ids=lambda model: model.name)
@given(joints=_ANGLES)
def test_the_closed_form_is_the_general_product_of_matrices(model, joints):
    axes = joint_axes(model, joints)
    frames = link_frames(model, joints)
    assert np.allclose(axes.flange, frames[6], atol=1e-12)
    assert np.allclose(axes.directions, frames[:6, :3, 2], atol=1e-12)
    # Any point of an axis will do: those of joints 2 to 4 differ along it by nothing here.
    assert np.allclose(axes.origins, frames[:6, :3, 3], atol=1e-12)
    tip = tuple(axes.flange[:3, 3].tolist())
    assert np.allclose(jacobian(axes, tip), general_jacobian(model, joints), atol=1e-12)
