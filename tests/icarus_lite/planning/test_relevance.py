from __future__ import annotations

from icarus_lite.language.fragments import parse_conditions
from icarus_lite.language.reading.reader import parse_domain
from icarus_lite.planning import can_change, relevance

DOMAIN, _ = parse_domain("""
(percepts (hand) (object))
(concepts ((free ?h) :elements ((hand ?h) (not (holding ?h ?any))))
          ((ready ?o) :elements ((clean ?o) (not (hot ?o)))))
(skills
  ((pick-up ?h ?o) :elements ((free ?h)) :actions ((*grasp ?h ?o)) :effects ((holding ?h ?o)))
  ((drop ?h ?o) :elements ((holding ?h ?o)) :actions ((*drop ?h ?o))
                :effects ((not (holding ?h ?o))))
  ((wash ?o) :elements ((held-by ?h ?o)) :actions ((*wash ?o)) :effects ((clean ?o)))
  ((cool ?o) :actions ((*cool ?o)) :effects ((not (hot ?o)))))
(attachments ((pick-up ?h ?o) :until (drop ?h ?o) :child ?o :parent ?h))
""")


def names(goal: str) -> list[str]:
    return [c.head.predicate for c in relevance(DOMAIN, parse_conditions(goal)).skills]


def test_skill_chaining_goes_on_to_the_conditions_of_a_skill() -> None:
    assert names("(holding h o)") == ["pick-up", "drop"]


def test_concept_chaining_turns_a_negated_condition_round() -> None:
    assert names("(ready o)") == ["wash", "cool"]
    assert names("(free h)") == ["pick-up", "drop"]


def test_attachments_are_effects_too() -> None:
    assert names("(attached o h)") == ["pick-up", "drop"]


def test_what_nothing_changes_is_recognised_statically() -> None:
    assert not can_change(DOMAIN, parse_conditions("(hand h)")[0])
    assert can_change(DOMAIN, parse_conditions("(not (ready o))")[0]) is False
