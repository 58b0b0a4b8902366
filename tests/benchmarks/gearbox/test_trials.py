from __future__ import annotations

import math
import random

import pytest
from gearbox.endings import is_true_reason
from gearbox.faults import KINDS, applies, plan_of, signs_of, true_reasons
from gearbox.plans import free_place
from gearbox.trials import NO_FAULT, TASKS, Trial, trials

from icarus_lite import load_domain
from runtime.cell.layout import LayoutParameters, random_layout
from runtime.controller.faults import parse_faults
from runtime.parts import load_parts


def test_every_run_has_a_key_of_its_own():
    wanted = list(trials(list(TASKS), range(3), list(KINDS), (True, False), 10.0))
    wanted += list(trials(list(TASKS), range(3), list(KINDS), (True, False), 1.0))
    assert len({trial.key for trial in wanted}) == len(wanted) == 6 * 3 * len(KINDS) * 2 * 2


def test_an_interrupted_experiment_has_a_bit_of_everything():
    first = list(trials(list(TASKS), range(5), [NO_FAULT], (True, False), 10.0))[:12]
    assert {trial.task for trial in first} == set(TASKS)
    assert {trial.attachments for trial in first} == {True, False}
    assert {trial.seed for trial in first} == {0}


@pytest.mark.parametrize("fault", KINDS)
def test_a_seed_decides_when_a_fault_strikes(fault):
    plans = [plan_of(Trial("1.1", seed, fault=fault)) for seed in range(8)]
    assert plans == [plan_of(Trial("1.1", seed, fault=fault)) for seed in range(8)]
    # The moment has nothing to do with attachments: the two sides meet the same fault.
    assert plans[0] == plan_of(Trial("1.1", 0, attachments=False, fault=fault))


def test_moments_differ_from_seed_to_seed():
    plans = {str(plan_of(Trial("1.1", seed, fault="protective_stop"))) for seed in range(20)}
    assert len(plans) == 20


def test_only_without_attachments_is_a_lost_part_a_true_reason():
    assert true_reasons(Trial("1.1", 0)) == ()
    assert true_reasons(Trial("1.1", 0, attachments=False))


def test_a_person_refuses_only_where_one_is_asked():
    assert [task for task in TASKS if applies(Trial(task, 0, fault="refuses"))] == ["1.3", "2.2"]
    assert all(applies(Trial(task, 0, fault="jam")) for task in TASKS)


def test_only_signs_of_its_own_fault_tell_that_it_struck():
    seen = ["person: take-away", "moved by hand: input-1", "slipped: plug-1", "killed"]
    assert signs_of(Trial("1.4", 0, fault="taken"), seen) == ()  # on the way, or another part
    assert signs_of(Trial("1.2", 0, fault="taken"), seen) == ("moved by hand: input-1",)
    assert signs_of(Trial("1.4", 0, fault="slip"), seen) == ("slipped: plug-1",)
    assert signs_of(Trial("1.4", 0), seen) == ()


@pytest.mark.parametrize(
    "fault", [name for name in KINDS if plan_of(Trial("1.1", 0, fault=name)).controller]
)
def test_the_controller_can_read_what_it_is_to_do_wrong(fault):
    for seed in range(20):
        entries = [dict(entry) for entry in plan_of(Trial("1.1", seed, fault=fault)).controller]
        (read,) = parse_faults(entries)
        assert read.kind == fault


def test_tasks_are_those_of_the_domain(repository):
    domain = load_domain(repository / "domains" / "gearbox.icr")
    for task in domain.tasks:
        assert task.name in TASKS
        assert (task.robot or "ur5") == TASKS[task.name].robot


@pytest.mark.parametrize("kind", ["plug", "casingtop"])
def test_the_person_puts_parts_where_nothing_stands_and_the_camera_sees_them(kind):
    size = load_parts()[kind].size
    for seed in range(10):
        x, y = free_place(random.Random(seed), seed, kind)
        for part in random_layout(load_parts(), seed).parts:
            if part.model.type == kind:
                continue
            beside = abs(x - part.position[0]) - (size[0] + part.model.size[0]) / 2
            behind = abs(y - part.position[1]) - (size[1] + part.model.size[1]) / 2
            assert max(beside, behind) > 0.015  # a finger's breadth
        seen = LayoutParameters()
        assert seen.x_m[0] <= x - size[0] / 2
        assert x + size[0] / 2 <= seen.x_m[1]
        assert seen.y_m[0] <= y - size[1] / 2
        assert y + size[1] / 2 <= seen.y_m[1]
        assert seen.reach_m[0] <= math.hypot(x, y) <= seen.reach_m[1]


def test_what_the_driver_says_after_a_silence_is_true_of_a_stall_and_of_no_stopped_program():
    said = (
        "nothing passed between this program and the controller at 127.0.0.2 for 1.42 s, and the "
        "controller's watchdog ended the control program; see that the controller is on"
    )
    stopped = "the control program on the controller at 127.0.0.2 was stopped; see that nobody else"
    for fault, reason, expected in (
        ("stall", said, True),
        ("stall", stopped, False),
        ("kill_script", said, False),
        ("kill_script", stopped, True),
    ):
        assert is_true_reason(reason, true_reasons(Trial("1.1", 0, fault=fault))) is expected
