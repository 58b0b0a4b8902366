"""What holds for every scene, checked on the record and the paths alone."""

from __future__ import annotations

import itertools
import random

import numpy as np
import pytest

from aapa.lacater.generator.bodies import Body
from aapa.lacater.generator.motion import pick_place, slide
from aapa.lacater.generator.schedule import play
from aapa.lacater.generator.stage import Stage

COVERED = {"cone", "sphere", "spl"}


def body(shape: str, radius: float, number: int = 0) -> Body:
    size = {0.75: "large", 0.5: "medium"}.get(radius, "small")
    return Body(shape, size, "red", "rubber", radius, f"{shape}_{number}", 0.0)


def spans(simulation):
    """(body, action, other, start, end) of everything that is done."""
    return [
        (index, move.action, move.other, move.start, move.end)
        for index, record in enumerate(simulation.movements)
        for move in record
        if move.action != "_no_op"
    ]


def pairs_that_share_a_stack(simulation):
    """Pairs of bodies one of which ever covers the other, directly or not."""
    names = {thing.instance: index for index, thing in enumerate(simulation.bodies)}
    together = np.eye(len(names), dtype=bool)
    for index, _, other, _, _ in spans(simulation):
        if other is not None:
            together[index, names[other]] = together[names[other], index] = True
    for _ in names:
        together |= together @ together
    return together


def test_strangers_are_never_too_close(simulations):
    for simulation in simulations:
        together = pairs_that_share_a_stack(simulation)
        for one, two in itertools.combinations(range(len(simulation.bodies)), 2):
            if together[one, two]:
                continue
            gaps = np.linalg.norm(simulation.planned[one] - simulation.planned[two], axis=1)
            radii = simulation.bodies[one].radius + simulation.bodies[two].radius
            # The scene file has six decimals.
            assert gaps.min() - radii > 0.25 - 1e-5


def test_actions_take_20_to_30_frames_one_after_another(simulations):
    for simulation in simulations:
        for record in simulation.movements:
            for move in record:
                assert 20 <= move.end - move.start <= 30 or move.end == 300
            ends = [move.end for move in record]
            starts = [move.start for move in record]
            assert all(start > end for start, end in zip(starts[1:], ends, strict=False))


def test_cones_cover_smaller_things_and_nothing_else_does(simulations):
    covers = 0
    for simulation in simulations:
        names = {thing.instance: thing for thing in simulation.bodies}
        for index, action, other, _, end in spans(simulation):
            if action != "_contain":
                assert other is None
                continue
            covers += 1
            cone, thing = simulation.bodies[index], names[other]
            assert cone.shape == "cone"
            assert thing.shape in COVERED
            assert cone.radius > thing.radius
            inner = list(names).index(other)
            there = simulation.planned[[index, inner], end, :2]
            assert np.allclose(there[0], there[1], atol=1e-5)
    assert covers > 40


def test_only_cubes_cylinders_and_the_snitch_turn(simulations):
    turned = {
        simulation.bodies[index].shape
        for simulation in simulations
        for index, action, *_ in spans(simulation)
        if action == "_rotate"
    }
    assert turned == {"cube", "cylinder", "spl"}


def test_at_most_two_stacks_move_at_a_time(simulations):
    most = 0
    for simulation in simulations:
        events = spans(simulation)
        for frame in range(0, 300, 5):
            # What slides together begins and ends together, from one place to one place.
            moving = {
                (start, end, *np.round(simulation.planned[index, end, :2], 3))
                for index, _, _, start, end in events
                if start < frame < end
            }
            most = max(most, len(moving))
    assert most == 2


def test_what_a_cone_covers_slides_with_it(simulations):
    carried = 0
    for simulation in simulations:
        names = [thing.instance for thing in simulation.bodies]
        for index, action, other, _, _ in spans(simulation):
            if action != "_contain":
                continue
            inner = names.index(other)
            record = simulation.movements[index]
            position = next(k for k, m in enumerate(record) if m.other == other)
            for move in record[position + 1 :]:
                if move.action == "_pick_place":
                    break
                if move.action == "_slide":
                    carried += 1
                    own = [m for m in simulation.movements[inner] if m.start == move.start]
                    assert [m.action for m in own] == ["_slide"]
                    frames = slice(move.start, move.end + 1)
                    apart = (simulation.planned[index] - simulation.planned[inner])[frames]
                    assert np.allclose(apart[:, :2], 0, atol=1e-5)
    assert carried > 5


def test_paths_stay_within_the_floor(simulations):
    for simulation in simulations:
        assert np.abs(simulation.planned[..., :2]).max() < 3.05
        assert simulation.planned[..., 2].max() < 0.75 + 0.1809 + 2.0 + 1e-6


def test_a_stage_moves_what_it_is_told():
    stage = Stage([body("sphere", 0.5)], [(0.0, 0.0)])
    stage.move(0, slide(11), 100, np.array([1.0, 2.0, 0.5]))
    assert stage.planned[0, 105] == pytest.approx([0.5, 1.0, 0.5])
    assert stage.planned[0, 300] == pytest.approx([1, 2, 0.5])
    assert stage.planned[0, 99] == pytest.approx([0, 0, 0.5])


def test_a_slide_through_another_body_is_not_free_but_a_lift_over_it_is():
    stage = Stage([body("sphere", 0.5), body("sphere", 0.5, 1)], [(-2.0, 0.0), (0.0, 0.0)])
    across = np.array([4.0, 0.0, 0.0])
    assert not stage.is_free([0], slide(25), 10, across)
    assert stage.is_free([0], pick_place(25), 10, across)
    assert not stage.is_free([0], pick_place(25), 10, np.array([2.0, 0.0, 0.0]))


def test_a_slide_across_the_way_of_another_is_free_once_that_has_passed():
    stage = Stage([body("sphere", 0.5), body("sphere", 0.5, 1)], [(-2.0, 0.0), (0.0, -2.0)])
    stage.move(1, slide(21), 0, np.array([0.0, 2.5, 0.5]))
    across = np.array([4.0, 0.0, 0.0])
    assert not stage.is_free([0], slide(21), 0, across)
    assert stage.is_free([0], slide(21), 12, across)


def test_stacks_merge_and_split():
    things = [body("spl", 0.3), body("cone", 0.5), body("cone", 0.75, 1)]
    stage = Stage(things, [(0.0, 0.0), (2.0, 0.0), (-2.0, 0.0)])
    stage.merge(1, 0)
    stage.merge(2, 1)
    assert stage.stacks == [[2, 1, 0]]
    stage.split(2)
    assert stage.stacks == [[2], [1, 0]]


def test_a_scene_that_begins_too_close_is_dropped():
    things = [body("spl", 0.3), body("cone", 0.5)]
    stage = Stage(things, [(0.0, 0.0), (0.9, 0.0)])
    assert not stage.is_sound()
    assert not play(stage, random.Random(1))
