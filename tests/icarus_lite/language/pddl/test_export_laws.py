"""Random small domains: the shortest plan of the export is a shortest plan of ours."""

from __future__ import annotations

import importlib.util
import re
import sys
from pathlib import Path
from types import ModuleType

from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from icarus_lite.language import parse_domain
from icarus_lite.language.pddl import (
    export_task,
    import_sources,
    inlined,
    write_domain,
    write_problem,
)
from icarus_lite.language.syntax import Domain, Source
from icarus_lite.planning import Plan, find_plan

_STATES = Path(__file__).parents[3] / "reference" / "planned_states.py"
_spec = importlib.util.spec_from_file_location("planned_states", _STATES)
states = sys.modules["planned_states"] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(states)

RECURSIVE = re.compile("chain|attached")
OURS, THEIRS = 25, 150
CONDITIONS = [
    "(r ?x ?y)",
    "(not (r ?x ?y))",
    "(not (r ?any ?x))",
    "(s ?x)",
    "(not (s ?y))",
    "(open ?x)",
    "(not (open ?y))",
    "(chain ?x ?y)",
    "(not (chain ?y ?x))",
    "(attached ?x ?y)",
    "(not (attached ?x ?any))",
    "(p ?x ^n 1)",
    "(not (p ?y ^n 2))",
    "(seen ?x)",
]
TESTS = ["(/= ?x ?y)", "(<= ?a ?b)", "(or (= ?x ?y) (not (= ?y k)))"]
EFFECTS = [
    "(r ?x ?y)",
    "(not (r ?x ?y))",
    "(not (r ?x ?any))",
    "(s ?x)",
    "(s ?y)",
    "(not (s ?y))",
    "(seen ?y)",
    "(not (seen ?x))",
]
GOALS = [
    "(r l k)",
    "(s l)",
    "(s k)",
    "(not (s m))",
    "(chain m l)",
    "(attached k l)",
    "(attached l m)",
    "(not (attached m ?any))",
    "(not (open ?v))",
    "(r ?v ?v)",
    "(seen l)",
    "(not (seen k))",
]


def some(texts: list[str], most: int, least: int = 0) -> st.SearchStrategy[str]:
    if not texts:
        return st.just("")
    chosen = st.lists(st.sampled_from(texts), min_size=least, max_size=most, unique=True)
    return chosen.map(" ".join)


@st.composite
def skills(draw: st.DrawFn, name: str, effects: list[str] = EFFECTS, *, plain: bool = False) -> str:
    conditions = [c for c in CONDITIONS if not (plain and RECURSIVE.search(c))]
    elements = f"(p ?x ^n ?a) (p ?y ^n ?b) {draw(some(conditions, 2))}"
    tests = f":tests ({draw(some(TESTS, 1))})"
    return (
        f"(({name} ?x ?y) :elements ({elements}) {tests} :actions ((*do ?x ?y))"
        f" :effects ({draw(some(effects, 3, 1))}))"
    )


@st.composite
def domains(draw: st.DrawFn, *, plain: bool = False) -> Domain:
    """Give a domain with a task; a plain one has neither recursion nor attachments."""
    goals = [goal for goal in GOALS if not (plain and RECURSIVE.search(goal))]
    attachments = "(attachments ((tie ?c ?p) :until (untie ?c ?_) :child ?c :parent ?p))"
    sizes = [draw(st.integers(1, 3)) for _ in range(3)]
    given_facts = draw(some(["(r k l)", "(r l m)", "(s m)", "(s k)", "(attached m k)"], 4, 1))
    clauses = [draw(skills(name, [], plain=plain)) for name in ("tie", "tie")]
    clauses += [draw(skills(name, plain=plain)) for name in ("untie", "go", "go", "do")]
    text = f"""
    (percepts (p ^n))
    (concepts ((open ?x) :elements ((p ?x) (not (r ?x ?any))))
              ((chain ?x ?y) :elements ((r ?x ?y)))
              ((chain ?x ?z) :elements ((r ?x ?y) (chain ?y ?z)))
              ((seen ?x) :elements ((p ?x ^n ?n)) :tests ((> ?n 1))))
    (skills {" ".join(clauses)})
    {"" if plain else attachments}
    (task t :init ((p k ^n {sizes[0]}) (p l ^n {sizes[1]}) (p m ^n {sizes[2]}) {given_facts})
            :goal ({draw(some(goals, 3, 2))}))
    """
    domain, found = parse_domain(text)
    assert domain is not None, found
    return domain


@settings(max_examples=8, suppress_health_check=list(HealthCheck), phases=[Phase.generate])
@given(domains())
def test_shortest_plans_are_as_long_and_can_be_carried_out(
    naive_pddl: ModuleType, domain: Domain
) -> None:
    (task,) = domain.tasks
    state = states.state_of(domain, task.init)
    ours = find_plan(domain, state.imagination, task.goals, limit=OURS)
    result = export_task(domain, "t", task.goals, state)
    world = naive_pddl.World(result.domain, result.problem)
    steps = world.shortest(THEIRS)
    assert isinstance(ours, Plan) or ours.final is False or steps is None
    assume(isinstance(ours, Plan) and not world.was_cut)
    assert steps is not None
    assert len(steps) == len(ours.steps)
    assert states.reaches(state, [result.skill(*step) for step in steps], task.goals)


@settings(max_examples=8, suppress_health_check=list(HealthCheck), phases=[Phase.generate])
@given(domains())
def test_there_and_back_the_plan_is_as_long(domain: Domain) -> None:
    (task,) = domain.tasks
    state = states.state_of(domain, task.init)
    ours = find_plan(domain, state.imagination, task.goals, limit=OURS)
    assume(isinstance(ours, Plan) and ours.steps)
    result = export_task(domain, "t", task.goals, state)
    texts = write_domain(result.domain), write_problem(result.problem)
    back = import_sources(*(Source("", text) for text in texts)).domain
    again = states.state_of(back, back.tasks[0].init)
    assert states.our_length(again, back.tasks[0].goals) == len(ours.steps)


@settings(max_examples=8, suppress_health_check=list(HealthCheck), phases=[Phase.generate])
@given(domains(plain=True))
def test_definitions_put_in_mean_the_same(naive_pddl: ModuleType, domain: Domain) -> None:
    (task,) = domain.tasks
    result = export_task(domain, "t", task.goals, states.state_of(domain, task.init))
    world = naive_pddl.World(result.domain, result.problem)
    steps = world.shortest(THEIRS)
    assume(steps)
    plain = naive_pddl.World(*inlined(result.domain, result.problem))
    assert plain.is_valid(steps)
    assert not plain.is_valid(steps[:-1])
