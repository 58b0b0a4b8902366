"""Runs to ask about: an agent on a random history of percepts and outcomes, recorded."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from icarus_lite import Action, Agent, Outcome, Percept, Status
from icarus_lite.language import parse_domain
from icarus_lite.language.fragments import parse_atom
from icarus_lite.trace import TraceWriter, cycle_record, header

STORE, _ = parse_domain(
    """(domain store "Things that are carried, put away and marked.")
(percepts (thing ^size ^seen) (hand ^reach))
(concepts
  ((small ?t) :elements ((thing ?t ^size ?s)) :tests ((< ?s 5)))
  ((free ?h) :elements ((hand ?h) (not (attached ?any ?h))))
  ((inside ?a ?b) :elements ((attached ?a ?b)))
  ((inside ?a ?c) :elements ((attached ?a ?b) (inside ?b ?c)))
  ((marked ?t ^colour ?c) :elements ((mark ?t ^colour ?c))))
(skills
  ((take ?h ?t) :elements ((free ?h) (thing ?t)) :actions ((*take ?h ?t)) :effects ((taken ?t)))
  ((store ?h ?t ?in) :elements ((taken ?t) (hand ?h) (thing ?in)) :actions ((*store ?h ?t ?in))
   :effects ((not (taken ?t)) (stored ?t)))
  ((drop ?h ?t) :elements ((hand ?h) (taken ?t)) :actions ((*drop ?h ?t))
   :effects ((not (taken ?t))))
  ((paint ?t ?c) :elements ((thing ?t)) :actions ((*paint ?t ?c)) :effects ((mark ?t ^colour ?c))))
(attachments
  ((take ?h ?t) :until (drop ?h ?t) :child ?t :parent ?h)
  ((store ?h ?t ?in) :child ?t :parent ?in))
(contradictions
  ((attached ?t ?h) :elements ((hand ?h) (thing ?t ^seen yes)) :cycles 2)
  ((stored ?t) :elements ((thing ?t ^seen no) (not (inside ?t ?_any))) :cycles 3)
  ((mark ?t ^colour red) :elements ((small ?t))))
""",
    "store.icr",
)
GIVEN = ("(stored old)", "(mark a ^colour 3)", "(attached b a)")
_THINGS = ("a", "b", "c", "left hand")


@dataclass(frozen=True)
class Run:
    """A recorded run, and what the agent said while it lasted."""

    path: Path
    believed: tuple[dict[str, str], ...]
    whys: tuple[dict[str, str], ...]


def record(path: Path, seed: int, cycles: int, *, explained: bool = False) -> Run:
    """Record a run, and note what was believed in each of its cycles; and why, if asked to."""
    rng = random.Random(seed)
    given = [parse_atom(fact) for fact in GIVEN]
    agent = Agent(STORE, ["(stored a)"], given=given)
    believed, whys = [], []
    with TraceWriter(path, header(STORE, agent.goals, given=given, seed=seed)) as writer:
        for _ in range(cycles):
            percepts, outcomes = _percepts(rng), _outcomes(rng)
            decision = agent.cycle(percepts, outcomes)
            writer.write(cycle_record(decision, percepts, outcomes, timings={"decide_s": 0.1}))
            beliefs = decision.state.beliefs
            believed.append({str(b): _attributes(decision.state.facts(), b) for b in beliefs})
            whys.append({str(b): str(agent.why(b)) for b in beliefs if explained})
    return Run(path, tuple(believed), tuple(whys))


def attributes(facts: object, belief: object) -> str:
    """Write the attributes of a belief as the facts of a cycle have them."""
    return _attributes(facts, belief)


def _attributes(facts: object, belief: object) -> str:
    rows = facts.rows(belief.predicate)  # type: ignore[attr-defined]
    found = [f for rows_of in rows.values() for _, f, _ in rows_of if f == belief]
    return str(sorted(found[0].attributes.items()))


def _percepts(rng: random.Random) -> Sequence[Percept]:
    seen = [name for name in _THINGS if rng.random() < 0.9]
    hand = [Percept("hand", "h", {"reach": 0.5})] if rng.random() < 0.97 else []
    things = [
        Percept("thing", name, {"size": rng.randint(1, 9), "seen": rng.choice(["yes", "no"])})
        for name in seen
    ]
    return [*hand, *things]


def _outcomes(rng: random.Random) -> Sequence[Outcome]:
    found = []
    for _ in range(rng.choice([0, 0, 1, 1, 2])):
        one, other = rng.sample(_THINGS, 2)
        action = rng.choice(
            [
                Action("take", ("h", one)),
                Action("store", ("h", one, other)),
                Action("drop", ("h", one)),
                Action("paint", (one, rng.choice([1, 2.5, "red", "light red"]))),
            ]
        )
        status = rng.choice([Status.SUCCEEDED, Status.SUCCEEDED, Status.FAILED, Status.RUNNING])
        found.append(Outcome(action, status, "slipped" if status is Status.FAILED else ""))
    return found
