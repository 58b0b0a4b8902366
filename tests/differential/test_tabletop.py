"""The workload of `make bench-engine`: it is what it says it is, and all engines get it right."""

from __future__ import annotations

import math
from itertools import permutations

import numpy as np
import pytest
from tabletop.engines import ClingoEngine, ClipsEngine, Engine, NetworkEngine, ScratchEngine
from tabletop.engines.network_engine import RULES, SnapshotEngine, compiled_rules
from tabletop.oracle import PREDICATES, Facts, difference, facts, truth
from tabletop.scene import EPISODE, TYPES, Mode, State, Verb, make_workload, moved_count
from tabletop.whys import measure_whys, section

from icarus_lite.inference import Derivation, InferenceEngine, Memory, explain
from icarus_lite.language import diagnose_file, load_domain

_COMPILED = compiled_rules()


def by_sets(state: State, base: tuple[int, int, int]) -> Facts:
    """Work out what is true by comprehensions, a third way beside matrices and rules."""
    things = {t.name: t for t in state.things}
    pairs = list(permutations(state.things, 2))
    left = {(a.name, b.name) for a, b in pairs if 2 * a.x + a.w <= 2 * b.x - b.w}
    near = {
        (a.name, b.name)
        for a, b in pairs
        if (a.x - b.x) ** 2 + (a.y - b.y) ** 2 + (a.z - b.z) ** 2 < 300**2
    }
    on = {
        (a.name, b.name)
        for a, b in pairs
        if abs(a.z - b.z - b.h) <= 5 and 2 * abs(a.x - b.x) < b.w and 2 * abs(a.y - b.y) < b.d
        if a.name not in state.holding
    }
    covered = {b for _, b in on}
    clear = set(things) - covered
    connected = set(state.fixed)
    while longer := {(a, d) for a, b in state.fixed for c, d in connected if b == c} - connected:
        connected |= longer
    linked = {a for a, _ in connected}
    reach = {
        t.name
        for t in state.things
        if math.dist((t.x, t.y, t.z), (base[0], base[1], 0)) ** 2 <= base[2] + 0.5
    }
    graspable = (clear & reach) - state.holding
    adjacent = left & near
    candidate = {(a, b) for a, b in adjacent if a in graspable and b in clear}
    has = {a for a, _ in candidate}
    loose = has - linked
    assembly = {
        (a, b)
        for a, b in adjacent
        if {a, b} <= loose and (things[a].type, things[b].type) == ("peg", "hole")
    }
    unary = {
        "covered": covered, "clear": clear, "linked": linked, "reachable": reach,
        "graspable": graspable, "has-candidate": has, "loose": loose,
    }  # fmt: skip
    binary = {
        "left-of": left, "near": near, "on": on, "connected": connected, "adjacent": adjacent,
        "candidate": candidate, "assembly": assembly,
    }  # fmt: skip
    assert {*unary, *binary} == set(PREDICATES)
    return frozenset((name, a) for name, row in unary.items() for a in row) | frozenset(
        (name, a, b) for name, row in binary.items() for a, b in row
    )


@pytest.mark.parametrize("mode", Mode)
def test_two_ways_of_working_it_out_agree(mode: Mode) -> None:
    workload = make_workload(60, mode, seed=6, frames=12)
    met = set()
    for state in workload.states():
        true = facts(truth(state, workload.base))
        assert true == by_sets(state, workload.base)
        met |= {name for name, *_ in true}
    assert met == set(PREDICATES)


def test_the_scene_is_as_defined() -> None:
    workload = make_workload(200, Mode.TWO)
    side = 250 * math.sqrt(200)
    things = workload.start.things
    assert [t.type for t in things[:4]] == list(TYPES)
    assert all(40 <= size <= 80 for t in things for size in (t.w, t.d, t.h))
    assert all(0 <= t.x < side and 0 <= t.y < side for t in things)
    assert sum(t.z > 0 for t in things) == 60  # three in ten are stacked
    assert max(t.z for t in things) <= 2 * 80
    assert workload.base[2] == int((0.4 * round(side)) ** 2)
    assert all(a < b for a, b in workload.start.fixed)
    assert len(workload.frames) == 299


@pytest.mark.parametrize(("mode", "moving"), [(Mode.TWO, 2), (Mode.ALL, 30)])
def test_as_many_move_as_the_mode_says(mode: Mode, moving: int) -> None:
    workload = make_workload(30, mode)
    assert moved_count(workload.frames) == moving
    verbs = [verb for frame in workload.frames for verb, _ in frame.actions]
    episodes = len(workload.frames) / EPISODE
    assert verbs.count(Verb.GRASP) == math.ceil(episodes)
    assert verbs.count(Verb.RELEASE) == verbs.count(Verb.ATTACH) == math.floor(episodes)
    assert verbs.count(Verb.DETACH) == round(episodes)
    for before, state in zip(states := list(workload.states()), states[1:], strict=False):
        for old, new in zip(before.things, state.things, strict=True):
            carried = old.name in state.holding or old.name in before.holding
            assert carried or max(abs(old.x - new.x), abs(old.y - new.y)) <= 10
        assert all(a < b for a, b in state.fixed)


def test_the_same_seed_makes_the_same_workload() -> None:
    assert make_workload(15, Mode.ALL, seed=3) == make_workload(15, Mode.ALL, seed=3)
    assert make_workload(15, Mode.ALL, seed=3) != make_workload(15, Mode.ALL, seed=4)


def test_the_rules_have_nothing_to_complain_about() -> None:
    domain, _, problems = diagnose_file(RULES)
    assert domain is not None
    assert problems == ()
    assert {clause.head.predicate for clause in domain.concepts} == set(PREDICATES)


def engines(base: tuple[int, int, int], count: int) -> dict[str, Engine]:
    return {
        "network": NetworkEngine(_COMPILED, base, count),
        "snapshots": SnapshotEngine(_COMPILED, base, count),
        "scratch": ScratchEngine(base),
        "clips": ClipsEngine(base),
        "clingo": ClingoEngine(base),
    }


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("name", ["network", "snapshots", "scratch", "clips", "clingo"])
def test_an_engine_is_right_in_every_frame(name: str, mode: Mode) -> None:
    frames = 300 if name in ("network", "snapshots") else 40
    workload = make_workload(15, mode, frames=frames)
    engine = engines(workload.base, workload.count)[name]
    engine.begin(workload.start)
    before = truth(workload.start, workload.base)
    assert engine.facts() == facts(before)
    state = workload.start
    for frame in workload.frames:
        state = state.after(frame)
        engine.prepare(frame, state)()
        now = truth(state, workload.base)
        assert engine.facts() == facts(now)
        if isinstance(engine, NetworkEngine):
            assert engine.news() == difference(before, now)
        before = now


@pytest.mark.parametrize("mode", Mode)
def test_the_network_is_right_with_many_things(mode: Mode) -> None:
    workload = make_workload(150, mode, frames=30)
    engine = NetworkEngine(_COMPILED, workload.base, workload.count)
    engine.begin(workload.start)
    before, state = truth(workload.start, workload.base), workload.start
    for frame in workload.frames:
        state = state.after(frame)
        engine.prepare(frame, state)()
        now = truth(state, workload.base)
        assert engine.news() == difference(before, now)
        before = now
    assert engine.facts() == facts(before)


@pytest.mark.parametrize("mode", Mode)
def test_what_is_measured_of_why_is_whole_proofs(mode: Mode) -> None:
    workload = make_workload(15, mode, frames=40)
    whys = measure_whys(workload)
    assert len(whys.nodes) == len(whys.now) > 80
    assert len(whys.then) > 80
    assert max(whys.nodes) > 5
    assert min(*whys.now, *whys.then, whys.back) > 0
    lines = list(section([(15, str(mode), whys)]))
    assert len({line.count("|") for line in lines[2:5]}) == 1
    assert f"| 15 | {mode} | {len(whys.now)} |" in lines[4]


def test_proofs_go_down_to_what_is_given() -> None:
    workload = make_workload(15, Mode.TWO, frames=30)
    telling = NetworkEngine(_COMPILED, workload.base, workload.count)
    engine, memory = InferenceEngine(load_domain(RULES)), Memory()
    for state in workload.states():
        memory = engine.step(memory, telling.percepts(state), [])
    beliefs = [each for name in PREDICATES for each in memory.state.supports.of(name)]
    assert len({each.predicate for each in beliefs}) > 10
    for belief in beliefs:
        pending = [explain(belief, memory.state)]
        while pending:
            each = pending.pop()
            pending += each.premises
            derived = isinstance(each.support, Derivation)
            assert derived == (each.belief.predicate in PREDICATES)
            assert derived or each.belief.predicate in {"obj", "base"}
            if derived:
                assert [below.belief for below in each.premises] == list(each.support.matched)


def test_the_oracle_notices_a_single_fact() -> None:
    workload = make_workload(15, Mode.TWO, frames=2)
    true = truth(workload.start, workload.base)
    other = {name: each.copy() for name, each in true.items()}
    other["near"][0, 1] = not other["near"][0, 1]
    added, removed = difference(true, other)
    assert added | removed == {("near", 0, 1)}
    assert np.count_nonzero(other["near"] != true["near"]) == 1
