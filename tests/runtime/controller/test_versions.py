from __future__ import annotations

import pytest

from runtime.controller.arm import HOME
from runtime.controller.control_box import ControlBox
from runtime.controller.dashboard import DashboardServer
from runtime.controller.rtde_variables import outputs
from runtime.controller.versions import VERSIONS, Version, version_for
from runtime.errors import UsageError
from runtime.kinematics import MODELS


def played(model, version=None):
    return ControlBox(MODELS[model], lambda: 0.0, HOME, version_for(model, version))


@pytest.mark.parametrize(
    ("text", "version"),
    [
        ("5.17", Version(5, 17, 0, 0)),
        ("3.15.8", Version(3, 15, 8, 0)),
        ("3.15.8.106339", Version(3, 15, 8, 106339)),
    ],
)
def test_a_version_is_read(text, version):
    assert Version.parse(text) == version
    assert str(version).startswith(text)


@pytest.mark.parametrize("text", ["", "5", "5.x", "v5.1", "5.1.2.3.4", "-5.1", "5.1x"])
def test_what_is_no_version_is_refused(text):
    with pytest.raises(UsageError, match=r"is not a PolyScope version, such as 5\.17\.3"):
        Version.parse(text)


@pytest.mark.parametrize(
    ("model", "text", "range_"),
    [("ur5", "5.11", "3.0 to 3.15"), ("ur5", "3.16", "3.0 to 3.15"), ("ur16e", "3.15", "5.0 to")],
)
def test_a_version_of_the_other_series_is_refused_with_what_there_is(model, text, range_):
    with pytest.raises(UsageError, match=f"is not played for the {model}; .* from {range_}"):
        version_for(model, text)


def test_without_a_version_the_usual_one_is_played():
    assert {model: version_for(model, None) for model in MODELS} == VERSIONS


@pytest.mark.parametrize(
    ("model", "version", "known", "unknown"),
    [
        ("ur5", "3.10", "robotmode, setUserRole", "safetystatus, is in remote control, version"),
        ("ur5", "3.15", "safetystatus, get robot model", "is in remote control"),
        ("ur16e", "5.3", "safetymode, version", "safetystatus, get serial number, setUserRole"),
        ("ur16e", "5.17", "is in remote control, get operational mode", "getUserRole"),
    ],
)
def test_the_dashboard_knows_what_its_version_knew(model, version, known, unknown):
    dashboard = DashboardServer(played(model, version))
    for command in known.split(", "):
        assert not dashboard.answer(command).startswith("could not understand")
    for command in unknown.split(", "):
        assert dashboard.answer(command).startswith("could not understand")


def test_the_version_is_told_in_the_words_clients_look_for():
    dashboard = DashboardServer(played("ur16e", "5.11.1"))
    assert dashboard.answer("PolyscopeVersion") == "URSoftware 5.11.1.0 (stand-in controller)"
    assert dashboard.answer("get robot model") == "UR16"
    assert dashboard.answer("get serial number").isdigit()
    assert DashboardServer(played("ur5")).answer("get robot model") == "UR5"


def test_the_state_stream_has_what_its_version_had():
    assert "payload" not in outputs(Version(5, 5, 0, 0))
    assert "payload" in outputs(Version(5, 6, 0, 0))
    assert "payload" in outputs(Version(3, 11, 0, 0))
    assert "ft_raw_wrench" not in outputs(Version(3, 15, 0, 0))


@pytest.mark.parametrize(
    ("model", "version", "call", "works"),
    [
        ("ur5", "3.15", "tool_contact()", False),
        ("ur16e", "5.3", "tool_contact()", False),
        ("ur16e", "5.4", "tool_contact()", True),
        ("ur5", "3.15", "force_mode_set_gain_scaling(1)", False),
        ("ur5", "3.4", "force_mode_set_damping(0.1)", False),
        ("ur5", "3.5", "force_mode_set_damping(0.1)", True),
    ],
)
def test_a_function_that_came_later_ends_the_program_and_says_so(model, version, call, works):
    box = played(model, version)
    box.load(f"{call}\nsleep(1)\n")
    box.cycle()
    if works:
        assert box.program is not None
    else:
        assert box.program is None
        name = call.partition("(")[0]
        assert f"{name}() is not known to PolyScope {version}" in box.last_failure
