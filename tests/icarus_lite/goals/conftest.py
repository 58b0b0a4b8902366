"""A small house: a robot that goes from room to room and switches lamps on and off."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import pytest

from icarus_lite import Action, Agent, Decision, DecisionKind, Outcome, Percept, Status
from icarus_lite.language import check_domain, parse_domain
from icarus_lite.language.syntax import Domain

HOUSE = """
(percepts (robot ^at ^battery) (lamp ^in ^lit ^urgency) (room ^locked))
(concepts
  ((at ?r ?room) :elements ((robot ?r ^at ?room) (room ?room)))
  ((lit ?l) :elements ((lamp ?l ^lit yes)))
  ((dark ?l) :elements ((lamp ?l ^lit no)))
  ((open ?room) :elements ((room ?room ^locked no))))
(skills
  ((go ?r ?to)
   :elements ((at ?r ?from) (open ?to))
   :tests ((/= ?from ?to))
   :actions ((*go ?r ?to))
   :effects ((at ?r ?to) (not (at ?r ?from))))
  ((switch-on ?r ?l)
   :elements ((lamp ?l ^in ?room) (at ?r ?room) (dark ?l))
   :actions ((*switch ?r ?l on))
   :effects ((lit ?l) (not (dark ?l))))
  ((switch-off ?r ?l)
   :elements ((lamp ?l ^in ?room) (at ?r ?room) (lit ?l))
   :actions ((*switch ?r ?l off))
   :effects ((dark ?l) (not (lit ?l)))))
"""


def domain_of(text: str) -> Domain:
    """Read and check a domain; nothing may be wrong with it."""
    domain, found = parse_domain(text)
    assert domain is not None, found
    wrong = [each for each in check_domain(domain) if each.severity != "note"]
    assert wrong == []
    return domain


@dataclass
class House:
    """What is so in the house; one command changes one thing."""

    rooms: Sequence[str] = ("hall", "kitchen", "attic")
    lamps: dict[str, str] = field(default_factory=lambda: {"l1": "kitchen", "l2": "attic"})
    lit: set[str] = field(default_factory=set)
    locked: set[str] = field(default_factory=set)
    urgency: dict[str, float | str] = field(default_factory=dict)
    at: str = "hall"
    battery: float = 0.5
    done: list[str] = field(default_factory=list)

    def percepts(self) -> list[Percept]:
        seen = [Percept("robot", "r", {"at": self.at, "battery": self.battery})]
        for lamp, room in self.lamps.items():
            known = {"in": room, "lit": "yes" if lamp in self.lit else "no"}
            seen.append(Percept("lamp", lamp, {**known, "urgency": self.urgency.get(lamp, 0)}))
        locked = {room: "yes" if room in self.locked else "no" for room in self.rooms}
        return [*seen, *(Percept("room", room, {"locked": locked[room]}) for room in self.rooms)]

    def carry_out(self, commands: Iterable[Action]) -> bool:
        """Carry commands out; tell whether that was possible."""
        for command in commands:
            self.done.append(str(command))
            if command.name == "go":
                if command.args[1] in self.locked:
                    return False
                self.at = str(command.args[1])
            else:
                lamp = str(command.args[1])
                if self.lamps[lamp] != self.at:
                    return False
                (self.lit.add if command.args[2] == "on" else self.lit.discard)(lamp)
        return True


Meddling = Callable[[int, House], None]


def live(
    house: House,
    agent: Agent,
    cycles: int = 60,
    meddle: Meddling | None = None,
    stop: Sequence[DecisionKind] = (DecisionKind.ACHIEVED, DecisionKind.IMPASSE),
) -> list[Decision]:
    """Let an agent act until it is done or stuck.

    Args:
        house: The world.
        agent: The agent.
        cycles: The most cycles.
        meddle: Called before each cycle with its number: what others do meanwhile.
        stop: The decisions that end it.
    """
    decisions: list[Decision] = []
    outcome: Outcome | None = None
    for cycle in range(cycles):
        if meddle is not None:
            meddle(cycle, house)
        decision = agent.cycle(house.percepts(), outcome)
        decisions.append(decision)
        outcome = None
        if decision.kind in stop:
            break
        if decision.kind is DecisionKind.ACT and decision.action is not None:
            worked = house.carry_out(decision.commands)
            status = Status.SUCCEEDED if worked else Status.FAILED
            outcome = Outcome(decision.action, status, "" if worked else "it cannot be done")
    return decisions


def standing(decision: Decision) -> dict[str, str]:
    """Give how each goal stands."""
    return {each.name: str(each.standing) for each in decision.agenda}


class Kit:
    """What the tests of this folder share."""

    text = HOUSE
    house = House
    domain_of = staticmethod(domain_of)
    live = staticmethod(live)
    standing = staticmethod(standing)


@pytest.fixture(scope="session")
def kit() -> Kit:
    """Give the world, and what runs an agent in it."""
    return Kit()


@pytest.fixture
def domain(kit: Kit) -> Domain:
    """Give the domain of the house."""
    return kit.domain_of(HOUSE)
