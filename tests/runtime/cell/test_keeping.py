from __future__ import annotations

import json
import math

import pytest

from runtime.cell import PERFECT, Act, Cell, CellParameters, Mishaps, Person, PersonParameters
from runtime.errors import UsageError


def again(bench, new_bench):
    """The same world, set up anew from what was written down, the tool where it was."""
    kept = json.loads(json.dumps(bench.world.snapshot()))
    other = new_bench()
    carried = other.world.restore(kept)
    other.place, other.yaw, other.closed = list(bench.place), bench.yaw, bench.closed
    other.move()
    return other, carried


def places(bench):
    return {
        name: (*[round(v, 6) for v in part.position], part.parent, part.seated)
        for name, part in bench.world.parts.items()
    }


def test_what_stands_where_comes_back(bench, new_bench):
    bench.world.insert("hubcover-1", "case-1")
    bench.world.insert("bearing-1", "input-1")
    bench.pick("transfer-1")
    bench.move(0.3, 0.2)
    bench.open()
    other, carried = again(bench, new_bench)
    assert places(other) == places(bench)
    assert carried == ()


def test_what_is_in_the_hand_is_in_the_hand_again(bench, new_bench):
    bench.world.insert("bearing-1", "input-1")
    bench.pick("input-1")
    before = bench.world.snapshot()
    bench.move(0.45, 0.1, 0.25)
    assert bench.world.snapshot() == before  # nothing to be written while it is carried
    other, _ = again(bench, new_bench)
    assert other.world.held == "input-1"
    assert places(other) == places(bench)
    other.push_in("input-1", "case-1")
    assert other.world.parts["input-1"].seated


def test_half_screwed_in_it_stays_so(bench, new_bench):
    bench.pick("plug-1")
    x, y, z = bench.seat("plug-1", "case-1")
    part = bench.world.parts["plug-1"].model
    top = z + part.seats[0].thread.depth_m + part.grasp_height_m
    bench.press(x, y, 10.0, top)
    bench.move(z=top - 0.0008, yaw=-2.5)
    other, _ = again(bench, new_bench)
    other.move(z=top - 0.001, yaw=-3.0)
    other.open()
    assert other.world.parts["plug-1"].turned_rad == pytest.approx(3.0, abs=0.01)


def test_what_was_drawn_is_not_drawn_again(new_bench):
    bench = new_bench(mishaps=Mishaps(jam_rate=1.0))
    bench.pick("bearing-1")
    assert bench.push_in("bearing-1", "input-1") > 0.003
    kept = json.loads(json.dumps(bench.world.snapshot()))
    other = new_bench(mishaps=Mishaps(jam_rate=1.0))
    other.world.restore(kept)
    other.closed = False
    other.move(0.3, 0.0, 0.3)
    other.grip("bearing-1")
    other.move(z=0.2)
    assert other.push_in("bearing-1", "input-1") < 3e-4


def test_of_the_person_what_they_took_and_what_they_have_yet_to_do_comes_back(bench, new_bench):
    script = PersonParameters(
        acts=(Act("take-away", ("plug",), at_s=0.5), Act("reach-in", at_s=60.0)), delay_s=(0, 0)
    )
    bench.move(0.2, -0.3, 0.4)
    person = Person(bench.world, 0, script)
    for tick in range(100):
        person.step(tick * 0.1)
        if person.carries:
            break
    assert person.carries == "plug-1"
    kept, of_person = bench.world.snapshot(), json.loads(json.dumps(person.snapshot()))
    other = new_bench()
    later = Person(other.world, 0, script)
    later.restore(of_person, other.world.restore(json.loads(json.dumps(kept))))
    assert other.world.parts["plug-1"].position[0] > 0.8
    assert later.carries is None
    later.step(0.0)
    later.step(50.0)
    assert later.doing is None
    later.step(59.0)
    assert later.doing == "reach-in"
    later.ask("put-back", [("plug", None)])


def test_a_cell_goes_on_where_another_was_cut_off(grip):
    cells = [Cell("ur5", 2, CellParameters(detector=PERFECT)) for _ in range(2)]
    cells[0].update(cells[0].look_joints, gripper_closed=False)
    assert grip(cells[0], "hubcover-1")
    cells[1].restore(json.loads(json.dumps(cells[0].snapshot())))
    assert cells[1].update(cells[0].look_joints, gripper_closed=True)
    for one, other in zip(*(cell.look()[0] for cell in cells), strict=True):
        assert (one.type, one.box) == (other.type, other.box)
        assert one.position == pytest.approx(other.position, abs=1e-6)


def test_what_is_no_cell_or_another_one_is_refused(bench):
    with pytest.raises(UsageError, match="no cell that was written down"):
        Cell("ur5").restore({"parts": 3})
    with pytest.raises(UsageError, match="no cell that was written down"):
        bench.world.restore({"parts": {name: {} for name in bench.world.parts}})
    with pytest.raises(UsageError, match="Take the same cell and parts"):
        bench.world.restore({"parts": {"gear-1": {}}})
    assert math.isfinite(bench.world.parts["plug-1"].position[0])
