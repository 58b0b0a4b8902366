"""Plans with other agents: what costs least, asked as late as possible."""

from __future__ import annotations

import itertools
import random

import pytest

from icarus_lite import Percept
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language import parse_domain
from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.teams import cost_of, domain_of, performer
from icarus_lite.planning import Imagination, NoPlan, Plan, find_plan, validate
from icarus_lite.planning.weighing import cost_of_steps


def imagined(text, percepts):
    domain, found = parse_domain(text)
    assert domain is not None, found
    engine = InferenceEngine(domain)
    memory = engine.step(Memory(), percepts)
    return domain, Imagination(domain, memory, engine.closure, engine.evaluator)


def shown(plan):
    return [str(step.action) for step in plan.steps]


PARTS = """
(agents human)
(percepts (part ^kind))
(skills
  ((fetch ?p) :elements ((part ?p)) :actions ((*fetch ?p)) :effects ((near ?p)))
  ((clean ?p) :elements ((near ?p)) :actions ((*clean ?p)) :effects ((clean ?p)))
  ((bring ?p) :agent human :elements ((part ?p)) :effects ((clean ?p)) {cost})
  ((hold ?p) :agent human :elements ((clean ?p)) :effects ((held ?p)))
  ((fasten ?p ?q) :elements ((held ?p) (clean ?q)) :tests ((/= ?p ?q)) :actions ((*fasten ?p ?q))
   :effects ((fastened ?p ?q))))
"""
TWO = (Percept("part", "p1", {"kind": "a"}), Percept("part", "p2", {"kind": "a"}))


@pytest.mark.parametrize(("cost", "own"), [("", True), (":cost 3", True), (":cost 1", False)])
def test_a_longer_plan_of_ones_own_is_taken_if_it_costs_less(cost, own):
    domain, imagination = imagined(PARTS.format(cost=cost), TWO)
    found = find_plan(domain, imagination, parse_conditions("(clean p1)"))
    assert shown(found) == (["(fetch p1)", "(clean p1)"] if own else ["(bring p1)"])


def test_a_request_that_is_needed_does_not_bring_others_with_it():
    domain, imagination = imagined(PARTS.format(cost=""), TWO)
    found = find_plan(domain, imagination, parse_conditions("(fastened p1 p2)"))
    asked = [str(step.action) for step in found.steps if step.clause.agent is not None]
    assert asked == ["(hold p1)"]
    assert cost_of_steps(found.steps) == 4 + 10 + 1


def test_a_request_comes_as_late_as_the_plan_allows():
    domain, imagination = imagined(PARTS.format(cost=""), TWO)
    found = find_plan(domain, imagination, parse_conditions("(fastened p1 p2)"))
    assert shown(found)[-2:] == ["(hold p1)", "(fasten p1 p2)"]
    assert validate(imagination, found.steps, found.goals) is None


def test_without_those_who_could_help_there_is_no_plan():
    domain, imagination = imagined(PARTS.format(cost=""), TWO)
    alone = domain_of(domain, others=())
    found = find_plan(alone, imagination, parse_conditions("(fastened p1 p2)"))
    assert isinstance(found, NoPlan)
    assert found.final
    assert all(clause.agent is None for clause in alone.skills)


@pytest.mark.parametrize("seed", range(25))
def test_where_little_can_be_done_the_plan_is_the_cheapest(seed):
    """Compare with shortest ways by hand: from place to place, by oneself or by another."""
    rng = random.Random(seed)
    text, costs, places = ["(agents human)(percepts (spot))(skills"], {}, "abcde"
    for here, there in itertools.permutations(places, 2):
        for agent in ("", ":agent human"):
            if rng.random() < 0.3:
                cost = rng.randint(1, 6)
                name = f"{here}{there}{'h' if agent else ''}"
                costs[here, there] = min(cost, costs.get((here, there), 99))
                do = "" if agent else f":actions ((*go {there}))"
                text.append(
                    f"(({name} ?s) {agent} :elements ((spot ?s) (at ?s {here})) {do} "
                    f":effects ((at ?s {there}) (not (at ?s {here}))) :cost {cost})"
                )
    text.append("((start ?s) :elements ((spot ?s)) :actions ((*start)) :effects ((at ?s a))))")
    domain, imagination = imagined("\n".join(text), [Percept("spot", "s")])
    found = find_plan(domain, imagination, parse_conditions("(at s e)"))
    cheapest = {"a": 1}
    for _ in places:
        for (here, there), cost in costs.items():
            if here in cheapest:
                cheapest[there] = min(cheapest.get(there, 999), cheapest[here] + cost)
    assert isinstance(found, Plan) is ("e" in cheapest)
    if isinstance(found, Plan):
        assert validate(imagination, found.steps, found.goals) is None
        assert cost_of_steps(found.steps) == cheapest["e"]


def test_what_a_skill_costs_and_who_performs_it():
    domain, _ = imagined(PARTS.format(cost=":cost 4"), TWO)
    assert [cost_of(clause) for clause in domain.skills] == [1, 1, 4, 10, 1]
    bring = domain.skills[2]
    assert (performer(bring, {"?p": "p1"}), performer(domain.skills[0], {})) == ("human", None)


def test_ones_own_view_of_a_domain_changes_nothing_where_there_is_nothing_to_change():
    domain, _ = imagined(PARTS.format(cost=""), TWO)
    assert domain_of(domain) is domain
    mine = domain_of(domain, me="human")
    assert all(clause.agent is None for clause in mine.skills)
