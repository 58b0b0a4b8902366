"""Random histories of a hierarchy that is contradicted, against a model that only counts."""

from __future__ import annotations

import random
from collections import Counter

from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language import check_domain, parse_domain
from icarus_lite.outcomes import Outcome
from icarus_lite.symbols import Action, Percept

DOMAIN, _ = parse_domain("""
(percepts (object ^away))
(concepts
  ((moves-with ?a ?b) :elements ((attached ?a ?b)))
  ((moves-with ?a ?c) :elements ((attached ?a ?b) (moves-with ?b ?c)))
  ((root ?a) :elements ((object ?a) (not (attached ?a ?_any)))))
(skills
  ((stack ?a ?b) :elements ((object ?a) (object ?b)) :actions ((*stack ?a ?b)))
  ((unstack ?a ?b) :elements ((attached ?a ?b)) :actions ((*unstack ?a ?b))))
(attachments ((stack ?a ?b) :until (unstack ?a ?b) :child ?a :parent ?b))
(contradictions
  ((attached ?a ?b) :elements ((object ?a ^away ?b)) :cycles 2)
  ((attached ?a ?b) :elements ((object ?b ^away ?b) (not (object ?a ^away ?_any))) :cycles 3)
  ((attached ?a ?b) :elements ((moves-with ?b ?c) (object ?c ^away ?a)) :cycles 1))
""")
assert DOMAIN is not None
assert check_domain(DOMAIN) == ()
LIMITS = (2, 3, 1)
NAMES = "abcd"


def history(seed: int):
    """Draw what is done, what is seen where, and what is hidden, cycle by cycle."""
    draw = random.Random(seed)
    away: dict[str, str] = {}
    for _ in range(20):
        skills = draw.choices(["stack", "unstack"], [4, 1], k=draw.choice((0, 0, 1, 2)))
        actions = [(skill, draw.choice(NAMES), draw.choice(NAMES)) for skill in skills]
        for name in NAMES:
            if draw.random() < 0.12:
                away.pop(name, None)
            elif draw.random() < 0.12:
                away[name] = draw.choice(NAMES)
        hidden = {draw.choice(NAMES)} if draw.random() < 0.1 else set()
        yield actions, dict(away), hidden


class Model:
    """Who stands on whom, and for how long something has spoken against it."""

    def __init__(self) -> None:
        self.cycle = -1
        self.parents: dict[str, tuple[str, int]] = {}
        self.counts: dict[tuple[int, str], int] = {}
        self.known: set[str] = set()

    def above(self, name: str) -> list[str]:
        found = []
        while name in self.parents:
            name = self.parents[name][0]
            found.append(name)
        return found

    def step(self, actions, away, hidden) -> dict[str, int]:
        self.cycle += 1
        for skill, a, b in actions:
            if skill == "unstack":
                if self.parents.get(a, ("", 0))[0] == b:
                    del self.parents[a]
            elif a != b and a not in self.above(b):
                self.parents[a] = (b, self.cycle)
        seen = set(NAMES) - hidden
        self.known |= seen
        gone = self.known - seen
        self.parents = {a: (b, when) for a, (b, when) in self.parents.items() if not {a, b} & gone}
        counts, ended = {}, {}
        for a, (b, when) in self.parents.items():
            for rule, holds in enumerate(self.against(a, b, away, seen)):
                if holds:
                    count = 1 if when == self.cycle else self.counts.get((rule, a), 0) + 1
                    counts[rule, a] = count
                    if count >= LIMITS[rule]:
                        ended.setdefault(a, count)
        for a in ended:
            del self.parents[a]
        self.counts = {key: count for key, count in counts.items() if key[1] in self.parents}
        return ended

    def against(self, a, b, away, seen) -> tuple[bool, bool, bool]:
        return (
            a in seen and away.get(a) == b,
            b in seen and away.get(b) == b and not (a in seen and a in away),
            any(c in seen and away.get(c) == a for c in self.above(b)),
        )


def beliefs(model: Model, hidden: set[str]) -> set[str]:
    found = {f"(attached {a} {b})" for a, (b, _) in model.parents.items()}
    found |= {f"(moves-with {a} {b})" for a in model.parents for b in model.above(a)}
    return found | {f"(root {a})" for a in NAMES if a not in hidden and a not in model.parents}


def test_the_hierarchy_is_what_the_model_says() -> None:
    engine, met = InferenceEngine(DOMAIN), Counter[str]()
    for seed in range(100):
        memory, model = Memory(), Model()
        for actions, away, hidden in history(seed):
            outcomes = [Outcome(Action(skill, (a, b))) for skill, a, b in actions]
            percepts = [
                Percept("object", name, {"away": away[name]} if name in away else {})
                for name in NAMES
                if name not in hidden
            ]
            memory = engine.step(memory, percepts, outcomes)
            state, ended = memory.state, model.step(actions, away, hidden)
            assert dict(state.hierarchy.pairs()) == {a: b for a, (b, _) in model.parents.items()}
            assert {str(each) for each in state.beliefs} == beliefs(model, hidden)
            assert {str(w.belief.args[0]): w.cycles for w in state.withdrawn} == ended
            doubts = {(d.rule, str(d.belief.args[0])): d.cycles for d in state.doubts}
            assert doubts == model.counts
            met.update(f"after {count}" for count in ended.values())
            met["in doubt"] += bool(doubts)
            met["several"] += len(ended) > 1
    assert len(met) == 5
    assert min(met.values()) > 1, met
