from __future__ import annotations

from icarus_lite import Action, Belief, Outcome, Percept
from icarus_lite.inference import InferenceEngine, Memory, explain
from icarus_lite.language.reading.reader import parse_domain

DOMAIN, _ = parse_domain("""(percepts (hand) (object))
(concepts
  ((idle ?h) :elements ((hand ?h) (not (holding ?h ?any))))
  ((busy ?h) :elements ((holding ?h ?o) (object ?o))))
(skills ((pick-up ?h ?o) :elements ((hand ?h) (object ?o)) :actions ((*grasp ?h ?o))
                         :effects ((holding ?h ?o))))""")
PERCEPTS = (Percept("hand", "h1"), Percept("hand", "h2"), Percept("object", "o1"))


def state():
    engine = InferenceEngine(DOMAIN)
    memory = engine.step(Memory(), PERCEPTS)
    done = Outcome(Action("pick-up", ("h1", "o1")))
    return engine.step(memory, PERCEPTS, [done]).state


def test_a_tree_down_to_percepts_and_actions() -> None:
    assert str(explain(Belief("busy", ("h1",)), state())) == (
        "(busy h1)  by its definition (line 4)\n"
        "  (holding h1 o1)  because (pick-up h1 o1) succeeded, reported in cycle 1\n"
        "  (object o1)  is perceived"
    )


def test_what_was_absent_is_said() -> None:
    assert str(explain(Belief("idle", ("h2",)), state())).splitlines()[-1] == (
        "  (not (holding h2 ?any))  nothing like it is believed"
    )


def test_what_is_not_believed_is_said_to_be_so() -> None:
    assert str(explain(Belief("busy", ("h2",)), state())) == (
        "(busy h2)  is not believed in cycle 1"
    )
